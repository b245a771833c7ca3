#version 330 core
// Samples along listed rays, and time → what a medium adds and takes on each stretch of a ray, by its pattern as it is now. A sample is what transfer.frag told of a piece (SAMPLES).
//
// Samples of one number lie side by side in the order of the list, those of longer rays first: below the first of the next number.
#defines
#blocks
#include "common/constants.glsl"
#include "common/observer.glsl"
#include "common/rotation.glsl"
#include "common/hits.glsl"
#include "common/matter.glsl"
#instances
#slots medium

uniform sampler2D places, gains, loses;
uniform int first_rows[MOST_SAMPLES + 1];  // of the samples of each number
uniform float footprint;                   // pixels

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

const float LEAST_PASSED = 1.0 / 512.0;

// What a piece adds and lets through, evenly filled.
Light piece_light(vec3 gain, vec3 depth) {
    vec3 share = mix((1.0 - exp(-depth)) / max(depth, vec3(1e-20)), 1.0 - depth * (0.5 - depth / 6.0), lessThan(depth, vec3(0.02)));
    return Light(share * gain, exp(-depth));
}

void main() {
#if ROWS_HELD
    read_rows();
#endif
    Light light[ORDERS + 1];
    for (int n = 0; n <= ORDERS; ++n) light[n] = Light(vec3(0.0), vec3(1.0));
    vec3 left = vec3(1.0);
    float wide = footprint * pixel_at_hole();
    ivec2 ray = ivec2(gl_FragCoord.xy);
    int number = 0;
    bool goes_on;
    do {
        ivec2 at = ivec2(ray.x, first_rows[number] + ray.y);
        bool there = at.y < first_rows[number + 1];
        vec4 place = texelFetch(places, at, 0);
        there = there && place.w >= 0.0;
        float pattern = 0.0;
#each medium : pattern = medium_$key_pattern(0, place.xyz, wide);
        pattern = there ? pattern : 0.0;
        Light piece = piece_light(pattern * texelFetch(gains, at, 0).rgb, pattern * texelFetch(loses, at, 0).rgb);
        for (int n = 0; n <= ORDERS; ++n)
            if (n == int(place.w)) light[n] = Light(light[n].gathered + light[n].passed * piece.gathered, light[n].passed * piece.passed);
        left *= piece.passed;
        ++number;
        goes_on = there && number < MOST_SAMPLES && any(greaterThan(left, vec3(LEAST_PASSED)));
    } while (goes_on);
    gathered0 = vec4(light[0].gathered, 1.0);
    dimmed0 = vec4(1.0 - light[0].passed, 1.0);
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
}
