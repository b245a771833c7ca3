// The balls that a ray may meet, as coarse rays have told of the cells of the picture (reach_cells.frag).

uniform usampler2D cell_balls;  // a bit for each ball that may be the first that is met in the cell
uniform sampler2D reach_balls;  // common/reach.glsl

uniform float stray_seen;       // r_s for each r_s from the camera: by how much outlines made of many parts may be displaced in a picture that moves

uint known_balls = 0u;  // those of this ray

struct KnownBall {
    vec3 centre;  // r_s
    float radius;
    int kind, index;  // of what lies in it
};

uint balls_of_cell(ivec2 cell) {
    return texelFetch(cell_balls, clamp(cell, ivec2(0), textureSize(cell_balls, 0) - 1), 0).r;
}

// To be told once: the balls at `place` in the picture, or at a corner of cells.
void know_balls(vec2 place, bool is_corner) {
    ivec2 cell = ivec2(floor(place / float(REFINE_STEP)));
    known_balls = balls_of_cell(cell);
    if (is_corner) known_balls |= balls_of_cell(cell - ivec2(1, 0)) | balls_of_cell(cell - ivec2(0, 1)) | balls_of_cell(cell - 1);
}

// The first of those `left`, of which there is one, and takes it from them.
KnownBall next_ball(inout uint left) {
    float column = (float(lowest_bit(left)) + 0.5) / float(textureSize(reach_balls, 0).x);  // the nearest texel: docs/llvmpipe.md, texels
    vec4 ball = textureLod(reach_balls, vec2(column, 0.25), 0.0);
    int of = int(textureLod(reach_balls, vec2(column, 0.75), 0.0).x + 0.5) - 1;
    left = without_lowest(left);
    return KnownBall(ball.xyz, abs(ball.w), of & 31, of >> 5);
}

// How far from where it is a way may be looked at where it passes x, r_s.
float unseen_stray(vec3 x) {
    return stray_seen * distance(x, camera_n.xyz * (0.5 / camera_w));
}

// Whether the straight piece from x to y comes into the ball, or as near to it as that.
bool comes_near(KnownBall ball, vec3 x, vec3 y, float stray) {
    vec3 off = ball.centre - x, way = y - x;
    float within = ball.radius + stray + rounding(x, y);
    off -= clamp(dot(off, way) / max(dot(way, way), 1e-30), 0.0, 1.0) * way;
    return dot(off, off) <= within * within;
}

#if MEETINGS_TOLD_APART
// The parts 0…1 of the piece from x to x + way between which it lies in a ball with that radius, `off` from x; the first is the larger where it does not.
vec2 parts_within(vec3 off, vec3 way, float radius) {
    float way2 = max(dot(way, way), 1e-30), nearest = dot(off, way) / way2;
    vec3 aside = off - nearest * way;
    float half_chord2 = (radius * radius - dot(aside, aside)) / way2;
    return half_chord2 > 0.0 ? clamp(nearest + sqrt(half_chord2) * vec2(-1.0, 1.0), 0.0, 1.0) : vec2(1.0, 0.0);
}

// The parameters 0…1 between two places of a way, whose last coordinates are w, where it is beside those parts of the piece, were places linear in it.
vec2 linear_parameters(vec2 parts, vec2 w) {
    return parts * w.x / mix(w.yy, w.xx, parts);
}

// The parameters of the way, from and to the given ones, between which it may come into the known balls, or a little more; the first is the larger where it comes into
// none. How far it bows at its middle, and how far the parameter there is from a linear one, tell of its halves how far each is from straight, and linear, at most.
vec2 within_known(Way way, float from, float to) {
    Path a = way_path(way, from), middle = way_path(way, 0.5 * (from + to)), b = way_path(way, to);
    vec3 x = path_point(a), there = path_point(middle) - x, onward = path_point(b) - path_point(middle), whole = there + onward;
    vec3 w = vec3(a.place.w, middle.place.w, b.place.w);
    float s = clamp(dot(there, whole) / max(dot(whole, whole), 1e-30), 0.0, 1.0), bow = distance(there, s * whole);
    float uneven = 0.0125 + 0.25 * abs(linear_parameters(vec2(s), w.xz).x - 0.5);
    vec2 found = vec2(1.0, 0.0);
    uint left = known_balls;
    if (left != 0u) do {
        KnownBall ball = next_ball(left);
        float radius = 1.03 * ball.radius + bow;
        vec2 first = parts_within(ball.centre - x, there, radius), second = parts_within(ball.centre - x - there, onward, radius);
        vec2 early = 0.5 * linear_parameters(first, w.xy), late = 0.5 + 0.5 * linear_parameters(second, w.yz);
        if (first.x < first.y) found = vec2(min(found.x, early.x), max(found.y, early.y));
        if (second.x < second.y) found = vec2(min(found.x, late.x), max(found.y, late.y));
    } while (left != 0u);
    return min(w.x, min(w.y, w.z)) > 0.0 ? mix(vec2(from), vec2(to), clamp(found + vec2(-uneven, uneven), 0.0, 1.0)) : vec2(from, to);
}
#endif
