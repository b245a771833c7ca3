// Bounding volume hierarchies (blackhole_gl/render/hierarchy.py), walked without a stack: a box that is met leads to the next node, one that is missed beyond all
// that lies in it. Two texels a node: low and the node beyond; high and what a leaf holds, −1 for inner nodes.

const int ROW_BITS = 8;  // nodes in a row of the texture, as a power of two

// A straight piece from x, as boxes are tested against it.
struct Piece {
    vec3 x, way, inverse;  // y − x, and 1/(y − x)
    vec3 to_low, to_high;  // x for the low and the high sides of boxes, which are farther out by the pad
    float pad, per_way2;   // and 1/|y − x|²
};

struct Node {
    vec4 low, high;
};

Piece piece_of(vec3 x, vec3 y, float stray) {
    vec3 way = y - x, divisor = mix(way, vec3(1e-20), lessThan(abs(way), vec3(1e-20)));
    vec3 size = max(abs(x), abs(y));
    float pad = stray + 1e-6 * max(max(size.x, size.y), size.z);  // and what rounding takes
    return Piece(x, way, 1.0 / divisor, x + pad, x - pad, pad, 1.0 / max(dot(way, way), 1e-30));
}

Node fetch_node(sampler2D nodes, int node) {
    vec2 texel = 1.0 / vec2(textureSize(nodes, 0));
    vec2 place = (vec2(2 * (node & ((1 << ROW_BITS) - 1)), node >> ROW_BITS) + 0.5) * texel;
    return Node(textureLod(nodes, place, 0.0), textureLod(nodes, place + vec2(texel.x, 0.0), 0.0));
}

// Whether the piece meets the node's box before its part `most`.
bool meets_box(Piece piece, Node node, float most) {
#if RAYS_BOUNDS
    vec3 a = (node.low.xyz - piece.to_low) * piece.inverse, b = (node.high.xyz - piece.to_high) * piece.inverse;
    vec3 into = min(a, b), out_of = max(a, b);
    return max(max(into.x, into.y), max(into.z, 0.0)) <= min(min(out_of.x, out_of.y), min(out_of.z, most));
#else
    return true;
#endif
}

bool is_leaf(Node node) {
    return node.high.w >= 0.0;
}

float half_width(Node node) {
    vec3 sides = node.high.xyz - node.low.xyz;
    return 0.5 * max(max(sides.x, sides.y), sides.z);
}

// Where the walk goes on from `here`, the node with the number `number`; −1 at its end.
int next_node(Node here, int number, bool met) {
    return met && !is_leaf(here) ? number + 1 : int(here.low.w);
}

// Whether the piece comes into the largest ball that fits into the leaf's box, wider by the pad: an instance lies within that.
bool meets_ball(Piece piece, Node leaf) {
    float radius = half_width(leaf) + piece.pad;
    vec3 off = 0.5 * (leaf.low.xyz + leaf.high.xyz) - piece.x;
    off -= clamp(dot(off, piece.way) * piece.per_way2, 0.0, 1.0) * piece.way;
    return dot(off, off) <= radius * radius;
}

// The first leaf from the node `number` on that the piece meets before its part `most`, where `balls` the ball in it; −1: none. What is done at a leaf stands outside
// this loop, as every branch runs in every round; a round more leaves a piece that is done where it is (docs/llvmpipe.md).
int next_leaf(sampler2D nodes, Piece piece, int number, float most, const bool balls, out Node node) {
    bool found;
    do {
        node = fetch_node(nodes, number);
        bool met = meets_box(piece, node, most);
        found = met && is_leaf(node) && (!balls || meets_ball(piece, node));
        number = found || number < 0 ? number : next_node(node, number, met);
    } while (!found && number >= 0);
    return number;
}
