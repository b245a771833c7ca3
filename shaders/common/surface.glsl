// How a surface looks that has the parameters of blackhole_gl/scene/surfaces.py: what is painted on it, and its light. `Finish` holds the parameters of one instance.

#include "common/pictures.glsl"

// A place on a surface: its pattern repeats with u, 0…1 once around, and v goes 0…1 along; `right` and `up` are the changes of both to the next pixels. A picture's left
// side lies at u = left.
struct Painted {
    vec2 at, right, up;
    float left;
};

// Longitude and latitude at `arm` from the centre, in its own axes, and their changes: no angle is taken of a difference, so that there is no seam.
Painted globe_place(vec3 arm, vec3 right, vec3 up) {
    const float ROUND = 6.28318531;
    float beside2 = max(dot(arm.xy, arm.xy), 1e-12 * dot(arm, arm)), beside = sqrt(beside2), whole2 = beside2 + arm.z * arm.z;
    vec2 at = vec2(turns(arm.x, arm.y), 0.5 + 2.0 * turns(beside, arm.z));
    vec2 change = vec2(arm.x * right.y - arm.y * right.x, 0.0) / (ROUND * beside2);
    change.y = 2.0 * (beside * right.z - arm.z * dot(arm.xy, right.xy) / beside) / (ROUND * whole2);
    vec2 other = vec2(arm.x * up.y - arm.y * up.x, 0.0) / (ROUND * beside2);
    other.y = 2.0 * (beside * up.z - arm.z * dot(arm.xy, up.xy) / beside) / (ROUND * whole2);
    return Painted(at, change, other, -0.5);
}

// The mean of a square wave, +1 and −1 by turns from whole number to whole number, over `width` about x.
float square_wave(float x, float width) {
    vec2 ends = x + vec2(-0.5, 0.5) * width;
    vec2 sums = abs(fract(0.5 * ends) - 0.5);  // its integral is 1 − 2 of this
    return 2.0 * (sums.x - sums.y) / width;
}

vec3 painted_colour(Finish finish, Painted painted) {
#if INSTANCE_PICTURES
    if (finish.surface == SURFACE_IMAGE) {
        vec4 paint = picture_light(instance_pictures, finish.image, vec2(painted.at.x - painted.left, painted.at.y), painted.right, painted.up);
        return paint.rgb + (1.0 - paint.a) * finish.colour;
    }
#endif
    if (finish.surface != SURFACE_CHECKER) return finish.colour;
    vec2 squares = vec2(2 * ((finish.squares_around + 1) / 2), finish.squares_along);
    vec2 width = clamp((abs(painted.right) + abs(painted.up)) * squares, 1e-3, 1e3);
    float sign = square_wave(painted.at.x * squares.x, width.x) * square_wave(painted.at.y * squares.y, width.y);
    return mix(finish.other_colour, finish.colour, 0.5 + 0.5 * sign);
}

// Light of the lamps that a surface with the unit `normal` sends towards the camera (Blinn 1977).
vec3 lamp_light(Finish finish, vec3 colour, Sight sight, vec3 normal) {
    vec3 light = finish.ambient * colour;
    int i = 0;
    do {
        float row = (float(i) + 0.5) / float(lamp_count);
        vec4 lamp = textureLod(lamps_table, vec2(0.25, row), 0.0);  // the nearest: docs/llvmpipe.md, texels
        vec3 way = lamp.xyz - sight.place;
        float far = length(way);
        vec3 to_lamp = way / max(far, 1e-6);
        float facing = max(dot(normal, to_lamp), 0.0);
        float highlight = pow(max(dot(normal, normalize(to_lamp + sight.towards)), 1e-6), finish.shininess);
        float thinned = lamp.w > 0.0 ? lamp.w * lamp.w / max(far * far, 1e-6) : 1.0;
        vec3 sent = (1.0 - finish.ambient) * colour * facing + (facing > 0.0 ? finish.specular * highlight : 0.0);
        light += sent * thinned * textureLod(lamps_table, vec2(0.75, row), 0.0).rgb;
    } while (++i < lamp_count);  // there is one at least
    return light;
}

// Radiance of a surface of velocity dx/dt, seen by `sight`.
vec3 surface_radiance(Finish finish, Painted painted, Sight sight, vec3 normal, vec3 velocity) {
    float emitted = finish.frequency_shift ? emitted_shift(sight, velocity) : 1.0;
    float shift = finish.frequency_shift ? emitted * sight.energy : 1.0, seen = finish.frequency_shift ? emitted * sight.beaming : 1.0;
    float power = seen * seen;
    power *= power;
    if (finish.surface == SURFACE_BLACK_BODY) return blackbody_colour(finish.temperature_k * shift) * (finish.brightness * power);
    vec3 colour = painted_colour(finish, painted);
    return power * (finish.lighting == LIGHTING_GLOWING ? finish.brightness * colour : lamp_light(finish, colour, sight, normal));
}
