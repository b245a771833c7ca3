// Hashes on integers and gradient noise on a simplex lattice.
//
// All randomness comes from integer arithmetic, which every driver does alike; a sin()-based hash would differ between
// them. The bit mixer is the two-round multiply–xorshift form with the constants of C. Wellons' search ("lowbias32").
// The lattice is K. Perlin's simplex grid (2001), of triangles.

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
// do: over 512² points the two correlate by no more than 0.02 at any distance, random ones by 0.01 (tests/shaders/test_noise.py).
vec2 lattice_gradient(uint word) {
    return vec2(ivec2((word ^ (word >> 15u)) * uvec2(0x3314ec4bu, 0x2b6361bfu)));
}

// What a lattice corner adds to the noise at the place `offset` from it.
float simplex_corner(vec2 offset, uint word) {
    float fall = max(0.5 - dot(offset, offset), 0.0); // √½ is a triangle's height: the kernel ends before the next one, so no jumps
    fall *= fall;
    return fall * fall * dot(lattice_gradient(word), offset);
}

const float SIMPLEX_EDGE = 0.81649658; // √(2/3), of a triangle √½ high

// Gradient noise on a lattice of triangles with edges along x, mean 0, standard deviation 0.24, within −1…1 (0.7 in a quarter of a million draws), features about 1
// apart. `turn` is x in whole lattices of `edges` edges, a whole number: the noise repeats with each.
float ring_noise(float turn, float edges, float y, uint seed) {
    vec2 place = vec2(turn * edges, y * 1.41421356);
    place.x -= 0.5 * place.y; // skew: squares to pairs of triangles
    vec2 corner = floor(place), inside = place - corner;
    float left = corner.x - edges * floor((corner.x + 0.5) * (1.0 / edges));
    uint low = uint(int(corner.y)) * LATTICE_STEP.y + seed * 0x27d4eb2fu, high = low + LATTICE_STEP.y;
    uint west = uint(int(left)) * LATTICE_STEP.x, east = left + 1.5 > edges ? 0u : west + LATTICE_STEP.x;
    vec2 from_low_left = vec2(SIMPLEX_EDGE * (inside.x + 0.5 * inside.y), 0.70710678 * inside.y);
    const vec2 ALONG = vec2(SIMPLEX_EDGE, 0.0), UP = vec2(0.5 * SIMPLEX_EDGE, 0.70710678);
    bool upper = inside.x + inside.y > 1.0;
    float sum = simplex_corner(from_low_left - ALONG, low + east) + simplex_corner(from_low_left - UP, high + west)
              + simplex_corner(upper ? from_low_left - (ALONG + UP) : from_low_left, upper ? high + east : low + west);
    return (107.8 / 4294967296.0) * sum;
}
