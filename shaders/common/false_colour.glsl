// What all views share: values as colours, in linear light. Ranges, colours and legend come from blackhole_gl/rendering/views.py.

uniform sampler2D colour_scale;  // one row, from the low end to the high one
uniform vec3 view_range;         // values at the ends (their logarithms on a logarithmic scale); 1 where it is one
uniform vec3 view_legend[4];     // colours off the scale, as the legend lists them

out vec4 radiance;

vec3 false_colour(float value) {
    float place = view_range.z > 0.0 ? log(max(value, 1e-30)) : value;
    place = clamp((place - view_range.x) / (view_range.y - view_range.x), 0.0, 1.0);
    float entries = float(textureSize(colour_scale, 0).x);
    return textureLod(colour_scale, vec2((place * (entries - 1.0) + 0.5) / entries, 0.5), 0.0).rgb;
}
