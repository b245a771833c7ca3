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

// Where in the picture the fragment at `fragment` (gl_FragCoord.xy) lies, in pixels. RAYS_IN_BLOCKS: what is drawn are not pixels side by side but blocks of
// rays, each of one pixel (blackhole_gl/rendering/edges.py).
#if RAYS_IN_BLOCKS
uniform sampler2D block_pixels;  // each block's pixel
uniform float block_side;        // rays along each axis of a pixel

vec2 picture_place(vec2 fragment) {
    vec2 pixel = texelFetch(block_pixels, ivec2(fragment / block_side), 0).xy;
    return pixel + mod(fragment, block_side) / block_side;
}
#else
const float block_side = 1.0;

vec2 picture_place(vec2 fragment) {
    return fragment;
}
#endif

// Where the pixel at `place` looks, in the observer's frame (r, θ, φ); (−1, −β, α) in M for a camera at infinity.
vec3 pixel_direction(vec2 place) {
    vec2 screen = (2.0 * (place + picture_offset) - picture_size) * picture_scale;
    vec3 local = vec3(-1.0, -screen.y, screen.x);
    return camera_w > 0.0 ? normalize(local) : local;
}

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
