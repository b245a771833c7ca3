// Colour: linear Rec. 709 in, sRGB out, black bodies from a table.
//
// `blackbody_table` is assets/blackbody.npy (tools/make_blackbody.py): one row, 1,000…40,000 K evenly in log T,
// each entry of luminance 1.

uniform sampler2D blackbody_table;

const vec3 LUMINANCE = vec3(0.2126, 0.7152, 0.0722); // ITU-R BT.709

// Linear Rec. 709 colour of a black body at `kelvin`, luminance 1. Outside the table: its nearest end.
vec3 blackbody_colour(float kelvin) {
    const float ROWS = 256.0;
    float place = log(max(kelvin, 1.0) / 1000.0) / log(40.0);
    return textureLod(blackbody_table, vec2((clamp(place, 0.0, 1.0) * (ROWS - 1.0) + 0.5) / ROWS, 0.5), 0.0).rgb;
}
