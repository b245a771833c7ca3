#version 330 core
// Shaded blocks of rays → the mean radiance of each in its pixel. Drawn only into the pixels at edges.
// Fetched ray by ray: filtered by the sampler, four at a time, the weights would depend on where in its map a block lies.
uniform sampler2D block_radiance;
uniform sampler2D block_of_pixel;  // column and row of the pixel's block
uniform int pairs;                 // of rays along each axis of a pixel

out vec4 radiance;

void main() {
    int side = 2 * pairs;
    ivec2 first = side * ivec2(texelFetch(block_of_pixel, ivec2(gl_FragCoord.xy), 0).xy);
    vec4 sum = vec4(0.0);
    int k = 0;
    do {
        sum += texelFetch(block_radiance, first + ivec2(k % side, k / side), 0);
    } while (++k < side * side);
    radiance = sum / float(side * side);
}
