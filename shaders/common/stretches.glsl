// What transfer.frag leaves: of each stretch of a ray between crossings of the disk's plane, what the media there add and let through. On the host,
// blackhole_gl/rendering/transfer.py.

uniform sampler2D gathered0, passed0;
#if ORDERS > 0
uniform sampler2D gathered1, passed1;
#endif
#if ORDERS > 1
uniform sampler2D gathered2, passed2;
#endif
#if ORDERS > 2
uniform sampler2D gathered3, passed3;
#endif

bool is_medium(int kind) {
#each medium : if (kind == MEDIUM_$KEY) return true;
    return false;
}

// Of the stretch before which `before` ≤ ORDERS crossings come. Without meaning where the ray meets no medium.
Light stretch_light(ivec2 pixel, int before) {
    Light found = Light(texel_of(gathered0, pixel).rgb, texel_of(passed0, pixel).rgb);
#if ORDERS > 0
    if (before == 1) found = Light(texel_of(gathered1, pixel).rgb, texel_of(passed1, pixel).rgb);
#endif
#if ORDERS > 1
    if (before == 2) found = Light(texel_of(gathered2, pixel).rgb, texel_of(passed2, pixel).rgb);
#endif
#if ORDERS > 2
    if (before == 3) found = Light(texel_of(gathered3, pixel).rgb, texel_of(passed3, pixel).rgb);
#endif
    return found;
}

// Light with more of it behind.
Light behind(Light light, Light next) {
    return Light(light.gathered + light.passed * next.gathered, light.passed * next.passed);
}
