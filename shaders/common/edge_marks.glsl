// What of a pixel's ray is alike on all sides where nothing ends, in two numbers of eight bits: EDGE_… (glsl/declared.py), and what is met. The host looks for
// where they change (blackhole_gl/rendering/edge_pixels.py). A ring may be thinner than a pixel and met by no pixel's middle; but it lies beside the line across which
// the fate changes, or the order. The second ring is thin everywhere: there every pixel differs from the next.

uniform bool disk_hides; // whether the direct picture hides the first ring's edges well enough

// Where a crossing lies: 0 outside the disk's outer edge, 1 on the disk, 2 inside its inner edge. Between 0 and 2 lies a disk too thin to be met. One that is nowhere
// is beyond all edges, where rays escape; where they end in the hole it is, too, as crossings run into that before there are none.
int edge_zone(vec2 point, int fate) {
    bool nowhere = point == vec2(0.0);
    return on_disk(point) ? 1 : (nowhere ? fate == CAPTURED : dot(point, point) < disk_r_edge * disk_r_edge) ? 2 : 0;
}

#if IN_FIELD
// Whether a pixel's ray comes from without into the sphere in which it is bent: at its rim what is seen breaks off, be it of one kind on both sides.
bool enters_field(ivec2 pixel) {
    RayStart start = ray_start(pixel_direction(vec2(pixel) + 0.5));
    bool outside = 2.0 * camera_w * rays_field_radius < 1.0;
    return outside && start.w_rate > 0.0 && 0.5 * length(start.n_rate) < rays_field_radius;
}
#endif

vec2 edge_mark(Hits hits, ivec2 pixel) {
    int seen = hits.fate, met = 0;
#if IN_FIELD
    seen |= enters_field(pixel) ? EDGE_IN_FIELD : 0;
#endif
#if ORDERS > 1
    seen |= edge_zone(hits.crossing[1], hits.fate) * EDGE_RING_1 | edge_zone(hits.crossing[2], hits.fate) * EDGE_RING_2;
#endif
#if ORDERS > 0 && DISK_COMPOSITING_OPACITY
    seen |= disk_hides && on_disk(hits.crossing[0]) ? EDGE_VEILED : 0;
#endif
#if MEETINGS
    for (int k = 0; k < MEETINGS; ++k)
        met = met * 31 + hits.meeting[k].kind + 1;
    met = met > 0 ? 1 + met % EDGE_MET : 0;
#endif
#if ORDERS > 1
    met |= on_disk(hits.crossing[2]) ? ((pixel.x + pixel.y) & 1) << 7 : 0;
#endif
    return vec2(seen, met) / 255.0;
}
