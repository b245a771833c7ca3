#version 330 core
// What media add and take on the rays of a coarse grid → the same for the pixels between them.
// LISTED: on the rays of a list → the same for their own pixels (blackhole_gl/rendering/ray_lists.py).
#defines
#blocks
#include "common/constants.glsl"

uniform sampler2D gathered0, dimmed0;  // of the grid, filtered linearly; of the list, the nearest
#if ORDERS > 0
uniform sampler2D gathered1, dimmed1;
#endif
#if ORDERS > 1
uniform sampler2D gathered2, dimmed2;
#endif
#if ORDERS > 2
uniform sampler2D gathered3, dimmed3;
#endif
#if LISTED
uniform sampler2D places;  // the number of the pixel's ray in the list; below 0 where it has none, and meets nothing
#else
uniform vec4 pixels_to_grid;  // factor and offset
#endif

layout(location = 0) out vec4 joined0;
layout(location = 1) out vec4 taken0;
#if ORDERS > 0
layout(location = 2) out vec4 joined1;
layout(location = 3) out vec4 taken1;
#endif
#if ORDERS > 1
layout(location = 4) out vec4 joined2;
layout(location = 5) out vec4 taken2;
#endif
#if ORDERS > 2
layout(location = 6) out vec4 joined3;
layout(location = 7) out vec4 taken3;
#endif

void main() {
#if LISTED
    vec2 size = vec2(textureSize(gathered0, 0));
    float number = texelFetch(places, ivec2(gl_FragCoord.xy), 0).r, row = floor((number + 0.5) / size.x), there = number < 0.0 ? 0.0 : 1.0;
    vec2 place = (vec2(number - row * size.x, row) + 0.5) / size;
#else
    const float there = 1.0;
    vec2 place = gl_FragCoord.xy * pixels_to_grid.xy + pixels_to_grid.zw;
#endif
    joined0 = there * textureLod(gathered0, place, 0.0);
    taken0 = there * textureLod(dimmed0, place, 0.0);
#if ORDERS > 0
    joined1 = there * textureLod(gathered1, place, 0.0);
    taken1 = there * textureLod(dimmed1, place, 0.0);
#endif
#if ORDERS > 1
    joined2 = there * textureLod(gathered2, place, 0.0);
    taken2 = there * textureLod(dimmed2, place, 0.0);
#endif
#if ORDERS > 2
    joined3 = there * textureLod(gathered3, place, 0.0);
    taken3 = there * textureLod(dimmed3, place, 0.0);
#endif
}
