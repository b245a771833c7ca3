// Light → the screen's code of it, by the table of the tone curve.

uniform sampler2D tone_table;  // post/tone_table.frag

const vec2 FROM_BYTES = vec2(1.0, 1.0 / 255.0);

float curved(float light) {
    return min(dot(texelFetch(tone_table, tone_table_place(light), 0).rg, FROM_BYTES), 1.0); // 255 × (1/255) may exceed 1
}

vec3 developed(vec3 light) {
#if TONE_MIXES
    light = tone_mixed(light);
#endif
    vec3 code = vec3(curved(light.r), curved(light.g), curved(light.b));
#if TONE_MIXES
    code = tone_unmixed(code);
    code = vec3(srgb_code(code.r), srgb_code(code.g), srgb_code(code.b));
#endif
    return code;
}
