#version 330 core
// One step down the bloom chain. Four taps, each the mean of four pixels, and a centre ("dual filter", M. Bjørge, SIGGRAPH
// 2015); weights sum to 1, so the mean light is kept.
//   first step: to a quarter, no centre: the taps make the plain mean of 4 × 4 pixels, so that a star gives the same glow
//               wherever it falls between the pixels. It also takes the threshold off.
//   others:     to a half, centre weight 4.

#blocks

uniform sampler2D source;
uniform vec4 source_part;     // 1 / size of the source, and the last place in it that holds light: it may be larger than what lies in it
uniform vec2 source_start;    // the place there that the target's lower left corner has
uniform float shrinks;        // pixels of the source to one of the target: a power of two
uniform float centre_weight;
uniform float threshold;      // radiance below which nothing glows; 0 in all steps but the first

out vec4 colour;

vec3 tap(vec2 place) {
    return textureLod(source, min(place, source_part.zw), 0.0).rgb;
}

void main() {
    vec2 d = source_part.xy;
    vec2 place = source_start + gl_FragCoord.xy * (shrinks * d);
    vec3 sum = centre_weight * tap(place)
             + tap(place + d) + tap(place - d) + tap(place + vec2(d.x, -d.y)) + tap(place + vec2(-d.x, d.y));
    vec3 mean = sum / (centre_weight + 4.0);
    // Soft knee: nothing is kept below threshold/2, L − threshold above 3/2 of it, a parabola joins the two.
    float brightest = max(mean.r, max(mean.g, mean.b));
    float knee = 0.5 * threshold;
    float soft = clamp(brightest - threshold + knee, 0.0, 2.0 * knee);
    float kept = max(soft * soft / (4.0 * knee + 1e-6), brightest - threshold);
    mean *= clamp(kept / max(brightest, 1e-6), 0.0, 1.0);
    colour = vec4(mean, 1.0);
}
