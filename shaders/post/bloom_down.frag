#version 330 core
// One step down the bloom chain: half the size, five taps ("dual filter", M. Bjørge, SIGGRAPH 2015: centre weight 4, four
// diagonals weight 1, half a pixel of the target away). Weights sum to 1, so the mean light is kept. The first step also
// takes the threshold off.

uniform sampler2D source;
uniform vec2 source_texel;   // 1 / size of the source
uniform vec2 target_texel;   // 1 / size of the target
uniform float threshold;     // radiance below which nothing glows; 0 in all steps but the first

out vec4 colour;

vec3 tap(vec2 place) {
    return textureLod(source, place, 0.0).rgb;
}

void main() {
    vec2 place = gl_FragCoord.xy * target_texel;
    vec2 d = source_texel;
    vec3 sum = 4.0 * tap(place)
             + tap(place + d) + tap(place - d) + tap(place + vec2(d.x, -d.y)) + tap(place + vec2(-d.x, d.y));
    vec3 mean = sum * 0.125;
    // Soft knee: nothing is kept below threshold/2, L − threshold above 3/2 of it, a parabola joins the two.
    float brightest = max(mean.r, max(mean.g, mean.b));
    float knee = 0.5 * threshold;
    float soft = clamp(brightest - threshold + knee, 0.0, 2.0 * knee);
    float kept = max(soft * soft / (4.0 * knee + 1e-6), brightest - threshold);
    mean *= clamp(kept / max(brightest, 1e-6), 0.0, 1.0);
    colour = vec4(mean, 1.0);
}
