#version 330 core
// One step up the bloom chain: the wider glow, spread with a 3×3 tent, mixed with this level's own light.
// Tent weights sum to 1 and the mix is convex, so the mean light is kept however wide the glow is.

#blocks

uniform sampler2D wider;     // the next smaller level, already accumulated
uniform sampler2D level;     // this level on the way down
uniform vec4 wider_part;     // 1 / size of `wider`, and the last place in it that holds light
uniform float spread;        // share of the wider glow, 0…1

out vec4 colour;

vec3 tap(vec2 place) {
    return textureLod(wider, min(place, wider_part.zw), 0.0).rgb;
}

void main() {
    vec2 d = 0.5 * wider_part.xy; // four bilinear taps at half a texel make the tent (1 2 1)/4 in each direction
    vec2 place = gl_FragCoord.xy * d; // a pixel of the target is as wide
    vec3 tent = 0.25 * (tap(place + d) + tap(place - d) + tap(place + vec2(d.x, -d.y)) + tap(place + vec2(-d.x, d.y)));
    vec3 own = texelFetch(level, ivec2(gl_FragCoord.xy), 0).rgb;
    colour = vec4(mix(own, tent, spread), 1.0);
}
