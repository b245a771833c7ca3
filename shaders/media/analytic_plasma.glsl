/*---
label = "Analytic plasma"
summary = "The plasma of the EHT code comparison: a Gaussian of the radius and the height, a power law of frequency, on orbits of given angular momentum."
source = "Gold et al. 2020, the five tests with a known answer"
slot = "medium"
rank = 2
bolometric = false
soft = true
reach = ["radius"]

[parameters]
radius = { default = 25.0, range = [1.0, 500.0], unit = "r_s", help = "There is none beyond." }
size = { default = 5.0, range = [0.1, 100.0], unit = "r_s", help = "Radius at which the density n has fallen to exp(−1/2)." }
flatness = { default = 0.0, range = [0.0, 100.0], help = "h in n = exp(−½ ((r/size)² + (h cos θ)²))." }
emissivity = { default = 3.0, range = [0.0, 1000.0], unit = "10⁻¹⁸ cgs", help = "Light of one frequency at n = 1 in erg/(s cm³ sr Hz); 1 r_s of it has that radiance in the picture." }
depth = { default = 0.0, range = [0.0, 1000.0], unit = "1/r_s", help = "Optical depth of 1 r_s at n = 1." }
index = { default = 0.0, range = [-5.0, 5.0], help = "Light goes as the frequency to the power −index, absorption to the power −(2.5 + index)." }
turning = { default = 1.0, range = [-1.5, 1.5], help = "l₀ in the angular momentum l₀ R^1.5/(1 + R) over energy, R = r sin θ in M; 0 is dragged round by a spinning hole, no more." }
---*/

float medium_analytic_plasma_distance(int i, vec3 x) {
    return length(x) - medium_analytic_plasma_radius(i);
}

// That of the radius, and of the height: farther above the plane than there is any to speak of, the way back to it.
float medium_analytic_plasma_scale(int i, vec3 x) {
    float r = length(x), size = medium_analytic_plasma_size(i), flatness = max(medium_analytic_plasma_flatness(i), 1e-3);
    float height = flatness * abs(x.z) / max(r, 1e-6);
    return min(size / max(r / size, 1.0), r / flatness * max(1.0 / max(height, 1.0), height - 5.0));
}

Matter medium_analytic_plasma_matter(int i, Sight sight) {
    float r = length(sight.place), size = medium_analytic_plasma_size(i);
    float height = medium_analytic_plasma_flatness(i) * sight.place.z / r, out_from_axis = 2.0 * length(sight.place.xy);
    float density = exp(-0.5 * (r * r / (size * size) + height * height));
    float shift = circling_shift(sight, medium_analytic_plasma_turning(i) * out_from_axis * sqrt(out_from_axis) / (1.0 + out_from_axis));
    float frequency = 1.0 / max(shift * sight.energy, 1e-6), index = medium_analytic_plasma_index(i);
    float light = density * pow(frequency, -index);
    return Matter(vec3(medium_analytic_plasma_emissivity(i) * light), vec3(medium_analytic_plasma_depth(i) * light * pow(frequency, -2.5)), shift);
}
