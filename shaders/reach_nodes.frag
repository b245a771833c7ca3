#version 330 core
// Rays at every REACH_STEP-th pixel → what becomes of them, and whether they come near any of the balls that things lie in (common/reach.glsl): for
// reach_cells.frag. They end on no thing and look for no crossing; those that take more than reach_steps are given up.
#defines
#blocks
#include "common/constants.glsl"
#include "common/observer.glsl"
#include "common/rotation.glsl"
#include "common/hermite.glsl"
#include "common/hits.glsl"
#include "common/curve.glsl"
#slot ray_model
#slot integrator
#slot step_control
#include "common/march.glsl"
#include "common/reach.glsl"

uniform int reach_steps;

out float node; // fate, and half of one where it comes near

const int PIECES = 4; // of a step that is no cubic in space: it is one before the twist and before the division by w

bool is_outward(Path path) {
    return dot(path.place.xyz, path.rate.xyz) * path.place.w > dot(path.place.xyz, path.place.xyz) * path.rate.w;
}

vec3 place_on(Curve curve, float t, out vec3 velocity) {
    vec4 rate, place = curve_place(curve, t, rate);
    vec3 x = place.xyz / place.w;
    velocity = (rate.xyz - x * rate.w) / place.w;
    return x;
}

// The part of the step at which the ray is as far from the hole as `radius`, with the place and the velocity there.
float part_at(Curve curve, float radius, out vec3 x, out vec3 velocity) {
    float before = beyond(curve.a.place, radius), after = beyond(curve.b.place, radius);
    bool passes = before * after < 0.0;
    float t = passes ? before / (before - after) : curve.b.place.w > 0.0 ? 1.0 : 0.5 * curve.a.place.w / (curve.a.place.w - curve.b.place.w);
    x = place_on(curve, t, velocity);
    float r = length(x), slip = passes ? clamp(r * r * (1.0 - r / radius) / dot(x, velocity), -0.2, 0.2) : 0.0;
    x += slip * velocity;
    if (passes) x *= radius / length(x);
    return t + slip;
}

void main() {
    vec2 pixel = float(REACH_STEP) * (gl_FragCoord.xy - 0.5) + 0.5;
    RayStart start = ray_start(pixel_direction(picture_place(pixel)));
    Orbit orbit = ray_orbit(start);
    Hits hits = no_hits(start.lambda);
    March m = march_start(orbit, ray_init(start, orbit, hits));
    Path path = ray_path(orbit, m.s);
    vec3 velocity, x = place_on(Curve(path, path, 1.0), 0.0, velocity);
    float margin = reach_margin(x, velocity);
    int fate = UNRESOLVED;
    bool near = false;
    for (int k = 0; k < reach_steps; ++k) {
        march_once(orbit, m);
        Curve curve = Curve(path, ray_path(orbit, m.next), m.h);
        path = curve.b;
        bool leaves = beyond(path.place, reach_radii.y) > 0.0 && is_outward(path), falls = path.place.w > 0.0 && beyond(path.place, reach_radii.x) < 0.0;
        vec3 to, to_velocity;
        float part = part_at(curve, falls ? reach_radii.x : leaves ? reach_radii.y : 1e30, to, to_velocity);
        bool under_way = fate == UNRESOLVED;
        Piece piece = Piece(x, to, velocity, to_velocity);
        if (under_way) {
            x = to;
            velocity = to_velocity;
        }
        vec2 margins = vec2(margin, reach_margin(x, velocity));
        margin = margins.y;
        bool bent = abs(curve.b.twist.x - curve.a.twist.x) > 0.5 || max(dot(x, x), dot(piece.from, piece.from)) > 16.0 * min(dot(x, x), dot(piece.from, piece.from));
        int pieces = bent && under_way ? PIECES : 1, done = 0;
        do {
            float until = float(done + 1) / float(pieces);
            if (done + 1 < pieces) piece.to = place_on(curve, until * part, piece.to_velocity); else { piece.to = to; piece.to_velocity = to_velocity; }
            near = near || under_way && comes_near(piece, vec2(mix(margins.x, margins.y, float(done) / float(pieces)), mix(margins.x, margins.y, until)));
            piece.from = piece.to;
            piece.from_velocity = piece.to_velocity;
        } while (++done < pieces);
        fate = under_way ? (leaves ? ESCAPED : falls ? CAPTURED : UNRESOLVED) : fate;
    }
    node = float(fate) + (near ? 0.5 : 0.0);
}
