/*---
label = "Torus"
summary = "A Polish doughnut: a thick torus of constant angular momentum, held up by its pressure, in closed form for any spin."
source = "Abramowicz, Jaroszynski & Sikora 1978; Font & Daigne 2002"
slot = "medium"
rank = 3
soft = true
reach = ["radius"]
increasing = ["inner_radius", "peak_radius", "radius"]

[parameters]
inner_radius = { default = 3.5, range = [0.5, 1000.0], unit = "r_s", help = "Its inner edge in the equatorial plane. Below its cusp, matter begins outside of that." }
peak_radius = { default = 5.0, range = [0.5, 1000.0], unit = "r_s", help = "Where its pressure is highest: there it turns as a circular orbit does. Above the innermost stable one." }
radius = { default = 25.0, range = [1.0, 2000.0], unit = "r_s", help = "There is none beyond, also where the torus would go on." }
orbit = { default = "prograde", options = ["prograde", "retrograde"], help = "Which way it turns, with the hole or against it." }
gamma = { default = 1.3333333, range = [1.1, 3.0], help = "Adiabatic index of its gas: the higher, the steeper its surface." }
depth = { default = 1.0, range = [0.0, 100.0], unit = "1/r_s", help = "Optical depth of 1 r_s where it is densest, in its own frame, times the share of each colour." }
dims = { default = [1.0, 1.0, 1.0], length = [3, 3], element = { default = 1.0, range = [0.0, 1.0] }, help = "That share of red, green and blue." }
colour = { default = [1.0, 0.55, 0.2], length = [3, 3], element = { default = 1.0, range = [0.0, 1.0] }, help = "Of its light, linear red, green and blue." }
brightness = { default = 1.0, range = [0.0, 100.0], unit = "×", help = "Radiance that a very deep one has in its own frame." }
---*/

const int PROGRADE = 0;  // of the options of `orbit`

// M = 1 in these functions. With W = ln|u_t| and l = −u_φ/u_t the same everywhere, e^(−2W) = 1 + x with
//     x = [2r + (2r − a l)²/Δ − l²/sin²θ]/Σ
// in which no difference of nearly equal numbers is formed; l is positive, and a where the hole turns the same way. The torus is where x is more than on its
// surface, and its density a power of e^(W_in − W) − 1.
struct TorusForm {
    float spin, momentum;  // a, l
    float surface;         // x on its surface
    float deepest;         // e^(W_in − W) − 1 where the pressure is highest
};

float torus_excess(float r, float sine2, float a, float l) {
    float delta = (r - hole_w_factors.x) * (r - hole_w_factors.y), pull = 2.0 * r - a * l;
    return (2.0 * r + pull * pull / delta - l * l / sine2) / (r * r + a * a * (1.0 - sine2));
}

// e^(W_in − W) − 1.
float torus_depth(float excess, float surface) {
    return (excess - surface) / (1.0 + surface + sqrt(max((1.0 + surface) * (1.0 + excess), 0.0)));
}

TorusForm torus_form(int i) {
    TorusForm form;
    form.spin = medium_torus_orbit(i) == PROGRADE ? abs(hole_spin) : -abs(hole_spin);
    float x = sqrt(2.0 * medium_torus_peak_radius(i)), x2 = x * x;
    form.momentum = (x2 * x2 + form.spin * (form.spin - 2.0 * x)) / (x * (x2 - 2.0) + form.spin);  // Kepler's
    form.surface = torus_excess(2.0 * medium_torus_inner_radius(i), 1.0, form.spin, form.momentum);
    form.deepest = torus_depth(torus_excess(x2, 1.0, form.spin, form.momentum), form.surface);
    return form;
}

// Density at x in r_s, 1 where it is highest.
float torus_density(int i, vec3 x) {
    TorusForm form = torus_form(i);
    float r2 = dot(x, x), r = sqrt(r2), sine2 = max(dot(x.xy, x.xy) / r2, 1e-8);
    float share = torus_depth(torus_excess(2.0 * r, sine2, form.spin, form.momentum), form.surface) / form.deepest;
    bool there = form.deepest > 0.0 && share > 0.0 && r > medium_torus_inner_radius(i);
    return there ? pow(share, 1.0 / (medium_torus_gamma(i) - 1.0)) : 0.0;
}

// A cylinder's outside as far as its `radius`: the torus lies within, and thins out to nothing at its own surface.
float medium_torus_distance(int i, vec3 x) {
    return max(medium_torus_inner_radius(i) - length(x.xy), length(x) - medium_torus_radius(i));
}

// Above and below the torus, half of the way to it besides, level with the plane.
float medium_torus_scale(int i, vec3 x) {
    TorusForm form = torus_form(i);
    float r = 2.0 * length(x), pull = 2.0 * r - form.spin * form.momentum;
    float delta = (r - hole_w_factors.x) * (r - hole_w_factors.y);
    float room = 2.0 * r + pull * pull / delta - r * r * form.surface;
    float edge = room > 0.0 ? min(abs(form.momentum) * inversesqrt(room), 1.0) * 0.5 * r : 0.5 * r;  // from the axis, r_s
    return 0.6 * (medium_torus_peak_radius(i) - medium_torus_inner_radius(i)) + 2.0 * max(edge - length(x.xy), 0.0);
}

Matter medium_torus_matter(int i, Sight sight) {
    float density = torus_density(i, sight.place);
    TorusForm form = torus_form(i);
    float sense = (hole_spin < 0.0) == (medium_torus_orbit(i) == PROGRADE) ? -1.0 : 1.0;
    vec3 absorption = density * medium_torus_depth(i) * medium_torus_dims(i);
    return Matter(absorption * medium_torus_brightness(i) * medium_torus_colour(i), absorption, circling_shift(sight, sense * form.momentum));
}
