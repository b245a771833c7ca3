// Colour: black bodies in linear Rec. 709.

// Linear Rec. 709 colour of a black body at `kelvin`, luminance 1. Below 1,000 K and above 40,000 K: as there.
// Fits by tools/fit_blackbody.py, right to 0.3 grey levels: less work than a texel of a table.
vec3 blackbody_colour(float kelvin) {
    float t = clamp(kelvin * 1e-3, 1.0, 40.0);
    float red = ((0.670402 * t + 2.24134) * t + 14.9577) / ((t + 1.87135) * t + 1.03984);
    float blue = ((2.24272 * t - 4.795) * t + 1.00994) / ((t + 1.1278) * t + 12.725);
    blue = max(blue, 0.0); // below 1,900 K the colour lies outside Rec. 709
    float green = 1.398304 - 0.297381 * red - 0.100923 * blue; // what luminance 1 leaves
    return vec3(red, green, blue);
}
