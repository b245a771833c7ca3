// The coarse grid of a refined hit map: one exact ray at every REFINE_STEP-th pixel, and 16 bits for each cell between four of them.
//
// Nodes, as refine_nodes.frag leaves them:
//   coarse0  escape as a point of common/escape_chart.glsl, λ, steps (−1 − steps unless escaped)
//   coarse1  crossings 0 and 1
//   bend0    second differences of the point, along x and along y
//   bend1, bend2   those of crossing 0, of crossing 1
//
// Cells, as refine_cells.frag judges them:
//   bits 0–1            fate of all its pixels; UNRESOLVED: nothing can be interpolated here, every pixel has a ray of its own
//   bits 2–3, 4–5, 6–7  what to make of crossing 0, 1, 2 (which is never interpolated: it is seen in the thinnest of rings)
//   bit 8               some crossing may lie on the disk
//   bit 9               of cells whose pixels have rays of their own: they show no thing or medium, and none was written
//   bits 10, 11         whether the light comes in towards the hole at crossing 0, at crossing 1, if that is to be interpolated
//   bit 12              one thing fills it: what its pixels meet is interpolated (refine_things.frag)
//
// The grid begins GRID_MARGIN nodes outside the picture: texel (i, j) of the nodes is pixel REFINE_STEP·(i − GRID_MARGIN, j − GRID_MARGIN), and texel (i, j)
// of the cells holds the pixels from REFINE_STEP·(i, j) on.

const uint CROSSING_NONE = 0u;
const uint CROSSING_SEEN = 1u; // to be interpolated
const uint CROSSING_UNSEEN = 2u;  // further out than matters, or none

const uint CELL_WITHOUT_THINGS = 512u, CELL_FILLED = 4096u;

uint cell_crossing(uint cell, int n) {
    return (cell >> (2 + 2 * n)) & 3u;
}

int cell_inbound(uint cell) {
    return int(cell >> 10) & 3;
}

bool cell_has_own_rays(uint cell) {
    return (cell & 3u) == 0u;
}
