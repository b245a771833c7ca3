#version 330 core
// How far a pixel's hits lie from those of the most accurate method, in pixels.
#defines
#blocks
#include "common/constants.glsl"
// On the sky: the angle between the escape directions over the angle of a pixel (for an infinitely far camera, over what the next pixel
// changes). On the disk: the change of pixel that moves the crossing as far as the error does. The larger of the two.
#include "common/hits.glsl"
#include "common/hit_map_read.glsl"
#include "common/disk_edge.glsl"
#include "common/false_colour.glsl"

uniform sampler2D exact0;
#if ORDERS > 0
uniform sampler2D exact1;
#endif
#if ORDERS > 1
uniform sampler2D exact2;
#endif

Hits fetch_exact(ivec2 pixel) {
    vec4 t1 = vec4(0.0), t2 = vec4(0.0);
#if ORDERS > 0
    t1 = texelFetch(exact1, pixel, 0);
#endif
#if ORDERS > 1
    t2 = texelFetch(exact2, pixel, 0);
#endif
    return in_world(unpacked_hits(texelFetch(exact0, pixel, 0), t1, t2));
}

// `slip` in the plane as steps from pixel to pixel: slip = x·right + y·up. Where a picture is folded (`right` and `up` nearly along one
// line) the steps would have no bound.
float slip_in_pixels(vec2 slip, Crossing crossing) {
    vec2 right = crossing.right, up = crossing.up;
    float area = right.x * up.y - right.y * up.x;
    area = max(abs(area), 1e-3 * length(right) * length(up) + 1e-12);
    return length(vec2(slip.x * up.y - slip.y * up.x, right.x * slip.y - right.y * slip.x)) / area;
}

void main() {
    ivec2 pixel = ivec2(gl_FragCoord.xy);
    Hits hits = fetch_hits(pixel), exact = fetch_exact(pixel);
    bool other = hits.fate != exact.fate;
    bool compared = exact.fate == ESCAPED;
    float pixel_angle = max(camera_w > 0.0 ? 2.0 * picture_scale : length(fwidth(exact.direction)), 1e-9);
    float error = compared ? distance(hits.direction, exact.direction) / pixel_angle : 0.0;
#if ORDERS > 0
    for (int n = 0; n < ORDERS; ++n) {
        Crossing crossing = crossing_of(exact.crossing[n], exact.fate);
        bool shown = on_disk(hits.crossing[n]) || on_disk(exact.crossing[n]);
        bool both = hits.crossing[n] != vec2(0.0) && exact.crossing[n] != vec2(0.0);
        float slip = slip_in_pixels(hits.crossing[n] - exact.crossing[n], crossing);
        if (shown && both) {
            compared = true;
            error = max(error, slip);
        }
        other = other || shown && !both;
    }
#endif
    radiance = vec4(other ? view_legend[0] : compared ? false_colour(error) : view_legend[1], 1.0);
}
