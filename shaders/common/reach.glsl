// Whether coarse rays, side by side, come so near to balls in space that one between them may meet it.
//
// Neighbours take steps of like length, so after as many steps they are about as far on their ways, and what is between them across the way is how far apart
// they are there: the margin by which a ray may miss a ball. It is a difference between the fragments of a quad, so all rays take all steps, those too that
// have ended. Rays end where they leave the shell between reach_radii, in which all balls lie: there neighbours end alike, whatever step it is in.
//
// A ball that a thing fills hides what lies behind it, once a ray is deeper in it than the margin: the rays beside it are in it, too.
#include "common/reach_node.glsl"

// A column each: centre in r_s, in the plan's frame, and radius, negative where a thing fills it; 1 + kind + 32·index of that thing, else 0.
uniform sampler2D reach_balls;
uniform int reach_count;
uniform vec2 reach_radii;      // r_s from the hole: nothing is met nearer than the first, or farther than the second

// How far a cubic may be from the way, of the piece's length, by the sum of the slopes at its ends: where it bends much, as far as the cubic bows.
float roughness(float slopes) {
    return 0.15 * slopes * min(0.25 * slopes, 1.0);
}

// Where a ray is, in r_s, and how fast it moves, by any parameter.
struct Spot {
    vec3 x, rate;
};

Spot spot_of(Path path) {
    return Spot(path_point(path), path_velocity(path));
}

vec3 across(vec3 d, vec3 along) {
    return d - dot(d, along) * along;
}

// How far the rays nearest to this one of four are from it at a spot, across the way: those in the middle between the four are the farthest, half a diagonal away,
// and a tenth is for what is not linear. To be called by all of a quad.
float reach_margin(Spot spot) {
    vec3 along = normalize(spot.rate), right = dFdx(spot.x), up = dFdy(spot.x);
    return 0.55 * max(length(across(right + up, along)), length(across(right - up, along)));
}

// Slope of a way against its chord, along the unit vector `along`.
vec3 slope_against(vec3 velocity, vec3 along) {
    float onward = dot(velocity, along);
    return (velocity - onward * along) / max(onward, 0.2 * length(velocity));
}

// The balls to which the way from a to b comes as near as the margin, which is margin.x where it begins and margin.y where it ends. It bows from its chord by a
// cubic, which rates by any parameter tell.
Reached balls_near(Spot a, Spot b, vec2 margin) {
    vec3 chord = b.x - a.x;
    float size = max(length(chord), 1e-20);
    vec3 along = chord / size, before = slope_against(a.rate, along), after = slope_against(b.rate, along);
    float rough = size * roughness(length(before) + length(after));
    Reached found = NONE_REACHED;
    for (int i = 0; i < reach_count; ++i) {
        vec4 ball = texelFetch(reach_balls, ivec2(i, 0), 0);
        float radius = abs(ball.w);
        vec3 arm = ball.xyz - a.x;
        float u = clamp(dot(arm, along) / size, 0.0, 1.0);
        vec3 away = arm - size * u * (along + (1.0 - u) * ((1.0 - u) * before - u * after));
        float room = rough + mix(margin.x, margin.y, min(u + radius / size, 1.0)), far = length(away);
        found.near |= far <= radius + room ? 1u << i : 0u;
        found.hidden = far + room < -ball.w ? uint(i + 1) : found.hidden;
    }
    return found;
}
