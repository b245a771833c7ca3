// Hashes on integers and gradient noise on a simplex lattice.
//
// All randomness comes from integer arithmetic, which every driver does alike; a sin()-based hash would differ between
// them. The bit mixer is the two-round multiply–xorshift form with the constants of C. Wellons' search ("lowbias32").
// The lattice is K. Perlin's simplex grid (2001).

uint hash_bits(uint h) {
    h = (h ^ (h >> 16u)) * 0x7feb352du;
    h = (h ^ (h >> 15u)) * 0x846ca68bu;
    return h ^ (h >> 16u);
}

// A hash of a lattice point. The odd multipliers spread neighbours over the whole word before mixing.
uint hash_lattice(ivec3 place, uint seed) {
    uvec3 p = uvec3(place) * uvec3(0x9e3779b1u, 0x85ebca77u, 0xc2b2ae3du);
    return hash_bits(p.x + p.y + p.z + seed * 0x27d4eb2fu);
}

// Three numbers in 0…1 (1,024 steps each) from one hash.
vec3 hash_vec3(uint h) {
    return vec3(uvec3(h, h >> 10u, h >> 20u) & 1023u) * (1.0 / 1023.0);
}

// What the lattice corner at `corner` adds to the noise at the place `offset` from it.
float simplex_corner(vec3 offset, ivec3 corner, uint seed) {
    float fall = max(0.5 - dot(offset, offset), 0.0); // 0.5: the kernel ends before the next cell, so no jumps
    fall *= fall;
    return fall * fall * dot(hash_vec3(hash_lattice(corner, seed)) - 0.5, offset);
}

// Gradient noise, mean 0, standard deviation 0.24, within −1…1 (0.95 in a million draws), features about 1 apart.
float simplex_noise(vec3 p, uint seed) {
    ivec3 cell = ivec3(floor(p + dot(p, vec3(1.0 / 3.0)))); // skew: cubes to simplices
    vec3 corner = vec3(cell);
    vec3 d0 = p - corner + dot(corner, vec3(1.0 / 6.0));
    vec3 ge = vec3(step(d0.yz, d0.xy), 1.0 - step(d0.z, d0.x)); // x ≥ y, y ≥ z, z > x: the last is strict, or ties have no order
    ivec3 i1 = ivec3(min(ge, 1.0 - ge.zxy));
    ivec3 i2 = ivec3(max(ge, 1.0 - ge.zxy));
    vec3 d1 = d0 - vec3(i1) + 1.0 / 6.0;
    vec3 d2 = d0 - vec3(i2) + 1.0 / 3.0;
    vec3 d3 = d0 - 0.5;
    float sum = simplex_corner(d0, cell, seed) + simplex_corner(d1, cell + i1, seed)
              + simplex_corner(d2, cell + i2, seed) + simplex_corner(d3, cell + 1, seed);
    return 130.0 * sum;
}
