/*---
label = "Ball"
summary = "A ball of uniform fog, which shines and dims: along a chord c in flat space I = S (1 − exp(−α c))."
source = "own"
slot = "medium"
rank = 1
moves = true
round = true
reach = ["radius"]

[parameters]
radius = { default = 2.0, range = [0.01, 100.0], unit = "r_s", help = "Its radius." }
depth = { default = 0.3, range = [0.0, 100.0], unit = "1/r_s", help = "Optical depth of 1 r_s of it, in its own frame, times the share of each colour." }
dims = { default = [1.0, 1.0, 1.0], length = [3, 3], element = { default = 1.0, range = [0.0, 1.0] }, help = "That share of red, green and blue." }
colour = { default = [0.4, 0.6, 1.0], length = [3, 3], element = { default = 1.0, range = [0.0, 1.0] }, help = "Of its light, linear red, green and blue." }
brightness = { default = 0.5, range = [0.0, 100.0], unit = "×", help = "Radiance that a very deep one has." }
---*/

float medium_ball_distance(int i, vec3 x) {
    return distance(x, medium_ball_centre(i)) - medium_ball_radius(i);
}

float medium_ball_scale(int i, vec3 x) {
    return medium_ball_radius(i);
}

Matter medium_ball_matter(int i, Sight sight) {
    vec3 absorption = medium_ball_depth(i) * medium_ball_dims(i);
    vec3 source = medium_ball_brightness(i) * medium_ball_colour(i);
    return Matter(absorption * source, absorption, emitted_shift(sight, medium_ball_velocity(i).xyz));
}
