// Luminance of linear light with the primaries of Rec. 709.

float luminance(vec3 light) {
    return dot(light, vec3(0.2126, 0.7152, 0.0722));
}
