// Which part of a pixel a crossing's piece of disk covers, and how far the next pixels' crossings lie.

// A crossing of the disk's plane with its changes from this pixel to the next.
struct Crossing {
    vec2 point;   // r·(cos φ, sin φ), r_s
    vec2 right;   // change to the pixel on the right
    vec2 up;      // change to the pixel above
    float cover;  // 0…1: how much of the pixel lies between the disk's edges; 0 without a crossing
};

// Where a neighbour has no such crossing, the other direction's change stands in, or a small one: never a torn one.
// Takes differences between pixels, so all pixels must run it: keep it outside every branch.
Crossing crossing_of(vec2 point) {
    float present = point == vec2(0.0) ? 0.0 : 1.0;
    bool whole_right = dFdx(present) == 0.0, whole_up = dFdy(present) == 0.0;
    vec2 right = dFdx(point), up = dFdy(point), spare = 0.02 * point;
    Crossing crossing = Crossing(point, right, up, 0.0);
    crossing.right = whole_right ? right : (whole_up ? up : spare);
    crossing.up = whole_up ? up : (whole_right ? right : spare);

    float r = max(length(point), 1e-6);
    vec2 radial = vec2(dot(crossing.right, point), dot(crossing.up, point)) / r;
    // Never wider than a part of the disk: a footprint that holds all of it must still tell inside from outside.
    float width = clamp(length(radial), 1e-5 * r, 0.25 * (disk_r_out - disk_r_in) + 1e-5 * r);
    crossing.cover = present * clamp((r - disk_r_in) / width + 0.5, 0.0, 1.0) * clamp((disk_r_out - r) / width + 0.5, 0.0, 1.0);
    return crossing;
}
