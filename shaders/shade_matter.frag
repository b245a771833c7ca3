#version 330 core
// Hit map and time → the disk's linear, scene-referred radiance (Rec. 709 primaries) and, as alpha, the share of light from
// behind that still comes through. Runs only where shade_classes.frag found disk; the sky is added behind it by blending.
//
// Contract of a disk layer (shaders/disks/<key>.glsl):
//   DiskMatter disk_layer_<key>(DiskMatter matter)
//     changes matter.density, 1 on a smooth disk, keeping its mean near 1, or matter.gain, by which the light alone is multiplied. Detail below
//     matter.footprint must be faded out. With its strength at 0 a layer leaves both as they are, bit for bit.
//     Motion: shear_phase = (age₀, age₁, weight₀, weight₁) and shear_seed (blackhole_gl/physics/shear.py): two patterns that are
//     born, sheared and replaced in turn, so that the shear never winds up.
//     Loops that run a known number of times are best written do … while (docs/llvmpipe.md).
#defines
#blocks
#include "common/constants.glsl"
#include "common/observer.glsl"
#include "common/hits.glsl"
#include "common/hit_map_read.glsl"
#include "common/colour.glsl"
#include "common/disk_edge.glsl"
#include "common/orders_shown.glsl"
#include "common/disk_matter.glsl"
#include "common/disk_orbit.glsl"
#include "common/disk_temperature.glsl"

// STRETCHES: media are told by what stretches of the ray add, of hits that know of none.
#if STRETCHES || MEETINGS && MEDIA && !THINGS
#define BY_STRETCHES 1
#else
#define BY_STRETCHES 0
#endif
#if STRETCHES || MEETINGS
#define IN_ORDER 1
#else
#define IN_ORDER 0
#endif

#if IN_ORDER
layout(location = 0, index = 0) out vec4 radiance;
layout(location = 0, index = 1) out vec4 passed;  // of what lies behind, per colour
#else
out vec4 radiance;
#endif

#include "common/matter.glsl"
#include "common/look_back.glsl"
#if MEETINGS
#instances
#slots thing
#endif

#if SKY_BEHIND
uniform sampler2D sky_behind;  // what lies behind, where that is not blended
#endif

const float BRIGHTEST = 6.0e4;          // what a half float holds
const float EMISSION_UNIT = 1.0 / 0.18; // an emission_strength of 0.18 gives the hottest ring radiance 1 (at g = 1)

#slots disk_layer

// Brightness of light that leaves the matter at its angle to the plane's normal, over its mean; `g` is the whole frequency shift from there to infinity.
float limb_factor(float r, DiskLight light, float g) {
#if DISK_LIMB_DARKENING_NONE
    return 1.0;
#else
    float cosine = min(sqrt(max(light.eta, 0.0)) * g * 0.5 / r, 1.0);  // k_θ over r in M, and over the light's energy there
#if DISK_LIMB_DARKENING_GREY
    return 0.5 + 0.75 * cosine;
#else
    return (1.0 + 2.06 * cosine) * (3.0 / 7.12);
#endif
#endif
}

// Radiance of the smooth disk. Gravity's part of g acts on colour and brightness, unless "redshift" is off; the Doppler part
// on each by its own switch (common/disk_orbit.glsl says how g is split). The observer's own shift counts as gravity's.
vec3 disk_radiance(float r, DiskLight light, bool inbound) {
    vec2 shift = disk_shift(r, light, inbound);
    vec2 colour_shift = disk_colour_shift(shift, light.energy.x), power_shift = disk_power_shift(shift, light.energy.y);
    float temperature = disk_temperature(r);
    float power = temperature * temperature;
    power *= power * pow(max(power_shift.x * power_shift.y, 1e-6), disk_beaming_exponent);
    float brightness = power * disk_emission_strength * EMISSION_UNIT * limb_factor(r, light, shift.x * shift.y);
#if DISK_COLOUR_WHITE
    return vec3(brightness);
#else
    return blackbody_colour(disk_temperature_k * temperature * colour_shift.x * colour_shift.y) * brightness;
#endif
}

// Density → (brightness, share hidden of what lies behind), both for a piece of disk that covers the whole pixel.
vec2 disk_appearance(float density) {
#if DISK_COMPOSITING_OPACITY
    // Optical depth is proportional to density. The source grows with its root, else dense filaments would saturate.
    float hidden = 1.0 - exp2(density * disk_veil.x);
    return vec2(sqrt(density) * hidden * disk_veil.y, hidden);
#else
    return vec2(density, 0.0);
#endif
}

// The light gathered so far and what still comes through, after one more crossing.
Light pass_disk(Light light, Crossing crossing, DiskLight sent, bool inbound) {
    float r = max(length(crossing.point), 1e-6);
    vec2 heading = crossing.point / r;
    vec2 across = vec2(-heading.y, heading.x);
    vec2 radial = vec2(dot(crossing.right, heading), dot(crossing.up, heading));
    vec2 around = vec2(dot(crossing.right, across), dot(crossing.up, across));
    float emitted_at = clamp(r, disk_r_edge, disk_r_out);
    vec2 footprint = vec2(length(radial), length(around)) * (block_side / r);
    DiskMatter matter = DiskMatter(r, heading, footprint, disk_approach(emitted_at, sent.lambda), disk_shift(emitted_at, sent, inbound).y, 1.0, 1.0);
#each disk_layer : matter = disk_layer_$key(matter);

    vec2 look = disk_appearance(matter.density) * disk_cover(crossing);
    vec3 emission = disk_radiance(emitted_at, sent, inbound) * matter.gain;
    return Light(light.gathered + light.passed * look.x * emission, light.passed * (1.0 - look.y));
}

// The same, in the colour of the crossing's order if orders are tinted.
Light pass_order(Light light, Hits hits, Crossing crossing, int n, DiskLight sent) {
#if RAYS_LIGHT_TRAVEL
    look_back(hits.delay[n]);
#endif
    Light after = pass_disk(light, crossing, light_at_crossing(sent, crossing.point, is_inbound(hits, n)), is_inbound(hits, n));
#if DISK_ORDERS_SHOWN_TINTED
    const vec3 WEIGHTS = vec3(0.2126, 0.7152, 0.0722);
    after.gathered = light.gathered + dot(after.gathered - light.gathered, WEIGHTS) * order_tint(hits, crossing.point);
#endif
    return after;
}

#if BY_STRETCHES || MEETINGS && MEDIA
#include "common/stretches.glsl"
#endif

#if MEETINGS
// What the thing that is meeting k adds, and what it lets through of what lies behind it.
Light meeting_light(Hits hits, int k, Sight sight) {
    Light own = Light(vec3(0.0), vec3(1.0));
    Meeting met = hits.meeting[k];
#if RAYS_LIGHT_TRAVEL
    look_back(met.delay);
#endif
#each thing : if (met.kind == THING_$KEY) own = thing_$key_light(met.index, sight);
    return own;
}

#if MEDIA && THINGS
// The light after the things and media before which `first` to `last` crossings of the disk's plane come; `own`, that of each thing. Where a thing lets light through
// within a medium, all of the stretch of the medium counts as before it.
Light pass_meetings(Light light, Hits hits, Light own[MEETINGS], int first, int last) {
    for (int before = first; before <= min(last, ORDERS); ++before) {
        Light stretch = stretch_light(ivec2(gl_FragCoord.xy), before);
        bool within = false;  // a medium, from the last crossing on
        for (int k = 0; k < MEETINGS; ++k) within = within || is_medium(hits.meeting[k].kind) && hits.meeting[k].before < before;
        if (within) light = behind(light, stretch);
        for (int k = 0; k < MEETINGS; ++k) {
            Meeting met = hits.meeting[k];
            if (met.kind >= 0 && met.before == before) light = behind(light, is_medium(met.kind) ? stretch : own[k]);
        }
    }
    return light;
}
#elif !MEDIA
// The light after the meetings before which `first` to `last` crossings of the disk's plane come; `own`, that of each.
Light pass_meetings(Light light, Hits hits, Light own[MEETINGS], int first, int last) {
    for (int k = 0; k < MEETINGS; ++k) {
        Meeting met = hits.meeting[k];
        bool here = met.kind >= 0 && met.before >= first && met.before <= last;
        light.gathered += here ? light.passed * own[k].gathered : vec3(0.0);
        light.passed *= here ? own[k].passed : vec3(1.0);
    }
    return light;
}
#endif
#endif

#if BY_STRETCHES
// The light after the media before which `first` to `last` crossings of the disk's plane come.
Light pass_media(Light light, int first, int last) {
    for (int before = first; before <= min(last, ORDERS); ++before) light = behind(light, stretch_light(ivec2(gl_FragCoord.xy), before));
    return light;
}
#endif

void main() {
    Hits hits = shown_orders(fetch_hits(ivec2(gl_FragCoord.xy)));
    DiskLight sent = disk_light(hits.lambda, pixel_direction(picture_place(gl_FragCoord.xy)));

    // The crossings that may count come first, in order. Without things at least one does in every pixel that gets here.
    Crossing first = crossing_of(hits.crossing[0], hits.fate), second = crossing_of(hits.crossing[1], hits.fate);
    Crossing third = crossing_of(hits.crossing[2], hits.fate);
    bool counts = may_be_covered(first), more = may_be_covered(second), last = may_be_covered(third);
    ivec3 order = ivec3(0, 1, 2);
    if (!more) { second = third; order.yz = order.zy; more = last; last = false; }
    if (!counts) { first = second; second = third; order = order.yzx; counts = more; more = last; last = false; }

    Light light = Light(vec3(0.0), vec3(1.0));
#if IN_ORDER
    int gone = 0;  // crossings
#endif
#if MEETINGS && !BY_STRETCHES
    Light own[MEETINGS];
    for (int k = 0; k < MEETINGS; ++k) own[k] = meeting_light(hits, k, sight_of(hits.meeting[k], sent.energy));
#define PASS_BEFORE(light, first, last) pass_meetings(light, hits, own, first, last)
#elif BY_STRETCHES
#define PASS_BEFORE(light, first, last) pass_media(light, first, last)
#endif
#if !IN_ORDER || ORDERS > 0
    bool left;
    do {
#if IN_ORDER
        int upto = counts ? order.x : -1;
        light = PASS_BEFORE(light, gone, upto);
        gone = max(gone, upto + 1);
        Light after = pass_order(light, hits, first, order.x, sent);
        if (counts) light = after;
        counts = more;
#else
        light = pass_order(light, hits, first, order.x, sent);
#endif
        left = more;
        first = second;
        second = third;
        order = order.yzx;
        more = last;
        last = false;
    } while (left);
#endif
#if IN_ORDER
    light = PASS_BEFORE(light, gone, 3);
    passed = vec4(light.passed, 1.0);
#endif
#if SKY_BEHIND
    vec4 sky = texel_of(sky_behind, ivec2(gl_FragCoord.xy));
    radiance = vec4(clamp(light.gathered + light.passed * sky.rgb, 0.0, BRIGHTEST), light.passed.x * sky.a);
#else
    radiance = vec4(clamp(light.gathered, 0.0, BRIGHTEST), light.passed.x);
#endif
}
