// What a coarse ray comes near, and how it lies in the two numbers of a node: fate in two bits, a bit for each ball between rays in 24, what holds it in five; a bit for
// each ball near.

struct Reached {
    uint near;     // balls that a ray beside it may meet, before it is hidden
    uint between;  // those of them that may come between four rays of which none meets one
    uint hidden;   // 1 + number of the ball in which it is deeper than the rays beside it are away; 0: none
    uint holds;    // 1 + number of the first ball that it is in; 0: none. `between` is told up to there
};

const Reached NONE_REACHED = Reached(0u, 0u, 0u, 0u);

// With what is found farther on.
Reached reached_on(Reached before, Reached found) {
    if (before.hidden > 0u) return before;
    bool held = before.holds > 0u;
    return Reached(before.near | found.near, before.between | (held ? 0u : found.between), found.hidden, held ? before.holds : found.holds);
}

uvec2 packed_node(int fate, Reached reached) {
    return uvec2(uint(fate) | reached.between << 2 | reached.holds << 26, reached.near);
}

int node_fate(uvec2 node) {
    return int(node.x & 3u);
}

Reached node_reached(uvec2 node) {
    return Reached(node.y, node.x >> 2 & 0xffffffu, 0u, node.x >> 26);
}

// Of a cell: what it may show. REACHED_NEAR: nothing, unless directions are not to be interpolated between its corners.
const float REACHED_NONE = 0.0, REACHED_NEAR = 254.0 / 255.0, REACHED_ANY = 1.0;

bool is_near(float cell) {
    return abs(cell - REACHED_NEAR) < 0.001;
}
