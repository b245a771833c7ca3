// What transfer.frag leaves: of each stretch of a ray between crossings of the disk's plane, what the media there add, and the share that they take from what lies behind. On the host,
// blackhole_gl/rendering/transfer.py.

uniform sampler2D gathered0, dimmed0;
#if ORDERS > 0
uniform sampler2D gathered1, dimmed1;
#endif
#if ORDERS > 1
uniform sampler2D gathered2, dimmed2;
#endif
#if ORDERS > 2
uniform sampler2D gathered3, dimmed3;
#endif

bool is_medium(int kind) {
#each medium : if (kind == MEDIUM_$KEY) return true;
    return false;
}

// Of the stretch before which `before` ≤ ORDERS crossings come. Without meaning where the ray meets no medium.
Light stretch_light(ivec2 pixel, int before) {
    Light found = Light(texel_of(gathered0, pixel).rgb, 1.0 - texel_of(dimmed0, pixel).rgb);
#if ORDERS > 0
    if (before == 1) found = Light(texel_of(gathered1, pixel).rgb, 1.0 - texel_of(dimmed1, pixel).rgb);
#endif
#if ORDERS > 1
    if (before == 2) found = Light(texel_of(gathered2, pixel).rgb, 1.0 - texel_of(dimmed2, pixel).rgb);
#endif
#if ORDERS > 2
    if (before == 3) found = Light(texel_of(gathered3, pixel).rgb, 1.0 - texel_of(dimmed3, pixel).rgb);
#endif
    return found;
}

// Light with more of it behind.
Light behind(Light light, Light next) {
    return Light(light.gathered + light.passed * next.gathered, light.passed * next.passed);
}
