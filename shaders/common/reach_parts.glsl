// What has many parts fills little of its ball. Where a coarse ray (reach_nodes.frag) comes near such balls, it is held against the parts too, wider by as much as the rays
// beside it are away: both halves of those steps, in a march of its own, so that all rays of a vector look at once (docs/llvmpipe.md).
//
// Takes what meetings.glsl, reach.glsl and march.glsl tell.

uniform uint reach_parted; // a bit for each ball in which one thing lies that tells_apart

const int MOST_NEAR = 3; // steps that are looked at; Kerr's are hardly ever more

// Where a ray comes near balls of what has many parts.
struct NearParts {
    uint balls;       // a bit each
    uint untold;      // those of them that are near where nothing is looked at, a bit each
    uint steps;       // those to look at, a bit each
    int count;        // of them
    vec3 begin, end;  // how far rays beside it are away where each of them begins and ends, at most, r_s
    float part;       // of the last of them, after which the ray leaves what holds all balls
};

const NearParts NO_PARTS = NearParts(0u, 0u, 0u, 0, vec3(0.0), vec3(0.0), 1.0);

// With the step of that number, if there are any such `balls` in it.
NearParts near_parts_on(NearParts before, uint balls, bool looks, int step, float part, float begin, float end) {
    NearParts found = before;
    found.balls |= balls;
    bvec3 here = equal(ivec3(before.count), ivec3(0, 1, 2));
    bool keeps = looks && balls != 0u && before.count < MOST_NEAR && step < 32;
    if (keeps) found = NearParts(found.balls, before.untold, before.steps | 1u << step, before.count + 1, mix(before.begin, vec3(begin), here), mix(before.end, vec3(end), here), part);
    if (!keeps) found.untold |= balls;
    return found;
}

// Whether the way from a to b, a part of a step of length h, may come as near as `margin` to what lies in the ball of that number.
bool comes_near_parts(Path a, Path b, float h, float margin, int ball) {
    float column = (float(ball) + 0.5) / float(textureSize(reach_balls, 0).x); // the nearest texel: docs/llvmpipe.md, texels
    int of = int(textureLod(reach_balls, vec2(column, 0.75), 0.0).x + 0.5) - 1, part;
    bool enters;
    Stray stray = path_stray(a, b, h);
    float met = met_part(of & 31, of >> 5, 1.0, path_point(a) + stray.aside, path_point(b) + stray.aside AND_TIME(vec2(0.0)), vec3(0.0), stray.moved_off + margin, enters, part);
    return met <= 1.0 || stray.off > 1e29;
}

// Those of the balls that are `near` to whose parts a ray from `first` on comes near, and those of which that is not told.
uint near_to_parts(Orbit orbit, State first, NearParts near) {
    March m = march_start(orbit, first);
    uint told = near.balls & ~near.untold, steps = told == 0u ? 0u : near.steps, found = 0u;
    vec3 begin = near.begin, end = near.end;
    if (steps != 0u) do {
        bool looks;
        do {
            march_once(orbit, m);
            looks = (steps & 1u) != 0u;
            steps >>= 1;
        } while (!looks);
        float h = steps == 0u ? near.part * m.h : m.h;
        Path middle = ray_path(orbit, march_step(orbit, m.s, 0.5 * h)), last = ray_path(orbit, march_step(orbit, m.s, h));
        Path a = ray_path(orbit, m.s), b = middle;
        float before = distance(path_point(a), path_point(middle)), after = distance(path_point(middle), path_point(last));
        float between = mix(begin.x, end.x, before / max(before + after, 1e-20)), margin = max(begin.x, between);
        bool first_half = true, again;
        do {
            uint left = told & ~found;
            if (left != 0u) do {
                int ball = lowest_bit(left);
                if (comes_near_parts(a, b, 0.5 * h, margin, ball)) found |= 1u << ball;
                left = without_lowest(left);
            } while (left != 0u);
            again = first_half;
            first_half = false;
            a = middle;
            b = last;
            margin = max(between, end.x);
        } while (again);
        begin = begin.yzx;
        end = end.yzx;
        if (found == told) steps = 0u;
    } while (steps != 0u);
    return found | near.untold;
}
