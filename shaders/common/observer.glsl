// From a pixel to what its ray starts with. The matrix comes from the host's float64 tetrad (blackhole_gl/physics/observer.py).

// A ray at the camera, traced backwards, |E| = 1. Units M = 1; rates are per Mino time.
struct RayStart {
    float w;       // M/r
    float w_rate;
    vec3 n;        // unit vector from the hole to the camera
    vec3 n_rate;   // at right angles to n
    float lambda;  // L_z/E of the physical photon
    float energy;  // +1; −1 for light that only the ergosphere holds
    vec3 e_theta, e_phi;  // unit vectors there
    float sine;    // of the angle from the spin axis
};

// Where in the picture the fragment at `fragment` (gl_FragCoord.xy) lies, in pixels. A map of exact hits holds blocks of rays, each of one pixel, which may lie
// anywhere (blackhole_gl/rendering/ray_blocks.py); one program serves both those at edges and blocks of a single ray, side by side as the pixels are.
// Below 0 in blocks that are nobody's.
#if HIT_MAP_REFINED
const float block_side = 1.0;

vec2 picture_place(vec2 fragment) {
    return fragment;
}
#else
uniform sampler2D block_shifts;  // in pixels, from where each block lies in the map to where its pixel lies in the picture
uniform vec2 block_step;         // from block to block in its coordinates
uniform float block_side;        // rays along each axis of a pixel

vec2 picture_place(vec2 fragment) {
    vec2 place = fragment / block_side;
    return place + textureLod(block_shifts, block_step * place, 0.0).xy;
}
#endif

// How wide a pixel is at the hole, r_s. picture_scale is half a pixel's width at distance 1, or in M for a camera at infinity.
float pixel_at_hole() {
    return camera_w > 0.0 ? picture_scale / camera_w : picture_scale;
}

#if CAMERA_PROJECTION_PERSPECTIVE
// Where the pixel at `place` looks, in the frame of the view (back, down, right); (−1, −β, α) in M for a camera at infinity.
vec3 pixel_direction(vec2 place) {
    vec2 screen = (2.0 * (place + picture_offset) - picture_size) * picture_scale;
    vec3 local = vec3(-1.0, -screen.y, screen.x);
    return camera_w > 0.0 ? normalize(local) : local;
}
#else
// Pictures all round (blackhole_gl/physics/projection.py). picture_scale is half a pixel's angle; a cube's is 1 over the pixels of a face's side.

// (cos, sin) of so many right angles: no driver's own, as these decide what a ray hits. Within 1e-7.
vec2 cos_sin_quarters(float quarters) {
    float whole = floor(quarters + 0.5), x = (quarters - whole) * 1.5707963, x2 = x * x;
    float sine = x * (1.0 + x2 * (-1.0 / 6.0 + x2 * (1.0 / 120.0 + x2 * (-1.0 / 5040.0 + x2 / 362880.0))));
    float cosine = 1.0 + x2 * (-0.5 + x2 * (1.0 / 24.0 + x2 * (-1.0 / 720.0 + x2 * (1.0 / 40320.0 - x2 / 3628800.0))));
    float turn = whole - 4.0 * floor(0.25 * whole);
    vec2 found = turn == 0.0 || turn == 2.0 ? vec2(cosine, sine) : vec2(-sine, cosine);
    return turn < 2.0 ? found : -found;
}

// The same place where a part that is kept in a ring goes on beyond its end.
vec2 unrolled(vec2 place) {
    return place + picture_ring.zw * vec2(lessThan(place, picture_ring.xy));
}

// `place` from the middle of the picture, in right angles, or in sides of a cube's face.
vec2 from_middle(vec2 place) {
    vec2 pixels = (unrolled(place) + picture_offset) - 0.5 * picture_size;
#if CAMERA_PROJECTION_CUBE
    return pixels * picture_scale;
#else
    return pixels * (2.0 / 1.5707963 * picture_scale);
#endif
}

// Whether the projection shows `place`. What goes round is shown some pixels `beyond`, where tiles of a picture need it.
bool in_projection(vec2 place, float beyond) {
    vec2 at = abs(from_middle(place));
#if CAMERA_PROJECTION_CUBE
    return at.x < 3.0 && at.y < 0.5;
#elif CAMERA_PROJECTION_DOME
    return dot(at, at) < 1.0;
#else
    float more = beyond * 2.0 / 1.5707963 * picture_scale;
    return at.x < 2.0 + more && at.y < 1.0 + more;
#endif
}

vec3 pixel_direction(vec2 place) {
    vec2 at = from_middle(place);
#if CAMERA_PROJECTION_CUBE
    float across = at.x + 3.0, face = clamp(floor(across), 0.0, 5.0);
    float right = 2.0 * (across - face) - 1.0, up = 2.0 * at.y;
    vec3 local = face == 0.0 ? vec3(right, -up, 1.0) : face == 1.0 ? vec3(-right, -up, -1.0) : face == 2.0 ? vec3(up, -1.0, right) : face == 3.0 ? vec3(-up, 1.0, right)
        : face == 4.0 ? vec3(-1.0, -up, right) : vec3(1.0, -up, -right);
    return normalize(local);
#elif CAMERA_PROJECTION_DOME
    float away = length(at);
    vec2 angle = cos_sin_quarters(away);
    vec2 aside = away > 0.0 ? at * (angle.y / away) : vec2(0.0);
    return vec3(-angle.x, -aside.y, aside.x);
#else
    vec2 longitude = cos_sin_quarters(at.x), latitude = cos_sin_quarters(at.y);
    return vec3(-latitude.x * longitude.x, -latitude.y, latitude.x * longitude.y);
#endif
}
#endif

// E_observer/E_infinity of light that arrives from the local direction `local`, as it counts for colours (x) and for brightness (y): one number, unless the
// observer's motion is not to show in both, or not to shift directions. Next to none where the light has E ≤ 0: its λ and η, and with them all shifts, have no meaning.
vec2 pixel_energies(vec3 local) {
    float from_afar = observer_map[0].x + dot(vec3(observer_map[1].x, observer_map[2].x, observer_map[3].x), local);
    if (from_afar < 1e-6) from_afar = 1e6;
#if CAMERA_ABERRATION && CAMERA_DOPPLER_COLOUR && CAMERA_BEAMING
    return vec2(1.0 / from_afar);
#else
    return max(vec2(seen_colour.x + dot(seen_colour.yzw, local), seen_beaming.x + dot(seen_beaming.yzw, local)), 1e-6) / from_afar;
#endif
}

RayStart ray_start(vec3 local) {
    vec4 start = observer_map * vec4(1.0, local);
    vec3 rates = start.yzw / abs(start.x);
    RayStart ray;
    ray.w = camera_w;
    ray.w_rate = rates.x;
    ray.n = camera_n.xyz;
    ray.n_rate = rates.y * camera_e_theta.xyz + rates.z * camera_e_phi.xyz;
    ray.energy = start.x < 0.0 ? -1.0 : 1.0;
    ray.lambda = -ray.energy * rates.z * camera_n.w;
    ray.e_theta = camera_e_theta.xyz;
    ray.e_phi = camera_e_phi.xyz;
    ray.sine = camera_n.w;
    return ray;
}
