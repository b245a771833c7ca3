#version 330 core
// Hit map and time → linear, scene-referred radiance (Rec. 709 primaries), alpha 1.
//
// The disk's crossings are composed front to back; whatever light passes them all sees the sky.
//
// Contract of a sky (shaders/skies/<key>.glsl):
//   vec3 sky_radiance(vec3 direction, vec3 right, vec3 up, float energy)
//     direction  unit vector in the world, the ray's asymptotic direction;
//     right, up  how it changes from this pixel to the next one to the right and above: the footprint. Its solid angle
//                |right × up| against that of the pixel is the inverse of the lens's magnification. Where the ray map is
//                torn (shadow's edge) a footprint of 0.3 rad is given: a sky answers that with its average. Any length
//                from 0 up may come; the answer must be finite;
//     energy     E_observer/E_infinity of the light (blue-shift of a low observer); black bodies look T·energy hot and
//                energy⁴ as bright;
//     answer     radiance, averaged over the footprint.
//
// Contract of a disk layer (shaders/disks/<key>.glsl):
//   DiskMatter disk_layer_<key>(DiskMatter matter)
//     changes matter.density, 1 on a smooth disk, keeping its mean near 1. Detail below matter.footprint must be faded out.
//     Motion: shear_phase = (age₀, age₁, weight₀, weight₁), shear_seed (blackhole_gl/shear.py): two patterns that are born,
//     sheared and replaced in turn, so that the shear never winds up.
#defines
#blocks
#include "common/constants.glsl"
#include "common/observer.glsl"
#include "common/hits.glsl"
#include "common/hit_map_read.glsl"
#include "common/colour.glsl"
// Asked for here, although the plug-ins ask too: a file is included once, and that once must not lie inside an #if.
#include "common/noise.glsl"
#include "common/disk_orbit.glsl"

out vec4 radiance;

const float BRIGHTEST = 6.0e4;        // what a half float holds
const float TORN_FOOTPRINT = 0.3;     // rad
const float EMISSION_UNIT = 1.0 / 0.18; // an emission_strength of 0.18 gives the hottest ring radiance 1 (g = 1)

// What a ray meets where it crosses the disk.
struct DiskMatter {
    float radius;    // r_s
    vec2 heading;    // (cos φ, sin φ)
    vec2 footprint;  // of the pixel, in ln r and in φ
    float density;   // 1 on a smooth disk
};

#if ORDERS > 0
#slots disk_layer

uniform sampler2D temperature_profile; // one row, T/T_peak at r = mix(disk_r_in, disk_r_out, t²)

struct Light {
    vec3 gathered;
    float passing;  // share of what lies behind that still comes through
};

float disk_temperature(float r) {
    float t = sqrt(clamp((r - disk_r_in) / (disk_r_out - disk_r_in), 0.0, 1.0));
    float entries = float(textureSize(temperature_profile, 0).x);
    return textureLod(temperature_profile, vec2((t * (entries - 1.0) + 0.5) / entries, 0.5), 0.0).r;
}

// Radiance of the smooth disk. Gravity's part of g acts on colour and brightness, unless "redshift" is off; the Doppler part
// on each by its own switch. The observer's own shift counts as gravity's.
vec3 disk_radiance(float r, float lambda, float energy) {
    vec2 shift = disk_shift(r, lambda);
    float gravity = DISK_REDSHIFT == 1 ? shift.x * energy : 1.0;
    float colour_shift = DISK_DOPPLER_COLOUR == 1 ? shift.y : 1.0;
    float power_shift = DISK_BEAMING == 1 ? shift.y : 1.0;
    float temperature = disk_temperature(r);
    float power = temperature * temperature;
    power *= power * pow(max(gravity * power_shift, 1e-6), disk_beaming_exponent);
    return blackbody_colour(disk_temperature_k * temperature * gravity * colour_shift) * (power * disk_emission_strength * EMISSION_UNIT);
}

// Changes of a crossing from this pixel to the next to the right (xy) and above (zw), made usable: where the neighbour has no
// such crossing the other direction's change stands in, or a small one.
vec4 usable_steps(vec2 point, vec4 steps, bvec2 whole) {
    vec2 spare = 0.02 * point;
    vec2 right = whole.x ? steps.xy : (whole.y ? steps.zw : spare);
    vec2 up = whole.y ? steps.zw : (whole.x ? steps.xy : spare);
    return vec4(right, up);
}

Light pass_disk(Light light, vec2 point, vec4 steps, float lambda, float energy) {
    float r = length(point);
    vec2 heading = point / max(r, 1e-6);
    vec2 radial = vec2(dot(steps.xy, heading), dot(steps.zw, heading));
    vec2 around = vec2(steps.y * heading.x - steps.x * heading.y, steps.w * heading.x - steps.z * heading.y);
    float width = clamp(length(radial), 1e-5 * r, 0.25 * (disk_r_out - disk_r_in) + 1e-5 * r);
    float cover = clamp((r - disk_r_in) / width + 0.5, 0.0, 1.0) * clamp((disk_r_out - r) / width + 0.5, 0.0, 1.0);
    if (cover <= 0.0)
        return light;

    DiskMatter matter = DiskMatter(r, heading, vec2(length(radial), length(around)) / r, 1.0);
#each disk_layer : matter = disk_layer_$key(matter);

    vec3 emission = disk_radiance(clamp(r, disk_r_in, disk_r_out), lambda, energy);
#if DISK_COMPOSITING_OPACITY
    // Optical depth grows with density; a density of 1 radiates the smooth disk's full radiance.
    float clear = max(1.0 - disk_opacity, 1e-3);
    float hidden = 1.0 - pow(clear, matter.density);
    light.gathered += light.passing * cover * hidden / (1.0 - min(clear, 0.999)) * emission;
    light.passing *= 1.0 - cover * hidden;
#else
    light.gathered += light.passing * cover * matter.density * emission;
#endif
    return light;
}

bool is_crossing(vec2 point) {
    return point != vec2(0.0);
}

// Differences to the neighbours; all pixels must run this, so it stands outside every branch.
vec4 steps_of(vec2 point) {
    return vec4(dFdx(point), dFdy(point));
}

bvec2 whole_steps(vec2 point) {
    float present = is_crossing(point) ? 1.0 : 0.0;
    return bvec2(dFdx(present) == 0.0, dFdy(present) == 0.0);
}
#endif

#if SKY_ENABLED
#slot sky

// The sky's footprint from the neighbours that escaped too; see the contract above.
vec3 sky_seen(vec3 direction, vec3 right, vec3 up, bvec2 whole, float energy) {
    vec3 torn = TORN_FOOTPRINT * cross(direction, abs(direction.z) < 0.9 ? vec3(0.0, 0.0, 1.0) : vec3(1.0, 0.0, 0.0));
    if (!whole.x) right = whole.y ? cross(up, direction) : torn;
    if (!whole.y) up = cross(direction, right);
    return sky_brightness * sky_radiance(direction, right, up, energy);
}
#endif

void main() {
    Hits hits = fetch_hits(ivec2(gl_FragCoord.xy));
    float energy = 1.0 / max(pixel_energy_ratio(pixel_direction(gl_FragCoord.xy)), 1e-6);
    vec3 gathered = vec3(0.0);
    float passing = 1.0;

#if ORDERS > 0
    vec4 steps[ORDERS];
    bvec2 whole[ORDERS];
    for (int n = 0; n < ORDERS; ++n) {
        steps[n] = steps_of(hits.crossing[n]);
        whole[n] = whole_steps(hits.crossing[n]);
    }
    Light light = Light(gathered, passing);
    for (int n = 0; n < ORDERS; ++n)
        if (is_crossing(hits.crossing[n]))
            light = pass_disk(light, hits.crossing[n], usable_steps(hits.crossing[n], steps[n], whole[n]), hits.lambda, energy);
    gathered = light.gathered;
    passing = light.passing;
#endif

#if SKY_ENABLED
    vec3 right = dFdx(hits.direction), up = dFdy(hits.direction);
    float escaped = hits.fate == ESCAPED ? 1.0 : 0.0;
    bvec2 whole_sky = bvec2(dFdx(escaped) == 0.0, dFdy(escaped) == 0.0);
    if (hits.fate == ESCAPED && passing > 0.0)
        gathered += passing * sky_seen(hits.direction, right, up, whole_sky, energy);
#endif

    radiance = vec4(clamp(gathered, 0.0, BRIGHTEST), 1.0);
}
