#version 330 core
// Shaded blocks of rays → the mean radiance of each in its pixel. All other pixels are left as they are.
// Fetched ray by ray: filtered by the sampler, four at a time, the weights would depend on where in its map a block lies.
#blocks

uniform sampler2D block_radiance;
uniform usampler2D block_of_pixel; // column and row of the pixel's block, NO_BLOCK where it has none
uniform int pairs;                 // of rays along each axis of a pixel

const uint NO_BLOCK = 0xFFFFu;

out vec4 radiance;

void main() {
    uvec2 block = texelFetch(block_of_pixel, ivec2(gl_FragCoord.xy), 0).xy;
    if (block.x == NO_BLOCK) discard;
    int side = 2 * pairs;
    ivec2 first = side * ivec2(block);
    vec4 sum = vec4(0.0);
    ivec2 ray = ivec2(0);
    do {
        sum += texelFetch(block_radiance, first + ray, 0);
        ray = ray.x + 1 < side ? ivec2(ray.x + 1, ray.y) : ivec2(0, ray.y + 1);
    } while (ray.y < side);
    radiance = sum / float(side * side);
}
