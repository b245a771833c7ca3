// Boxes of triangles, two by two (blackhole_gl/rendering/box_pairs.py), in a binary tree without links: below the node i lie 2 i and 2 i + 1, whose boxes stand in
// one texel (docs/llvmpipe.md). In x and y their low sides, in z and w their high ones, ten bits each. Beyond these, in x and y, how many triangles either has, of a
// node of the lowest level; and in z the axis along which the second box lies behind the first. In the place of number 0 stands in x, as a float, how long a side of
// a triangle is at most.
#include "common/hierarchy.glsl"
#include "common/lowest_bit.glsl"

const float PAIR_CELL = 1.0 / 510.0;  // of the lattice from −1 to 1, and one more on both sides
const vec4 PAIR_LATTICE = vec4(vec3(-1.0 - PAIR_CELL), PAIR_CELL);

// A walk along a piece through the tree with the root 32·(nodes of the texture before its own) + its levels.
struct PairWalk {
    Piece piece;
    int backwards;     // a bit for each axis along which the piece leads down: of two boxes the one that it comes to first is walked first
    vec2 per_texel;
    int before, lowest; // nodes before the tree's own; the first of its lowest level
    int triangles;     // before its own, less 4·lowest
    int node;          // where it is; 0: at its end
    uint trail;        // a bit for that and each node above it: whether the one beside it is still to be looked at
    int first, second; // runs of triangles that it has come to: 4·(triangle − `triangles`) + how many follow; −1: none
};

ivec4 pair_texel(isampler2D pairs, vec2 per_texel, int number) {
    return textureLod(pairs, (vec2(number & ((1 << ROW_BITS) - 1), number >> ROW_BITS) + 0.5) * per_texel, 0.0);
}

PairWalk pair_walk(isampler2D pairs, int root, Piece piece) {
    int backwards = (piece.way.x < 0.0 ? 1 : 0) | (piece.way.y < 0.0 ? 2 : 0) | (piece.way.z < 0.0 ? 4 : 0);
    int before = root >> 5, lowest = 1 << (root & 31) >> 1;
    return PairWalk(piece, backwards, 1.0 / vec2(textureSize(pairs, 0)), before, lowest, 2 * before - 4 * lowest, root > 0 ? 1 : 0, 0u, -1, -1);
}

vec3 three_tens(int bits) {
    return vec3(ivec3(bits, bits >> 10, bits >> 20) & 1023);
}

int beyond_tens(int bits) {
    return bits >> 30 & 3;
}

// Walks on, along the piece before its part `most`, to two more runs of triangles: rays come to their first ones at different times, and each would wait for the
// others there.
void walk_on(isampler2D pairs, float most, inout PairWalk walk) {
    int node = walk.node, first = -1, second;
    uint trail = walk.trail;
    do {
        ivec4 pair = pair_texel(pairs, walk.per_texel, walk.before + node);
        bool one = meets_box(walk.piece, Node(three_tens(pair.x), three_tens(pair.z), 0), most);
        bool other = meets_box(walk.piece, Node(three_tens(pair.y), three_tens(pair.w), 0), most);
        bool down = (one || other) && node < walk.lowest, both = one && other, back = trail != 0u;
        int count = beyond_tens(pair.x), begin = one ? 0 : count, end = other ? count + beyond_tens(pair.y) : count;
        int run = node >= walk.lowest && end > begin ? 4 * (4 * node + begin) + end - begin - 1 : -1;
        second = first >= 0 ? run : -1;
        first = first >= 0 ? first : run;
        int side = both ? walk.backwards >> beyond_tens(pair.z) & 1 : one ? 0 : 1, up = lowest_bit(trail);
        node = down ? 2 * node + side : back ? node >> up ^ 1 : 0;
        trail = down ? trail << 1 | uint(both) : back ? trail >> up ^ 1u : 0u;
    } while (second < 0 && node > 0);
    walk.node = node;
    walk.trail = trail;
    walk.first = first;
    walk.second = second;
}
