/*---
label = "Jet (phenomenological)"
summary = "Two hollow cones of matter that streams out along the axis and round it: a shape, a speed and a brightness of one's choice, and no solution of any flow."
source = "own; on what shows of such a cone: Blandford & Königl 1979"
slot = "medium"
rank = 5
bolometric = false
changes = true
soft = true
phenomenological = true
reach = ["outer_radius"]
increasing = ["inner_radius", "outer_radius"]

[parameters]
inner_radius = { default = 1.5, range = [0.51, 100.0], unit = "r_s", help = "Radius at which it begins." }
outer_radius = { default = 30.0, range = [1.0, 1000.0], unit = "r_s", help = "Radius at which it has faded out." }
opening_deg = { default = 30.0, range = [1.0, 80.0], unit = "°", help = "Angle between axis and wall where it begins." }
thickness = { default = 0.15, range = [0.01, 1.0], unit = "×", help = "Width of the wall's Gaussian in the angle from the axis, of the angle to its middle; above a third it is hollow no more." }
collimation = { default = 0.0, range = [0.0, 1.0], help = "0: a cone; 1: a paraboloid, whose angle falls as 1/√r; between them a cone that becomes one." }
speed = { default = 0.6, range = [0.0, 0.99], unit = "c", help = "Of its matter, as a local observer without angular momentum sees it." }
pitch_deg = { default = 30.0, range = [-85.0, 85.0], unit = "°", help = "Angle between its way and the wall's own line: above 0 it turns counter-clockwise as seen from +z." }
falloff = { default = 1.5, range = [0.0, 6.0], help = "Emission and absorption go as r to the power −falloff." }
brightness = { default = 0.5, range = [0.0, 100.0], unit = "×", help = "Radiance that 1 r_s of the wall's middle adds where it begins, in its own frame." }
colour = { default = [0.45, 0.65, 1.0], length = [3, 3], element = { default = 1.0, range = [0.0, 1.0] }, help = "Of its light, linear red, green and blue." }
depth = { default = 0.0, range = [0.0, 100.0], unit = "1/r_s", help = "Optical depth of 1 r_s there, in its own frame." }
index = { default = 0.7, range = [-3.0, 3.0], help = "Light goes as the frequency to the power −index, so that what comes at us shines as the shift to the power 2 + index; absorption to the power −(2.5 + index)." }
knots = { default = 0.5, range = [0.0, 2.0], unit = "×", help = "How far knots and strands that stream with the matter swing about its mean; 0 is smooth." }
knot_length = { default = 4.0, range = [0.2, 100.0], unit = "r_s", help = "Length of a knot along the stream." }
strands = { default = 6, range = [1, 24], help = "How many knots lie side by side round the axis." }
---*/
#include "common/rotation.glsl"
#include "common/noise.glsl"
#include "common/zamo_velocity.glsl"

const float JET_EDGE = 3.0;  // of the Gaussian's widths, where its wall ends at 1/90

// Surfaces that matter streams along: s = sin(θ/2) falls as 1/√(spread), which is 1 where the jet begins.
float jet_spread(int i, float r) {
    return 1.0 + medium_jet_collimation(i) * (max(r / medium_jet_inner_radius(i), 1.0) - 1.0);
}

// s of a place, on either side alike.
float jet_half_sine(vec3 x, float r) {
    return sqrt(dot(x.xy, x.xy) / (2.0 * r * (r + abs(x.z))));
}

// s of the wall's middle where the jet begins.
float jet_opening(int i) {
    return cos_sin(0.5 * radians(medium_jet_opening_deg(i))).y;
}

// Within half of its radius a way d changes s by at most 1.05 d/2r, and that of a wall that bends inwards by at most 1.39 s d/2r.
float medium_jet_distance(int i, vec3 x) {
    float r = max(length(x), 1e-6), outermost = 1.0 + JET_EDGE * medium_jet_thickness(i);
    float opening = jet_opening(i), middle = opening * inversesqrt(jet_spread(i, r));
    float off = abs(jet_half_sine(x, r) - middle) - (outermost - 1.0) * middle;
    float steepness = 1.05 + (medium_jet_collimation(i) > 0.0 ? 1.39 * opening * outermost : 0.0);
    float beside = r * clamp(2.0 * off / steepness, -0.5, 0.5);
    return max(beside, max(medium_jet_inner_radius(i) - r, r - medium_jet_outer_radius(i)));
}

// A Gaussian summed in steps of three quarters of its width is right to 1e-9; the length on which its light falls off; half a knot.
float medium_jet_scale(int i, vec3 x) {
    float r = max(length(x), medium_jet_inner_radius(i)), across = 2.0 * r * jet_opening(i) * inversesqrt(jet_spread(i, r));
    float smooth_scale = min(3.0 * across * medium_jet_thickness(i), r / max(medium_jet_falloff(i), 1.0));
    float knot = min(0.5 * medium_jet_knot_length(i), 3.0 * across / float(medium_jet_strands(i)));
    return medium_jet_knots(i) > 0.0 ? min(smooth_scale, knot) : smooth_scale;
}

// dx/dt as a ZAMO sees it: along the surfaces of constant s² spread, and round the axis.
vec3 jet_beta(int i, vec3 x, float r) {
    float s = jet_half_sine(x, r), spread = jet_spread(i, r);
    float bend = (spread - 1.0 + medium_jet_collimation(i)) / spread * s * inversesqrt(max(1.0 - s * s, 1e-6));  // −r dθ/dr
    vec3 out_from_axis = length(x.xy) > 0.0 ? vec3(normalize(x.xy), 0.0) : vec3(0.0), n = x / r;
    vec3 towards_axis = vec3(0.0, 0.0, x.z < 0.0 ? -1.0 : 1.0) * length(n.xy) - out_from_axis * abs(n.z);
    vec2 pitch = cos_sin(radians(medium_jet_pitch_deg(i)));
    return medium_jet_speed(i) * (pitch.x * normalize(n + bend * towards_axis) + pitch.y * vec3(-out_from_axis.y, out_from_axis.x, 0.0));
}

// Mean 1. Matter in the middle of a narrow wall stays where the azimuth less its winding is the same, and goes outwards at speed · cos(pitch); the two patterns of
// `shear_phase` take turns, so that a knot never goes farther than it lives.
float jet_knots(int i, vec3 x, float r, float inner_share) {
    float widened = sqrt(jet_spread(i, r)), narrow = sqrt(1.0 - medium_jet_collimation(i)), onward = (1.0 + narrow) / (widened + narrow);
    vec2 pitch = cos_sin(radians(medium_jet_pitch_deg(i)));
    float winding = 2.0 * (widened - 1.0) + narrow * log(max(r / medium_jet_inner_radius(i), 1.0) * onward * onward);
    float turn = fract(turns(x.x, x.y) - winding * pitch.y / (pitch.x * 12.5663706 * jet_opening(i)));
    vec2 way = (vec2(r) - medium_jet_speed(i) * pitch.x * shear_phase.xy) / medium_jet_knot_length(i);
    uvec2 seeds = 2u * uvec2(shear_seed.xy) + (x.z < 0.0 ? 1u : 0u);
    float strands = float(medium_jet_strands(i));
    vec2 swings = 4.0 * vec2(ring_noise(turn, strands, way.x, seeds.x), ring_noise(turn, strands, way.y, seeds.y));
    vec2 weights = shear_phase.zw * inversesqrt(dot(shear_phase.zw, shear_phase.zw));  // two patterns mixed: the contrast of one
    return max(1.0 + medium_jet_knots(i) * inner_share * dot(weights, swings), 0.0);
}

// s of a place over that of the wall's middle.
float jet_share(int i, vec3 x, float r) {
    return jet_half_sine(x, r) * sqrt(jet_spread(i, r)) / jet_opening(i);
}

// Of knots and strands, mean 1.
float medium_jet_pattern(int i, vec3 x, float footprint) {
    float r = max(length(x), 1e-6), pattern = 1.0;
    if (medium_jet_knots(i) > 0.0) pattern = jet_knots(i, x, r, min(jet_share(i, x, r), 1.0));  // on the axis all azimuths meet
    return pattern;
}

Matter medium_jet_matter(int i, Sight sight) {
    vec3 x = sight.place;
    float r = max(length(x), 1e-6), inner = medium_jet_inner_radius(i), outer = medium_jet_outer_radius(i);
    float beside = (jet_share(i, x, r) - 1.0) / medium_jet_thickness(i);
    float ends = smoothstep(inner, 1.5 * inner, r) * (1.0 - smoothstep(0.5 * outer, outer, r));
    float density = ends * exp(-0.5 * beside * beside) * pow(inner / max(r, inner), medium_jet_falloff(i));
    float shift = emitted_shift(sight, zamo_velocity(x, jet_beta(i, x, r)));
    float frequency = 1.0 / max(shift * sight.energy, 1e-6), light = density * pow(frequency, -medium_jet_index(i));
    return Matter(medium_jet_brightness(i) * light * medium_jet_colour(i), vec3(medium_jet_depth(i) * light * pow(frequency, -2.5)), shift);
}
