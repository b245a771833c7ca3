// Bounding volume hierarchies (blackhole_gl/rendering/hierarchy.py), walked without a stack: a box that is met leads to the next node, one that is missed beyond all
// that lies in it. Boxes are whole numbers of cells of a cubic lattice, so that a node is one texel (docs/llvmpipe.md): in x, y, z the low sides, and 65536 times
// the high ones; in w where the walk goes on beyond an inner node, or for a leaf −1 − 2·(what it holds) − (1 if that is the last). 0 ends a walk: there lies
// the lattice, its corner and the width of a cell.

const int ROW_BITS = 8;  // nodes in a row of the texture, as a power of two

// A straight piece from x, as boxes are tested against it; in cells of the hierarchy's lattice.
struct Piece {
    vec3 x, way, inverse;  // y − x, and 1/(y − x)
    vec3 to_low, to_high;  // x for the low and the high sides of boxes, which are farther out by the pad
    float pad, per_way2;   // and 1/|y − x|²
    float cell;            // its width
};

struct Node {
    vec3 low, high;  // in cells
    int link;        // w
};

// What rounding makes of places on the piece from x to y, or less; in their unit.
float rounding(vec3 x, vec3 y) {
    vec3 size = max(abs(x), abs(y));
    return 1e-6 * max(max(size.x, size.y), size.z);
}

vec4 lattice_of(isampler2D nodes) {
    return intBitsToFloat(texelFetch(nodes, ivec2(0), 0));
}

// That of a way which bends by `bow` from the piece from x to y (common/curve.glsl) and strays from there, in cells of a lattice: its corner and their width.
Piece piece_of(vec4 lattice, vec3 x, vec3 y, vec3 bow, float stray) {
    float pad = (stray + rounding(x, y)) / lattice.w + 0.02;  // and what rounding takes of cells
    vec3 from = (x + 0.5 * bow - lattice.xyz) / lattice.w, way = (y - x) / lattice.w, pads = pad + 0.52 / lattice.w * abs(bow);
    vec3 divisor = mix(way, vec3(1e-20), lessThan(abs(way), vec3(1e-20)));
    return Piece(from, way, 1.0 / divisor, from + pads, from - pads, pad, 1.0 / max(dot(way, way), 1e-30), lattice.w);
}

Node fetch_node(isampler2D nodes, int number) {
    ivec4 node = texelFetch(nodes, ivec2(number & ((1 << ROW_BITS) - 1), number >> ROW_BITS), 0);
    return Node(vec3(node.xyz & 65535), vec3(node.xyz >> 16 & 65535), node.w);
}

// Whether the piece meets the node's box before its part `most`.
bool meets_box(Piece piece, Node node, float most) {
#if RAYS_BOUNDS
    vec3 a = (node.low - piece.to_low) * piece.inverse, b = (node.high - piece.to_high) * piece.inverse;
    vec3 into = min(a, b), out_of = max(a, b);
    return max(max(into.x, into.y), max(into.z, 0.0)) <= min(min(out_of.x, out_of.y), min(out_of.z, most));
#else
    return node.low.x <= node.high.x;  // which is not so where there is none
#endif
}

bool is_leaf(Node node) {
    return node.link < 0;
}

// What a leaf holds.
int held(Node leaf) {
    return (-1 - leaf.link) >> 1;
}

vec3 middle(Node node) {
    return 0.5 * (node.low + node.high);
}

float half_width(Node node) {
    vec3 sides = node.high - node.low;
    return 0.5 * max(max(sides.x, sides.y), sides.z);
}

// Where the walk goes on from `here`, the node with the number `number`; 0 at its end.
int next_node(Node here, int number, bool met) {
    bool follows = is_leaf(here) ? (here.link & 1) != 0 : met;
    return follows ? number + 1 : max(here.link, 0);
}

// Whether the piece comes into the largest ball that fits into the leaf's box, wider by the pad: an instance lies within that.
bool meets_ball(Piece piece, Node leaf) {
    float radius = half_width(leaf) + piece.pad;
    vec3 off = middle(leaf) - piece.x;
    off -= clamp(dot(off, piece.way) * piece.per_way2, 0.0, 1.0) * piece.way;
    return dot(off, off) <= radius * radius;
}

// The first leaf from the node `number` on that the piece meets before its part `most`, where `balls` the ball in it; 0: none. What is done at a leaf stands outside
// this loop, as every branch runs in every round; a round more leaves a piece that is done where it is (docs/llvmpipe.md).
int next_leaf(isampler2D nodes, Piece piece, int number, float most, const bool balls, out Node node) {
    bool found;
    do {
        node = fetch_node(nodes, number);
        bool met = meets_box(piece, node, most);
        found = met && is_leaf(node) && (!balls || meets_ball(piece, node));
        number = found || number <= 0 ? number : next_node(node, number, met);
    } while (!found && number > 0);
    return number;
}
