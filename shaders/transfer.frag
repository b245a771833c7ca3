#version 330 core
// Hit map and time → what the media on a ray add to its light and take from what lies behind, of each stretch of the ray between crossings of the disk's plane.
//
// The hit map keeps where a ray goes into its first medium, and with which momentum. From there the ray is marched again, by its own model and integrator (straight
// where that is what flat space has), to where it leaves all media for good, falls into the hole, meets the opaque thing that the hit map has it end on, or next to
// nothing comes through any more. So several media may overlap, and be met again on the far side of a hole.
//
// FROM_CAMERA: the hit map knows of no media, and every ray is marched from the camera, as where nothing but media and the disk can be met: looking for where media begin
// took the trace several times as long. GRID: those are the rays of a grid of pixels or of a list of some, with a footprint of their own
// (blackhole_gl/rendering/coarse_transfer.py).
//
// SAMPLES: of a listed ray the next samples are told instead of light: each stands for a piece, by the place of its middle and what a medium without its pattern gains and loses
// on it; and where the ray goes on. So a pattern that moves is summed anew without a march (transfer_samples.frag, blackhole_gl/rendering/kept_samples.py).
//
// With s the affine parameter of a photon that has E = 1 far away and shift = E_∞/E in the matter's frame, ds/shift is the way that the matter sees, and
//     dI = (shift·E_observer/E_∞)^p emission ds/shift − I absorption ds/shift        p: 4 of all frequencies, 3 of one
// A piece of the ray is solved exactly for coefficients that are the same all along it: the means by Simpson's rule,
// and a term for how they change along it. The error falls with the fourth power of the step. On a grid the middle alone stands for a piece.
//
// Contract of a medium (shaders/media/<key>.glsl): medium_<key>_distance (common/meetings.glsl), and
//     float  medium_<key>_scale(int i, vec3 x)          the length in r_s on which its light and its motion change by about as much as they are, at x, in it or not;
//                                                       steps are a share of it
//     Matter medium_<key>_matter(int i, Sight sight)    what is there (common/matter.glsl); may be asked outside of it
//     float  medium_<key>_pattern(int i, vec3 x, float footprint)  where the header says so, how much more of it there is at this time: a factor of emission and
//                                                       absorption, mean 1, with nothing finer than `footprint` r_s
// Header: bolometric, false for light of one frequency; changes, true where it has a pattern, and its light is another at another time though the ray is the same;
// soft, true where next to nothing of it is left at its surface: a coarse picture need not show that as an edge.
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
#include "common/look_back.glsl"
#instances
#slots thing
#slots medium
#each steady_medium : float medium_$key_pattern(int i, vec3 x, float footprint) { return 1.0; }
#include "common/meetings.glsl"
#if MARCHED
#slot ray_model
#slot integrator
#include "common/march_step.glsl"
#else
#include "common/straight_march.glsl"
#endif

#if SAMPLES
layout(location = 0) out vec4 place0;    // its middle, r_s; the stretch that it lies in, below 0: there is none
layout(location = 1) out vec4 gains0;
layout(location = 2) out vec4 loses0;
layout(location = 3) out vec4 place1;
layout(location = 4) out vec4 gains1;
layout(location = 5) out vec4 loses1;
layout(location = 6) out vec4 goes_on;   // from where; the stretch there and half of what comes through from there, below 0: no farther
layout(location = 7) out vec4 momentum;  // with which
#else
layout(location = 0) out vec4 gathered0;
layout(location = 1) out vec4 dimmed0;
#if ORDERS > 0
layout(location = 2) out vec4 gathered1;
layout(location = 3) out vec4 dimmed1;
#endif
#if ORDERS > 1
layout(location = 4) out vec4 gathered2;
layout(location = 5) out vec4 dimmed2;
#endif
#if ORDERS > 2
layout(location = 6) out vec4 gathered3;
layout(location = 7) out vec4 dimmed3;
#endif
#endif

#include "common/media_march.glsl"

#if GRID
uniform vec2 ray_spacing;      // pixels from ray to ray, below 0 where they are listed; and how many a footprint is wide
uniform sampler2D ray_pixels;  // column and row of each listed ray
#if SAMPLES
uniform sampler2D last_places, last_momenta;  // where each listed ray goes on, as was told
uniform bool begins;                          // at the camera
#endif
#endif

#if FROM_CAMERA
// What is alike all along a ray; a pixel is as wide as it is at the hole.
Sight sight_from_camera(vec2 energy) {
#if GRID
    float pixels = ray_spacing.y;
#else
    float pixels = 1.0 / block_side;
#endif
    vec3 wide = vec3(pixels * pixel_at_hole(), 0.0, 0.0);
    return Sight(vec3(0.0), vec3(0.0), energy.x, energy.y, true, -1, Momentum(0.0, vec3(0.0)), wide, wide);
}
#endif

#if SAMPLES || !FROM_CAMERA
RayStart start_at(vec3 place, Momentum momentum, float energy) {
    float r = length(place);
    RayStart ray;
    ray.w = 0.5 / r;
    ray.w_rate = momentum.w_rate;
    ray.n = place / r;
    ray.n_rate = momentum.n_rate - dot(momentum.n_rate, ray.n) * ray.n;
    ray.sine = length(ray.n.xy);
    ray.e_phi = ray.sine > 1e-6 ? vec3(-ray.n.y, ray.n.x, 0.0) / ray.sine : vec3(0.0, 1.0, 0.0);
    ray.e_theta = cross(ray.e_phi, ray.n);
    ray.energy = energy;
    ray.lambda = -energy * ray.sine * dot(ray.n_rate, ray.e_phi);
    return ray;
}
#endif

void main() {
#if ROWS_HELD
    read_rows();  // a parameter is a texel, and asked for in every step
#endif
#if GRID
    vec2 ray = ray_spacing.x > 0.0 ? floor(gl_FragCoord.xy) : texelFetch(ray_pixels, ivec2(gl_FragCoord.xy), 0).xy;
    ivec2 pixel = ivec2(clamp(abs(ray_spacing.x) * ray, vec2(0.0), vec2(textureSize(hits0, 0) - 1)));
#else
    ivec2 pixel = ivec2(gl_FragCoord.xy);
#endif
    vec2 place = picture_place(vec2(pixel) + 0.5);
    vec3 local = pixel_direction(place), end = vec3(1e15);
#if FROM_CAMERA
    Hits hits = fetch_escape(pixel);
    RayStart start = ray_start(local);
    bool any = place.x >= 0.0;  // a block of rays may be nobody's
    int stretch = 0;
#else
    Hits hits = fetch_hits(pixel);
    Meeting met = hits.meeting[0];
    for (int k = 0; k < MEETINGS; ++k) {
        Meeting found = hits.meeting[k];
        if (is_medium(found.kind)) met = found;
        if (found.kind >= 0 && hits.fate == MET) end = found.place;
    }
    bool any = is_medium(met.kind);
    int stretch = min(met.before, ORDERS);
    RayStart start = start_at(met.place, met.momentum, ray_start(local).energy);
#endif
#if GRID
    any = any && ray.x >= 0.0;
#endif
#if SAMPLES
    vec4 last = texelFetch(last_places, ivec2(gl_FragCoord.xy), 0), heading = texelFetch(last_momenta, ivec2(gl_FragCoord.xy), 0);
    if (!begins) {
        start = start_at(last.xyz, Momentum(heading.x, heading.yzw), start.energy);
        any = last.w >= 0.0;
        stretch = max(int(last.w), 0);
    }
    place0 = place1 = vec4(-1.0);
    gains0 = gains1 = loses0 = loses1 = vec4(0.0);
    int told = 0;
#endif
#if FROM_CAMERA
    Sight first = sight_from_camera(pixel_energies(local));
#else
    Sight first = sight_of(met, pixel_energies(local));
#endif

    Light light[ORDERS + 1];
    for (int n = 0; n <= ORDERS; ++n) light[n] = Light(vec3(0.0), vec3(1.0));
    vec3 left = vec3(1.0);
#if SAMPLES
    if (!begins) left = vec3(2.0 * fract(last.w));
#endif

    Orbit orbit = ray_orbit(start);
    State s = ray_init(start, orbit, hits);
#if RAYS_LIGHT_TRAVEL && !FROM_CAMERA
    s = ray_delayed(s, met.delay);
#endif
    bool over = !any, meets_disk = stretch > 0;
#if FROM_CAMERA
    if (camera_w == 0.0) come_from_infinity(orbit, s, start.n, stretch, meets_disk);
#endif
    Here here = here_at(orbit, s, first, end, left, ENDS_LIT, vec3(0.0));
    int surfaces = 0, edged = edged_media();  // surfaces of those that it leaves; whether it goes into the one that it begins at is rounding
    int pieces = 0;  // of which light has been gathered; kept as the first alpha, for tests and charts
    for (int i = 0; i < MOST_VISITS; ++i) {
        cross_gap(orbit, s, here, end, stretch, meets_disk, over);
        if (over) break;
        Surface ahead = Surface(0.0, 0.0);
        if (EDGED) ahead = surface_ahead(orbit, s, here);
        while (pieces < MOST_STEPS_ON) {
            // Up to a surface, then the little that it lies in.
            bool across = ahead.within > 0.0 && ahead.clear <= 0.0;
            float h = min(here.step / here.speed, ray_plain_step(orbit, s));
            if (ahead.within > 0.0) h = across ? ahead.within : min(h, ahead.clear);
            State middle = march_step(orbit, s, 0.5 * h), next = march_step(orbit, middle, 0.5 * h);
            Here between = here_at(orbit, middle, first, end, left, true, vec3(0.0)), there = here_at(orbit, next, first, end, left, ENDS_LIT, between.loses);
            bool lost = !is_finite(between.gains + between.loses) || !is_finite(there.gains + there.loses);  // there a place may have no rate
            if (lost || EDGED && ahead.within == 0.0 && there.within != here.within) {  // or a surface that is still to be found
                over = lost;
                break;
            }
            ++pieces;
            surfaces += across && (here.within & ~there.within & edged) != 0 ? 1 : 0;
#if GRID
            vec3 gains = between.gains, loses = between.loses;  // by the midpoint
#else
            float share = here.edge / max(here.edge + there.edge, 1e-20);  // of a piece with a surface in it that is as it begins
            vec3 gains = across ? mix(there.gains, here.gains, share) : (here.gains + 4.0 * between.gains + there.gains) * (1.0 / 6.0);
            vec3 loses = across ? mix(there.loses, here.loses, share) : (here.loses + 4.0 * between.loses + there.loses) * (1.0 / 6.0);
            // What comes from deeper in is dimmed by more than the mean: the next term of the piece's light (Magnus), of the same order as Simpson's rule.
            if (!across) gains = max(gains + h / 12.0 * (here.gains * there.loses - there.gains * here.loses), 0.0);
#endif
            float crossed = 1.0;
            int from_stretch = stretch;
#if ORDERS > 0
            vec2 heights = vec2(disk_height(here.x), disk_height(there.x));
            bool crosses = crosses_plane(heights, there.x);
            if (crosses) crossed = abs(heights.x) / max(abs(heights.x) + abs(heights.y), 1e-20);
#if SAMPLES
            if (crosses && told == 1) {  // there is no room for both of its parts
                told = 2;
                break;
            }
#endif
#endif
            Passage piece = passage_of(loses, crossed * h);
            for (int n = 0; n <= ORDERS; ++n)
                if (n == stretch) light[n] = after_piece(light[n], piece, gains * (crossed * h));
            left *= piece.passed;
#if ORDERS > 0
            Passage beyond = passage_of(loses, (1.0 - crossed) * h);
            stretch = crosses ? min(stretch + 1, ORDERS) : stretch;
            meets_disk = meets_disk || crosses && is_near_disk(there.x);
            for (int n = 0; n <= ORDERS; ++n)
                if (crosses && n == stretch) light[n] = after_piece(light[n], beyond, gains * ((1.0 - crossed) * h));
            left *= beyond.passed;
#endif
#if SAMPLES
            bool parted = crossed < 1.0;
            vec4 sample_place = vec4(parted ? mix(here.x, there.x, 0.5 * crossed) : between.x, float(from_stretch)), gain = vec4(gains * h, 0.0), loss = vec4(loses * h, 0.0);
            if (!across && told == 0) { place0 = sample_place; gains0 = crossed * gain; loses0 = crossed * loss; }
            if (!across && told == 1) { place1 = sample_place; gains1 = gain; loses1 = loss; }
            if (!across && parted) { place1 = vec4(mix(there.x, here.x, 0.5 - 0.5 * crossed), float(stretch)); gains1 = (1.0 - crossed) * gain; loses1 = (1.0 - crossed) * loss; }
            told += across ? 0 : parted ? 2 : 1;
#endif
            over = all(lessThan(left, vec3(LEAST_PASSED))) || is_over(orbit, next, there, end);
            ahead = across ? Surface(0.0, 0.0) : Surface(ahead.clear - h, ahead.within);
#ifdef RAY_RECHARTS
            next = ray_recharted(s, next);
#endif
            s = next;
            here = there;
            if (over || here.within == 0 && ahead.within == 0.0) break;
#if SAMPLES
            if (told == 2) break;
#endif
        }
        if (over || pieces >= MOST_STEPS_ON) break;
#if SAMPLES
        if (told == 2) break;
#endif
    }
#if SAMPLES
    Momentum onward = ray_momentum(orbit, s);
    bool ends = over || told < 2;
    goes_on = vec4(here.x, ends ? -1.0 : float(stretch) + 0.5 * max(max(left.x, left.y), left.z));
    momentum = vec4(onward.w_rate, onward.n_rate);
#else
    gathered0 = vec4(light[0].gathered, float(pieces));
    dimmed0 = vec4(1.0 - light[0].passed, float(hits.fate + 8 * (min(surfaces, 31) + 32 * (stretch + 4 * int(meets_disk)))));  // the ray's history, for transfer_cells.frag
#if ORDERS > 0
    gathered1 = vec4(light[1].gathered, 1.0);
    dimmed1 = vec4(1.0 - light[1].passed, 1.0);
#endif
#if ORDERS > 1
    gathered2 = vec4(light[2].gathered, 1.0);
    dimmed2 = vec4(1.0 - light[2].passed, 1.0);
#endif
#if ORDERS > 2
    gathered3 = vec4(light[3].gathered, 1.0);
    dimmed3 = vec4(1.0 - light[3].passed, 1.0);
#endif
#endif
}
