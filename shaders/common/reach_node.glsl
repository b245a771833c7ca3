// What a coarse ray comes near, and how it lies in the 32 bits of a node: fate in two, a bit for each ball in 24, what hides the rest in five.

struct Reached {
    uint near;    // balls, before it is hidden
    uint hidden;  // 1 + number of the ball in which it is deeper than the rays beside it are away; 0: none
};

const Reached NONE_REACHED = Reached(0u, 0u);

// With what is found farther on.
Reached reached_on(Reached before, Reached found) {
    if (before.hidden > 0u) return before;
    return Reached(before.near | found.near, found.hidden);
}

uint packed_node(int fate, Reached reached) {
    return uint(fate) | reached.near << 2 | reached.hidden << 26;
}

int node_fate(uint node) {
    return int(node & 3u);
}

Reached node_reached(uint node) {
    return Reached(node >> 2 & 0xffffffu, node >> 26);
}

// Of a cell: what it may show.
const float REACHED_NONE = 0.0, REACHED_ANY = 1.0;
