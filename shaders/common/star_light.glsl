// Stars in the footprint of a ray.
//
// A star of flux F has radiance F·K/A: A the solid angle of sky in the footprint, K a kernel of integral 1 over it. So its
// light, summed over pixels, is F times the lens's magnification, wherever the star falls between the pixels.
// The kernel is the sky's own, sky_kernel, of the square of the distance in half kernels; its integral over the disc of radius 2 is π.

#include "common/colour.glsl"

const float HAZE_KELVIN = 6200.0;

// A footprint on the sky, and in it stars of `size` (rad), in the plane that touches the sphere at `centre`, as the axes in which it is a circle of radius 1.
struct SkySpot {
    vec3 centre;
    vec3 across, along;
    float kernel;     // 1/(π √det C), per sr
    float reach2;     // square of the longest half-axis, rad²
};

SkySpot sky_spot(vec3 centre, vec3 right, vec3 up, float size) {
    SkySpot spot;
    spot.centre = centre;
    // Two unit vectors at right angles to it and to each other, without a root (Duff et al. 2017).
    float side = centre.z < 0.0 ? -1.0 : 1.0;
    float k = -1.0 / (side + centre.z);
    float m = centre.x * centre.y * k;
    vec3 e1 = vec3(1.0 + side * centre.x * centre.x * k, side * m, -side * centre.x);
    vec3 e2 = vec3(m, side + centre.y * centre.y * k, -centre.y);
    vec2 a = vec2(dot(right, e1), dot(right, e2));
    vec2 b = vec2(dot(up, e1), dot(up, e2));
    float least = max(size * size, 1e-13); // float32 directions resolve no less
    vec3 c = vec3(a.x * a.x + b.x * b.x + least, a.x * a.y + b.x * b.y, a.y * a.y + b.y * b.y + least);
    // det C = (a × b)² + least·(|a|² + |b|²) + least²: no difference of large numbers
    float cross_ab = a.x * b.y - a.y * b.x;
    float det = cross_ab * cross_ab + least * (dot(a, a) + dot(b, b)) + least * least;
    // Half of a root of C⁻¹: where |(across, along)·d| is 1 the star's kernel ends.
    float root_c = sqrt(c.x), root_det = sqrt(det);
    float shared_inverse = 1.0 / (root_c * root_det);
    spot.across = (0.5 * shared_inverse * root_det) * e1;
    spot.along = (0.5 * shared_inverse) * (c.x * e2 - c.y * e1);
    spot.kernel = shared_inverse * root_c * (1.0 / 3.1415927);
    float half_trace = 0.5 * (c.x + c.z);
    spot.reach2 = half_trace + sqrt(max(half_trace * half_trace - det, 0.0));
    return spot;
}

// How far from a pixel's middle a star counts as near, in half kernels, where pixels are shown `finer`.
float star_room(SkySpot spot, float finer, float size) {
    float room = 0.362 / finer; // a little beyond the pixel's corners, 0.71 of its sides away; a half kernel is two sides of a finer one
    // An image as long as star_layer.vert draws by pieces: the footprint's short half-axis is little more than a star's radius.
    float short2 = 1.0 / max(9.8696044 * spot.kernel * spot.kernel * spot.reach2, 1e-20);
    return short2 < (16.0 / 15.0) * max(size * size, 1e-13) ? room + 1.0 : room;
}

// Light of stars, kept as numbers and their temperature: colour is looked up once, at the end.
struct StarLight {
    float flux;  // of single stars, in kernels
    float heat;  // the same, times K
    float haze;  // of the stars too dense to be seen singly, where the richness is 1, per sr
    float near;  // number of single stars within `room`
};

float star_kelvin(float flux) {
    return 32.0 * float(floatBitsToInt(flux) & 1023);
}

// Radiance of stars of which flux 1 is a radiance × sr of 1.
vec3 star_radiance(StarLight stars, float kernel, float energy) {
    float power = stars.flux * kernel + stars.haze;
    vec3 colour = blackbody_colour((stars.heat * kernel + stars.haze * HAZE_KELVIN) / max(power, 1e-20) * energy);
    return colour * power;
}
