// Gradient noise in space, on K. Perlin's simplex grid (2001): here of tetrahedra.
#include "common/noise.glsl"

// As lattice_gradient, in three dimensions.
vec3 solid_gradient(uint word) {
    return vec3(ivec3((word ^ (word >> 15u)) * uvec3(0x3314ec4bu, 0x2b6361bfu, 0x6c8e9cf5u)));
}

// What a lattice corner adds to the noise at the place `offset` from it.
float solid_corner(vec3 offset, ivec3 corner, uint seed) {
    float fall = max(0.5 - dot(offset, offset), 0.0); // √½ is the height of a layer of the lattice: the kernel ends before the next corner's tetrahedra, so no jumps
    fall *= fall;
    return fall * fall * dot(solid_gradient(lattice_word(corner, seed)), offset);
}

// Mean 0, standard deviation 0.24, within −1…1, features about 1 apart.
float solid_noise(vec3 place, uint seed) {
    vec3 cell = floor(place + (place.x + place.y + place.z) / 3.0);  // skew: cubes to six tetrahedra each
    vec3 inside = place - cell + (cell.x + cell.y + cell.z) / 6.0;
    // The tetrahedron's corners follow the cube's edges in the order of the components' sizes.
    vec3 above = vec3(step(inside.yz, inside.xy), 1.0 - step(inside.z, inside.x));  // x over y, y over z, z over x; of equal ones the first
    vec3 rank = above + 1.0 - above.zxy;    // of each: how many it is over
    vec3 first = step(1.5, rank), second = step(0.5, rank);
    ivec3 corner = ivec3(cell);
    float sum = solid_corner(inside, corner, seed) + solid_corner(inside - first + 1.0 / 6.0, corner + ivec3(first), seed)
              + solid_corner(inside - second + 1.0 / 3.0, corner + ivec3(second), seed) + solid_corner(inside - 0.5, corner + 1, seed);
    return (133.2 / 4294967296.0) * sum;
}
