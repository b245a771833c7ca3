// The finished picture displaced about the hole's place on it: offset ×= 1 − 2 Rad/(ρ √D)², as published. Where that turns an offset round it folds the
// picture over, and where it leads off the picture its edge is shown.
#if POST_LENS

// Offset from the hole in the picture's pixels, and the square of the same on a screen at distance 1.
vec3 from_hole(vec2 place) {
    vec2 offset = place * picture_size - picture_hole, on_screen = offset * (2.0 * picture_scale);
    return vec3(offset, dot(on_screen, on_screen));
}

// Square of the Einstein ring's radius on that screen; 0 from infinity.
float einstein2() {
    return 4.0 * post_lens_radius * camera_w;
}

// Where in the picture, 0…1, what is to be seen at `place` lies.
vec2 lensed_place(vec2 place, vec3 hole) {
    return place - hole.xy * (einstein2() / max(hole.z, 1e-12)) / picture_size;
}

// 0 on the black disc, 1 off it, and between on a pixel's width.
float lens_cover(vec3 hole) {
    return clamp((sqrt(hole.z) - 2.0 * post_lens_shadow * camera_w) / (2.0 * picture_scale) + 0.5, 0.0, 1.0);
}

float lens_ring(vec3 hole) {
    float pixels = abs(sqrt(hole.z) - sqrt(einstein2())) / (2.0 * picture_scale);
    return camera_w > 0.0 ? clamp(1.5 - pixels, 0.0, 1.0) : 0.0;
}
#endif
