#version 330 core
// One step up the bloom chain: the wider glow, spread with a 3×3 tent, mixed with this level's own light.
// Tent weights sum to 1 and the mix is convex, so the mean light is kept however wide the glow is.

uniform sampler2D wider;     // the next smaller level, already accumulated
uniform sampler2D level;     // this level on the way down
uniform vec2 wider_texel;
uniform vec2 target_texel;
uniform float spread;        // share of the wider glow, 0…1

out vec4 colour;

vec3 tap(vec2 place) {
    return textureLod(wider, place, 0.0).rgb;
}

void main() {
    vec2 place = gl_FragCoord.xy * target_texel;
    vec2 d = 0.5 * wider_texel; // four bilinear taps at half a texel make the tent (1 2 1)/4 in each direction
    vec3 tent = 0.25 * (tap(place + d) + tap(place - d) + tap(place + vec2(d.x, -d.y)) + tap(place + vec2(-d.x, d.y)));
    vec3 own = texelFetch(level, ivec2(gl_FragCoord.xy), 0).rgb;
    colour = vec4(mix(own, tent, spread), 1.0);
}
