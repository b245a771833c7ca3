#version 330 core
// What media add and let through on the rays of a coarse grid → the same for the pixels between them.
#defines
#blocks
#include "common/constants.glsl"

uniform sampler2D gathered0, passed0;  // of the grid, filtered linearly
#if ORDERS > 0
uniform sampler2D gathered1, passed1;
#endif
#if ORDERS > 1
uniform sampler2D gathered2, passed2;
#endif
#if ORDERS > 2
uniform sampler2D gathered3, passed3;
#endif
uniform vec4 pixels_to_grid;  // factor and offset

layout(location = 0) out vec4 joined0;
layout(location = 1) out vec4 through0;
#if ORDERS > 0
layout(location = 2) out vec4 joined1;
layout(location = 3) out vec4 through1;
#endif
#if ORDERS > 1
layout(location = 4) out vec4 joined2;
layout(location = 5) out vec4 through2;
#endif
#if ORDERS > 2
layout(location = 6) out vec4 joined3;
layout(location = 7) out vec4 through3;
#endif

void main() {
    vec2 place = gl_FragCoord.xy * pixels_to_grid.xy + pixels_to_grid.zw;
    joined0 = textureLod(gathered0, place, 0.0);
    through0 = textureLod(passed0, place, 0.0);
#if ORDERS > 0
    joined1 = textureLod(gathered1, place, 0.0);
    through1 = textureLod(passed1, place, 0.0);
#endif
#if ORDERS > 1
    joined2 = textureLod(gathered2, place, 0.0);
    through2 = textureLod(passed2, place, 0.0);
#endif
#if ORDERS > 2
    joined3 = textureLod(gathered3, place, 0.0);
    through3 = textureLod(passed3, place, 0.0);
#endif
}
