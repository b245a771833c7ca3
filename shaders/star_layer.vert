#version 330 core
// Listed pixels of a coarse picture → the single stars in them as points on the picture enlarged: the brightest of each, then the second ones of those that may have
// several. A point without one is nowhere.
// A star is placed by its offset from the pixel's own direction, and the map's slopes there. Who finds it in his pixel, or just beside it, draws it: neighbours that
// differ a little about the border both do, rather than neither, and the brighter of the two is kept. An image longer than a few pixels, as beside an Einstein ring,
// bends with the map: every pixel that it reaches draws what lies in it, by its own slopes.
// TURNED: the map has directions at even steps of longitude and latitude, and the picture shown is another's (blackhole_gl/rendering/turning.py).
#defines
#blocks
#include "common/constants.glsl"
#include "common/observer.glsl"
#include "common/hits.glsl"
#include "common/hit_map_read.glsl"
#include "common/sky_beaming.glsl"
#slot sky

uniform sampler2D pixels;    // x, y of a point's pixel each, row by row
uniform int firsts;          // pixels whose brightest star is drawn
uniform sampler2D radiance;  // of the coarse picture; alpha: share of the sky's light that comes through, its sign that of shade_sky.frag
#if POST_BLOOM
uniform sampler2D glow;
uniform vec4 glow_window;    // from a place in `radiance`, 0…1, to that in `glow`: scale, shift
#endif
uniform vec2 finer;          // size of the coarse picture over that shown
uniform vec2 shown_texel;   // 1 / size of the picture shown
#if TURNED
uniform mat3 to_plane;       // (back, down, right) in the map's frame → (x, y, 1) · ahead, x and y −1 to 1 in the picture shown
#endif

// Of the star: where it is, in pixels shown; the matrix (xx, xy, yy) by which the square of an offset from there is measured, 1 where the kernel ends; its
// radiance in the middle; and the glow there, which is smooth.
flat out vec2 place;
flat out vec3 stretch;
flat out vec3 brightest;
flat out vec3 glowing;
#if TURNED
// Of `place` in the map, 0…1, and how that changes to the right and up.
flat out vec2 map_place;
flat out vec4 map_steps;
#endif

const float WITHIN = 0.51;     // of a pixel from its middle
const float NEAR = 0.7;        // the same, before the map's bend is reckoned with
const float LONG = 8.0;        // of a star's image from its middle, in pixels shown: from there on it is drawn by pieces

// How the direction changes along one axis of the picture, about a pixel: once and twice.
struct Slope {
    vec3 once, twice;
    bool known;
};

Slope slope_of(Hits before, Hits own, Hits after) {
    bool back = before.fate == ESCAPED, on = after.fate == ESCAPED;
    if (back && on) return Slope(0.5 * (after.direction - before.direction), after.direction - 2.0 * own.direction + before.direction, own.fate == ESCAPED);
    return Slope(on ? after.direction - own.direction : own.direction - before.direction, vec3(0.0), own.fate == ESCAPED && (back || on));
}

// The direction at an offset from the pixel's middle, and how it changes there, in pixels.
struct Place {
    vec3 direction;
    vec3 right, up;
};

Place place_at(vec3 own, Slope x, Slope y, vec3 mixed, vec2 at) {
    vec3 direction = own + at.x * (x.once + 0.5 * at.x * x.twice) + at.y * (y.once + 0.5 * at.y * y.twice) + at.x * at.y * mixed;
    return Place(direction, x.once + at.x * x.twice + at.y * mixed, y.once + at.y * y.twice + at.x * mixed);
}

// Where a place of the map is shown, in pixels.
vec2 shown_place(vec2 at) {
#if TURNED
    vec3 v = to_plane * pixel_direction(at);
    return (0.5 + 0.5 * v.xy / max(v.z, 1e-3)) / shown_texel;
#else
    return at / finer;
#endif
}

// How places of the map change from a pixel shown to the next to the right, and above.
mat2 map_slopes(vec2 at) {
#if TURNED
    vec2 x = shown_place(at + vec2(0.5, 0.0)) - shown_place(at - vec2(0.5, 0.0)), y = shown_place(at + vec2(0.0, 0.5)) - shown_place(at - vec2(0.0, 0.5));
    return inverse(mat2(x, y));
#else
    return mat2(finer.x, 0.0, 0.0, finer.y);
#endif
}

// (g.x g.y; g.y g.z)⁻¹
vec3 inverse_of(vec3 g, float det) {
    return vec3(g.z, -g.y, g.x) / det;
}

// Gram matrix of the two, and its determinant, the square of the solid angle that they span.
vec4 gram_of(vec3 right, vec3 up) {
    vec3 crossed = cross(right, up);
    return vec4(dot(right, right), dot(right, up), dot(up, up), max(dot(crossed, crossed), 1e-30));
}

Hits hits_beside(ivec2 here, ivec2 step) {
    ivec2 there = here + step, size = textureSize(radiance, 0);
#if TURNED
    return fetch_escape((there + size) % size);  // it is kept in a ring
#else
    Hits hits = fetch_escape(there);
    if (any(lessThan(there, ivec2(0))) || any(greaterThanEqual(there, size))) hits.fate = UNRESOLVED;
    return hits;
#endif
}

// A star that a pixel may hold.
struct Star {
    int n;            // for sky_star
    vec3 direction;
    float power;
};

// Where `direction` is by the slopes at `at`, in pixels from there.
vec2 offset_of(vec3 direction, Place at) {
    vec3 left = direction - at.direction;
    vec4 gram = gram_of(at.right, at.up);
    vec3 inverse = inverse_of(gram.xyz, gram.w);
    vec2 along = vec2(dot(left, at.right), dot(left, at.up));
    return vec2(dot(inverse.xy, along), dot(inverse.yz, along));
}

// The kernel's covariance in pixels shown: a pixel, and the star's own `size` in rad, by slopes to a pixel shown.
vec3 spread_of(vec4 gram, float size) {
    return vec3(1.0, 0.0, 1.0) + size * size * inverse_of(gram.xyz, gram.w);
}

// Its eigenvalue along the image.
float longest(vec3 spread) {
    float across = 0.5 * (spread.x - spread.z);
    return 0.5 * (spread.x + spread.z) + sqrt(across * across + spread.y * spread.y);
}

// Whether an image with its middle `d` pixels shown away reaches into the pixel: by its kernel, widened by a little more than half the pixel's diagonal.
bool reaches(vec2 d, vec3 spread) {
    vec2 wider = 0.36 / finer + 0.7;
    spread += vec3(wider.x * wider.x, 0.0, wider.y * wider.y);
    vec3 inverse = inverse_of(spread, spread.x * spread.z - spread.y * spread.y);
    return inverse.x * d.x * d.x + 2.0 * inverse.y * d.x * d.y + inverse.z * d.y * d.y < 4.0;
}

void main() {
    carry();
    int width = textureSize(pixels, 0).x, entry = gl_VertexID;
    ivec2 here = ivec2(texelFetch(pixels, ivec2(entry % width, entry / width), 0).xy);
    Hits own = fetch_escape(here);
    Hits right = hits_beside(here, ivec2(1, 0)), up = hits_beside(here, ivec2(0, 1)), corner = hits_beside(here, ivec2(1, 1));
    Slope x = slope_of(hits_beside(here, ivec2(-1, 0)), own, right), y = slope_of(hits_beside(here, ivec2(0, -1)), own, up);
    bool square = right.fate == ESCAPED && up.fate == ESCAPED && corner.fate == ESCAPED;
    vec3 mixed = square ? corner.direction - right.direction - up.direction + own.direction : vec3(0.0);
    Place middle = place_at(own.direction, x, y, mixed, vec2(0.0));

    vec2 energy = pixel_energies(pixel_direction(vec2(here) + 0.5));
    mat2 slopes = map_slopes(vec2(here) + 0.5), steps = inverse(slopes);
    vec4 shown = gram_of(slopes[0].x * middle.right + slopes[0].y * middle.up, slopes[1].x * middle.right + slopes[1].y * middle.up);
    Star first = Star(0, own.direction, 0.0), second = first;
    vec4 found;
    SkyStars stars = sky_stars(own.direction, finer.x * x.once, finer.y * y.once, min(finer.x, finer.y));
    int n = 0;
    do {
        vec3 light = sky_star(stars, n, energy.x, found);
        vec2 away = offset_of(found.xyz, middle);
        vec3 image = spread_of(shown, found.w);
        bool near = 4.0 * longest(image) > LONG * LONG ? reaches(steps * away, image) : all(lessThan(abs(away), vec2(NEAR)));
        Star star = Star(n, found.xyz, near ? dot(light, vec3(1.0)) : 0.0);
        bool brighter = star.power > first.power;
        if (brighter || star.power > second.power) second = brighter ? first : star;
        if (brighter) first = star;
        ++n;
    } while (n < stars.count);
    Star star = entry < firsts ? first : second;

    bool pieces = 4.0 * longest(spread_of(shown, found.w)) > LONG * LONG; // all stars are of one size
    vec2 offset = offset_of(star.direction, middle);
    bool mine = pieces && reaches(steps * offset, spread_of(shown, found.w));
    Place at = middle;
    if (!pieces) { // by Newton
        offset = vec2(0.0);
        for (int i = 0; i < 3; ++i) {
            offset = clamp(offset + offset_of(star.direction, at), -1.0, 1.0);
            at = place_at(own.direction, x, y, mixed, offset);
        }
        mine = all(lessThan(abs(offset), vec2(WITHIN)));
    }

    vec3 right_shown = slopes[0].x * at.right + slopes[0].y * at.up, up_shown = slopes[1].x * at.right + slopes[1].y * at.up;
    vec3 light = sky_beaming(energy) * sky_star(sky_stars_at(stars, at.direction, right_shown, up_shown, min(finer.x, finer.y)), star.n, energy.x, found);
    vec4 gram = gram_of(right_shown, up_shown);
    vec3 spread = spread_of(gram, found.w);
    float spread_det = max(spread.x * spread.z - spread.y * spread.y, 1.0);
    vec2 middle_at = vec2(here) + 0.5, star_at = middle_at + offset, point_at = pieces ? middle_at : star_at;
    place = shown_place(star_at);
    stretch = 0.25 * inverse_of(spread, spread_det);
    brightest = light * abs(texelFetch(radiance, here, 0).a) / (3.1415927 * sqrt(spread_det * gram.w));
#if POST_BLOOM
#if TURNED
    point_at = unrolled(point_at);
#endif
    vec2 at_glow = point_at / vec2(textureSize(radiance, 0));
    glowing = post_bloom_intensity * textureLod(glow, at_glow * glow_window.xy + glow_window.zw, 0.0).rgb;
#else
    glowing = vec3(0.0);
#endif
    bool drawn = x.known && y.known && mine && star.power > 0.0;
#if TURNED
    map_place = star_at / vec2(textureSize(radiance, 0));
    map_steps = vec4(slopes[0], slopes[1]) / vec4(textureSize(radiance, 0), textureSize(radiance, 0));
#endif
    gl_Position = drawn ? vec4(2.0 * shown_place(point_at) * shown_texel - 1.0, 0.0, 1.0) : vec4(2.0, 2.0, 2.0, 1.0);
    gl_PointSize = pieces ? max(length(steps[0]), length(steps[1])) + 1.0 : 4.0 * sqrt(max(spread.x, spread.z));
}
