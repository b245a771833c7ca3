// How the pixels between rays at every second one are interpolated: in each direction by the middle four of six in a row, by three of them where the one on one side ends on
// something else, or by all six in both directions. It stands in the cells of refine_half_cells.frag, beside PIXEL_MATTER, in 255ths.

const int BY_FOUR = 0, WITHOUT_FIRST = 1, WITHOUT_LAST = 2;  // in a direction
const int BY_SIX = 9;                                        // in both

float with_way(int along_x, int along_y, bool by_six) {
    return class_depth(PIXEL_MATTER) + float(by_six ? BY_SIX : along_x + 3 * along_y) / 255.0;
}

int way_of_cell(float cell) {
    return int(255.0 * (cell - class_depth(PIXEL_MATTER)) + 0.5);
}
