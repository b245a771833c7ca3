#version 330 core
// Hit map and time → what the media on a ray add to its light and let through, of each stretch of the ray between crossings of the disk's plane.
//
// The hit map keeps where a ray goes into its first medium, and with which momentum. From there the ray is marched again, by its own model and integrator (straight
// where that is what flat space has), to where it leaves all media for good, falls into the hole, meets the opaque thing that the hit map has it end on, or next to
// nothing comes through any more. So several media may overlap, and be met again on the far side of a hole.
//
// GRID: rays are those of a grid of pixels, with a footprint of their own (blackhole_gl/rendering/coarse_transfer.py). FROM_CAMERA: the hit map knows of no media, and every ray
// is marched from the camera.
//
// With s the affine parameter of a photon that has E = 1 far away and shift = E_∞/E in the matter's frame, ds/shift is the way that the matter sees, and
//     dI = (shift·E_observer/E_∞)^p emission ds/shift − I absorption ds/shift        p: 4 of all frequencies, 3 of one
// A piece of the ray is solved exactly for coefficients that are the same all along it: the means by Simpson's rule,
// and a term for how they change along it. The error falls with the fourth power of the step.
//
// Contract of a medium (shaders/media/<key>.glsl): medium_<key>_distance (common/meetings.glsl), and
//     float  medium_<key>_scale(int i, vec3 x)          the length in r_s on which its light and its motion change by about as much as they are, at x, in it or not;
//                                                       steps are a share of it
//     Matter medium_<key>_matter(int i, Sight sight)    what is there (common/matter.glsl); may be asked outside of it
// Header: bolometric, false for light of one frequency; changes, true where its light is another at another time though the ray is the same.
#defines
#blocks
#include "common/constants.glsl"
#include "common/finite.glsl"
#include "common/observer.glsl"
#include "common/rotation.glsl"
#include "common/hermite.glsl"
#include "common/hits.glsl"
#include "common/curve.glsl"
#include "common/hit_map_read.glsl"
#include "common/matter.glsl"
#instances
#slots thing
#slots medium
#include "common/meetings.glsl"
#if MARCHED
#slot ray_model
#slot integrator
#include "common/march_step.glsl"
#else
#include "common/straight_march.glsl"
#endif

layout(location = 0) out vec4 gathered0;
layout(location = 1) out vec4 passed0;
#if ORDERS > 0
layout(location = 2) out vec4 gathered1;
layout(location = 3) out vec4 passed1;
#endif
#if ORDERS > 1
layout(location = 4) out vec4 gathered2;
layout(location = 5) out vec4 passed2;
#endif
#if ORDERS > 2
layout(location = 6) out vec4 gathered3;
layout(location = 7) out vec4 passed3;
#endif

const int MOST_STEPS_ON = 1024, MOST_VISITS = 256, MOST_TRIES = 24;
const float LEAST_PASSED = 1.0 / 512.0;
const float MOST_DEPTH = 0.5;          // of a piece, as its ends see it
const float FINE_SHARE = 1e-3;         // of a medium's scale: how exactly its surface is found
const float HORIZON_MARGIN = 2e-5;     // of its radius: where rays end that fall in
const float NEAR_HORIZON = 1.05, FREE_FALL = 0.1;  // and where they end farther out: in times of its radius, with nothing so near, in times of theirs. They turn without end

// A place on the ray.
struct Here {
    vec3 x, towards;     // r_s; to the camera
    float speed;         // r_s by the parameter of the march
    vec3 gains, loses;   // of light, by the parameter of the march
    float step, fine;    // r_s to go at most; and to be exact to at surfaces
    float edge;          // r_s to the nearest surface of a medium
    int within;          // which media it is in: a bit each
};

void add_matter(inout Here here, inout int bit, float off, float scale, Matter matter, bool bolometric, float energy) {
    bool inside = off < 0.0 && matter.shift > 0.0;
    float way = inside ? 1.0 / matter.shift : 0.0, seen = matter.shift * energy;
    float power = seen * seen * seen * (bolometric ? seen : 1.0);
    here.gains += inside ? way * power * matter.emission : vec3(0.0);
    here.loses += inside ? way * matter.absorption : vec3(0.0);
    here.within ^= off < 0.0 ? bit : 0;
    here.edge = min(here.edge, abs(off));
    here.fine = min(here.fine, FINE_SHARE * scale);
    here.step = min(here.step, off < 0.0 ? plan_medium_step * scale : off + FINE_SHARE * scale);
    bit = bit >= (1 << 30) ? 1 : 2 * bit;
}

// Radius of the hole, r_s, as far as rays are followed.
float inner_radius() {
    return 0.5 * hole_w_factors.x * min(hole_horizon_size, 1.0);
}

// `end`: the opaque thing that the ray ends on; far away where there is none.
Here here_at(Orbit orbit, State s, Sight first, vec3 end, vec3 left) {
    Path path = ray_path(orbit, s);
    Here here;
    here.x = path_point(path);
    vec3 velocity = path_velocity(path);
    here.speed = length(velocity);
    here.towards = -velocity / here.speed;
    here.gains = here.loses = vec3(0.0);
    here.step = here.fine = here.edge = 1e30;
    here.within = 0;
    Sight sight = Sight(here.x, here.towards, first.energy, first.beaming, true, ray_momentum(orbit, s), first.right, first.up);
    int bit = 1;
#each medium : for (int i = 0; i < medium_$key_count; ++i) add_matter(here, bit, medium_$key_distance(i, here.x), medium_$key_scale(i, here.x), medium_$key_matter(i, sight), MEDIUM_$KEY_BOLOMETRIC == 1, sight.beaming);
    float rate = ray_affine_rate(orbit, s);
    here.gains *= rate;
    here.loses *= rate;
    // The way bends and clocks change with the radius, and near the horizon with the height above it.
    float r = length(here.x), most = plan_medium_step * r;
    // Of the radius alone: beside the horizon of a hole that spins a way turns without end.
    float inwards = max(abs(dot(here.towards, here.x)) / r, 1e-6);
    if (here.within != 0) most = min(most, plan_medium_step * max(r - inner_radius(), HORIZON_MARGIN * inner_radius()) / inwards);
    vec3 depth = mix(vec3(0.0), here.loses / here.speed, greaterThan(left, vec3(LEAST_PASSED)));
    most = min(most, MOST_DEPTH / max(max(max(depth.x, depth.y), depth.z), 1e-20));
    here.step = min(min(here.step, most), max(distance(here.x, end), here.fine));
    return here;
}

// Light after `way` more, in the parameter of the march, through matter that gains and loses so much.
Light after_piece(Light light, vec3 gains, vec3 loses, float way) {
    vec3 depth = loses * way, share = (1.0 - exp(-depth)) / max(depth, vec3(1e-20));
    vec3 series = 1.0 - depth * (0.5 - depth * (1.0 / 6.0 - depth * (1.0 / 24.0 - depth / 120.0)));
    share = mix(share, series, lessThan(depth, vec3(0.2)));
    return Light(light.gathered + light.passed * share * gains * way, light.passed * exp(-depth));
}

// Where a state of the march is.
vec3 place_of(Orbit orbit, State s) {
    return path_point(ray_path(orbit, s));
}

// Signed distance of the nearest medium, and how exactly surfaces there are to be found, r_s.
vec2 room_at(vec3 x) {
    vec2 room = vec2(1e30);
#each medium : for (int i = 0; i < medium_$key_count; ++i) room = min(room, vec2(medium_$key_distance(i, x), FINE_SHARE * medium_$key_scale(i, x)));
    return room;
}

void look_within(inout int within, inout int bit, inout float edge, float off) {
    within ^= off < 0.0 ? bit : 0;
    edge = min(edge, abs(off));
    bit = bit >= (1 << 30) ? 1 : 2 * bit;
}

// Which media x is in, as Here tells it, and how far the nearest surface is.
int within_at(vec3 x, out float edge) {
    int within = 0, bit = 1;
    edge = 1e30;
#each medium : for (int i = 0; i < medium_$key_count; ++i) look_within(within, bit, edge, medium_$key_distance(i, x));
    return within;
}

// Whether a ray has nothing before it any more: it has left all for good, come to its `end` or to the horizon.
bool is_over(Orbit orbit, State s, Here here, vec3 end) {
    float r = length(here.x);
    bool gone = !is_finite(here.x) || ray_fate(orbit, s) == ESCAPED || r > meeting_reach && dot(here.x, here.towards) < 0.0;
    return gone || distance(here.x, end) <= here.fine || r < (1.0 + HORIZON_MARGIN) * inner_radius();
}

#if ORDERS > 0
// Whether a piece whose ends are so high above the disk's plane, the second at y, crosses it where crossings count.
bool crosses_plane(vec2 heights, vec3 y) {
    return (heights.x < 0.0) != (heights.y < 0.0) && length(y) > crossing_r_min;
}
#endif

// On through empty space, to where the next step, no longer than it is to the nearest medium, leads into one, or to where the ray is over. Steps go farther than that
// where what is known at both ends says that nothing lies between (Keinert et al. 2014): most of all where the ray goes away from what is nearest.
void cross_gap(Orbit orbit, inout State s, inout Here here, vec3 end, inout int stretch, inout bool over) {
    bool outside = here.within == 0;
    float farther = 0.0;
    for (int i = 0; i < MOST_STEPS_ON; ++i) {
        if (!outside || over) break;
        float close = here.edge + here.fine;
        float most = min(plan_medium_step * length(here.x), max(distance(here.x, end), here.fine));
        here.step = min(close, most);
        float h = min(min(max(farther, close), most) / here.speed, ray_plain_step(orbit, s));
        State next = march_step(orbit, s, h);
        Path path = ray_path(orbit, next);
        vec3 x = path_point(path), velocity = path_velocity(path);
        vec2 room = room_at(x);
        float chord = distance(x, here.x);
        bool unsure = farther > close && here.edge + room.x < 1.05 * chord;
        outside = unsure || room.x >= 0.0;
        farther = unsure ? 0.0 : 1.8 * room.x / max(1.0 - (room.x - here.edge) / max(chord, 1e-20), 0.1);
        if (outside && !unsure) {
#if ORDERS > 0
            stretch = crosses_plane(vec2(disk_height(here.x), disk_height(x)), x) ? min(stretch + 1, ORDERS) : stretch;
#endif
#ifdef RAY_RECHARTS
            next = ray_recharted(s, next);
#endif
            s = next;
            here.x = x;
            here.speed = length(velocity);
            here.towards = -velocity / here.speed;
            here.edge = room.x;
            here.fine = room.y;
            bool sinks = ray_fate(orbit, s) == CAPTURED && length(x) < NEAR_HORIZON * inner_radius() && room.x > FREE_FALL * length(x);
            over = sinks || is_over(orbit, s, here, end);
        }
    }
}

#if GRID
uniform vec2 ray_spacing;  // pixels from ray to ray, and how many a footprint is wide

// What is alike all along a ray of a grid; a pixel is as wide as it is at the hole.
Sight sight_of_grid(vec2 energy) {
    vec3 wide = vec3(ray_spacing.y * picture_scale / camera_w, 0.0, 0.0);
    return Sight(vec3(0.0), vec3(0.0), energy.x, energy.y, true, Momentum(0.0, vec3(0.0)), wide, wide);
}
#endif

#if !FROM_CAMERA
RayStart start_at(Meeting met, float energy) {
    float r = length(met.place);
    RayStart ray;
    ray.w = 0.5 / r;
    ray.w_rate = met.momentum.w_rate;
    ray.n = met.place / r;
    ray.n_rate = met.momentum.n_rate - dot(met.momentum.n_rate, ray.n) * ray.n;
    ray.sine = length(ray.n.xy);
    ray.e_phi = ray.sine > 1e-6 ? vec3(-ray.n.y, ray.n.x, 0.0) / ray.sine : vec3(0.0, 1.0, 0.0);
    ray.e_theta = cross(ray.e_phi, ray.n);
    ray.energy = energy;
    ray.lambda = -energy * ray.sine * dot(ray.n_rate, ray.e_phi);
    return ray;
}
#endif

// A surface ahead: clear up to it, and the little that it lies in, in the parameter of the march. `within` 0: none is known of.
struct Surface {
    float clear, within;
};

// The first surface on the next step, if there is one: false position.
Surface surface_ahead(Orbit orbit, State s, Here here) {
    float fine = here.fine / here.speed, high = min(here.step / here.speed, ray_plain_step(orbit, s)), t = high;
    float clear = 0.0, before = here.edge, after = 0.0;
    for (int k = 0; k < MOST_TRIES; ++k) {
        float edge;
        State middle = march_step(orbit, s, 0.5 * t), next = march_step(orbit, middle, 0.5 * t);  // as light is gathered
        bool same = within_at(place_of(orbit, next), edge) == here.within;
        clear = same ? t : clear;
        before = same ? edge : before;
        high = same ? high : t;
        after = same ? after : edge;
        float root = mix(clear, high, before / max(before + after, 1e-20)), room = 0.02 * (high - clear);
        t = clamp(root - clear > fine ? root - 0.4 * fine : root + 0.4 * fine, clear + room, high - room);
        if (high - clear <= fine) break;
    }
    return Surface(clear, high - clear);
}

void main() {
#if ROWS_HELD
    read_rows();  // a parameter is a texel, and asked for in every step
#endif
#if GRID
    ivec2 pixel = ivec2(min(ray_spacing.x * floor(gl_FragCoord.xy), vec2(textureSize(hits0, 0) - 1)));
#else
    ivec2 pixel = ivec2(gl_FragCoord.xy);
#endif
    vec3 local = pixel_direction(picture_place(vec2(pixel) + 0.5)), end = vec3(1e15);
#if FROM_CAMERA
    Hits hits = fetch_escape(pixel);
    RayStart start = ray_start(local);
    bool any = true;
    int stretch = 0;
#else
    Hits hits = fetch_hits(pixel);
    Meeting met = hits.meeting[0];
    for (int k = 0; k < MEETINGS; ++k) {
        Meeting found = hits.meeting[k];
        if (is_medium(found.kind)) met = found;
        if (found.kind >= 0 && hits.fate == MET) end = found.place;
    }
    RayStart start = start_at(met, ray_start(local).energy);
    bool any = is_medium(met.kind);
    int stretch = min(met.before, ORDERS);
#endif
#if GRID
    Sight first = sight_of_grid(pixel_energies(local));
#else
    Sight first = sight_of(met, pixel_energies(local));
#endif

    Light light[ORDERS + 1];
    for (int n = 0; n <= ORDERS; ++n) light[n] = Light(vec3(0.0), vec3(1.0));
    vec3 left = vec3(1.0);

    Orbit orbit = ray_orbit(start);
    State s = ray_init(start, orbit, hits);
    Here here = here_at(orbit, s, first, end, left);
    bool over = !any;
    int surfaces = 0;  // of media that it leaves; whether it goes into the one that it begins at is rounding
    int pieces = 0;  // of which light has been gathered; kept as the first alpha, for tests and charts
    for (int i = 0; i < MOST_VISITS; ++i) {
        cross_gap(orbit, s, here, end, stretch, over);
        if (over) break;
        Surface ahead = surface_ahead(orbit, s, here);
        while (pieces < MOST_STEPS_ON) {
            // Up to a surface, then the little that it lies in.
            bool across = ahead.within > 0.0 && ahead.clear <= 0.0;
            float h = min(here.step / here.speed, ray_plain_step(orbit, s));
            if (ahead.within > 0.0) h = across ? ahead.within : min(h, ahead.clear);
            State middle = march_step(orbit, s, 0.5 * h), next = march_step(orbit, middle, 0.5 * h);
            Here between = here_at(orbit, middle, first, end, left), there = here_at(orbit, next, first, end, left);
            bool lost = !is_finite(between.gains + between.loses) || !is_finite(there.gains + there.loses);  // there a place may have no rate
            if (lost || ahead.within == 0.0 && there.within != here.within) {  // or a surface that is still to be found
                over = lost;
                break;
            }
            ++pieces;
            surfaces += across && (here.within & ~there.within) != 0 ? 1 : 0;
            float share = here.edge / max(here.edge + there.edge, 1e-20);  // of a piece with a surface in it that is as it begins
            vec3 gains = across ? mix(there.gains, here.gains, share) : (here.gains + 4.0 * between.gains + there.gains) * (1.0 / 6.0);
            vec3 loses = across ? mix(there.loses, here.loses, share) : (here.loses + 4.0 * between.loses + there.loses) * (1.0 / 6.0);
            // What comes from deeper in is dimmed by more than the mean: the next term of the piece's light (Magnus), of the same order as Simpson's rule.
            if (!across) gains = max(gains + h / 12.0 * (here.gains * there.loses - there.gains * here.loses), 0.0);
            float crossed = 1.0;
#if ORDERS > 0
            vec2 heights = vec2(disk_height(here.x), disk_height(there.x));
            bool crosses = crosses_plane(heights, there.x);
            if (crosses) crossed = abs(heights.x) / max(abs(heights.x) + abs(heights.y), 1e-20);
#endif
            for (int n = 0; n <= ORDERS; ++n)
                if (n == stretch) light[n] = after_piece(light[n], gains, loses, crossed * h);
#if ORDERS > 0
            if (crosses) {
                stretch = min(stretch + 1, ORDERS);
                for (int n = 0; n <= ORDERS; ++n)
                    if (n == stretch) light[n] = after_piece(light[n], gains, loses, (1.0 - crossed) * h);
            }
#endif
            left *= exp(-loses * h);
            over = all(lessThan(left, vec3(LEAST_PASSED))) || is_over(orbit, next, there, end);
            ahead = across ? Surface(0.0, 0.0) : Surface(ahead.clear - h, ahead.within);
#ifdef RAY_RECHARTS
            next = ray_recharted(s, next);
#endif
            s = next;
            here = there;
            if (over || here.within == 0 && ahead.within == 0.0) break;
        }
        if (over || pieces >= MOST_STEPS_ON) break;
    }
    gathered0 = vec4(light[0].gathered, float(pieces));
    passed0 = vec4(light[0].passed, float(hits.fate + 8 * (min(surfaces, 31) + 32 * stretch)));  // the ray's history, for transfer_marks.frag
#if ORDERS > 0
    gathered1 = vec4(light[1].gathered, 1.0);
    passed1 = vec4(light[1].passed, 1.0);
#endif
#if ORDERS > 1
    gathered2 = vec4(light[2].gathered, 1.0);
    passed2 = vec4(light[2].passed, 1.0);
#endif
#if ORDERS > 2
    gathered3 = vec4(light[3].gathered, 1.0);
    passed3 = vec4(light[3].passed, 1.0);
#endif
}
