#version 330 core
// Shaded blocks of rays → the mean radiance of each in its pixel. Drawn only into the pixels at edges.
uniform sampler2D block_radiance;  // filtered linearly: four rays a fetch
uniform sampler2D block_of_pixel;  // column and row of the pixel's block
uniform int pairs;                 // of rays along each axis of a pixel

out vec4 radiance;

void main() {
    vec2 first = float(2 * pairs) * texelFetch(block_of_pixel, ivec2(gl_FragCoord.xy), 0).xy + 1.0;
    vec2 texel = 1.0 / vec2(textureSize(block_radiance, 0));
    vec4 sum = vec4(0.0);
    int k = 0;
    do {
        sum += textureLod(block_radiance, (first + 2.0 * vec2(k % pairs, k / pairs)) * texel, 0.0);
    } while (++k < pairs * pairs);
    radiance = sum / float(pairs * pairs);
}
