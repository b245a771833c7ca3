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

// Before mixing, odd multipliers spread the neighbours of a lattice point over the whole word. A sum: that of a neighbour is a sum away.
const uvec3 LATTICE_STEP = uvec3(0x9e3779b1u, 0x85ebca77u, 0xc2b2ae3du);

uint lattice_word(ivec3 place, uint seed) {
    uvec3 p = uvec3(place) * LATTICE_STEP;
    return p.x + p.y + p.z + seed * 0x27d4eb2fu;
}

// A hash of a lattice point.
uint hash_lattice(ivec3 place, uint seed) {
    return hash_bits(lattice_word(place, seed));
}

// Three numbers in 0…1 (1,024 steps each) from one hash.
vec3 hash_vec3(uint h) {
    return vec3(uvec3(h, h >> 10u, h >> 20u) & 1023u) * (1.0 / 1023.0);
}

// The gradient of a lattice point by its lattice_word: whole numbers, evenly spread within ±2^31. One round of mixing and a product for each component
// do: over 64³ points no two components correlate by more than 0.02 at any distance, random ones by 0.01 (tests/shaders/test_noise.py).
vec3 lattice_gradient(uint word) {
    return vec3(ivec3((word ^ (word >> 15u)) * uvec3(0x3314ec4bu, 0x2b6361bfu, 0xf595c171u)));
}

// What a lattice corner adds to the noise at the place `offset` from it.
float simplex_corner(vec3 offset, uint word) {
    float fall = max(0.5 - dot(offset, offset), 0.0); // 0.5: the kernel ends before the next cell, so no jumps
    fall *= fall;
    return fall * fall * dot(lattice_gradient(word), offset);
}

// Gradient noise, mean 0, standard deviation 0.24, within −1…1 (0.95 in a million draws), features about 1 apart.
float simplex_noise(vec3 p, uint seed) {
    vec3 corner = floor(p + dot(p, vec3(1.0 / 3.0))); // skew: cubes to simplices
    vec3 d0 = p - corner + dot(corner, vec3(1.0 / 6.0));
    // Then along the largest of x, y, z first, along the smallest last. x ≥ y, y ≥ z, z > x: the last is strict, or ties have no order.
    bvec3 ge = bvec3(d0.x >= d0.y, d0.y >= d0.z, d0.z > d0.x);
    bvec3 first = bvec3(ge.x && !ge.z, ge.y && !ge.x, ge.z && !ge.y), both = bvec3(ge.x || !ge.z, ge.y || !ge.x, ge.z || !ge.y);
    vec3 d1 = d0 - vec3(first) + 1.0 / 6.0;
    vec3 d2 = d0 - vec3(both) + 1.0 / 3.0;
    vec3 d3 = d0 - 0.5;
    uint word = lattice_word(ivec3(corner), seed);
    uvec3 w1 = uvec3(first) * LATTICE_STEP, w2 = uvec3(both) * LATTICE_STEP;
    float sum = simplex_corner(d0, word) + simplex_corner(d1, word + w1.x + w1.y + w1.z)
              + simplex_corner(d2, word + w2.x + w2.y + w2.z) + simplex_corner(d3, word + (LATTICE_STEP.x + LATTICE_STEP.y + LATTICE_STEP.z));
    return (130.0 / 4294967296.0) * sum;
}
