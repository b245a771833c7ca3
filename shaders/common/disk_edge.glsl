// Which part of a pixel a crossing's piece of disk covers, and how far the next pixels' crossings lie.

// A crossing of the disk's plane with its changes from this pixel to the next.
struct Crossing {
    vec2 point;   // r·(cos φ, sin φ), r_s; zero without a crossing
    vec2 right;   // change to the pixel on the right
    vec2 up;      // change to the pixel above
};

// A crossing of a ray of that fate. A neighbour without such a crossing means that the rays part here (near the critical curve): a wide change stands in. But where
// the neighbour has ended on something before it could cross, nothing is known, and no change is.
// Takes differences between pixels, so all pixels must run it: keep it outside every branch.
Crossing crossing_of(vec2 point, int fate) {
    float present = point != vec2(0.0) ? 1.0 : fate == MET ? 0.5 : 0.0;
    vec2 parts = abs(vec2(dFdx(present), dFdy(present)));
    Crossing crossing = Crossing(point, dFdx(point), dFdy(point));
    if (parts.x != 0.0) crossing.right = parts.x < 1.0 ? vec2(0.0) : point;
    if (parts.y != 0.0) crossing.up = parts.y < 1.0 ? vec2(0.0) : point;
    return crossing;
}

// Whether the disk may cover any of the pixel: a third of the cost of `disk_cover`. False where that is 0, and where it is below a hundredth: beside the
// line on which crossings run off to infinity every pixel is wide enough to hold the disk.
bool may_be_covered(Crossing crossing) {
    vec2 change = abs(crossing.right) + abs(crossing.up);
    float reach = 0.5 * (change.x + change.y) + 1e-4 * disk_r_out; // at least the half width below
    float inner = max(disk_r_edge - reach, 0.0), outer = disk_r_out + reach;
    float r2 = dot(crossing.point, crossing.point);
    return r2 > inner * inner && r2 < outer * outer && reach < 100.0 * disk_r_out;
}

// 0…1: how much of the pixel lies between the disk's edges; 0 without a crossing. The pixel's footprint is a stretch of radii about r;
// its share inside the disk is what is covered. So a ring thinner than a pixel is as bright as it is thin.
float disk_cover(Crossing crossing) {
    float r = max(length(crossing.point), 1e-6);
    vec2 radial = vec2(dot(crossing.right, crossing.point), dot(crossing.up, crossing.point)) / r;
    float half_width = 0.5 * max(length(radial), 1e-5 * r);
    float inside = min(disk_r_out, r + half_width) - max(disk_r_edge, r - half_width);
    return crossing.point == vec2(0.0) ? 0.0 : clamp(inside / (2.0 * half_width), 0.0, 1.0);
}

// Whether a point of the plane lies between the disk's edges; without any width, so for views and not for pictures.
bool on_disk(vec2 point) {
    float r2 = dot(point, point);
    return r2 >= disk_r_edge * disk_r_edge && r2 <= disk_r_out * disk_r_out;
}
