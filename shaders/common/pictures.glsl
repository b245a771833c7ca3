// Pictures of the user's, filtered over a footprint however long: the level of the mipmaps from its short side, several taps along the long one.
//
// `place` is 0…1 from the picture's lower left corner; `right` and `up` are how it changes from this pixel to the next. Light is linear and premultiplied
// by its alpha. Any length may come.

const float PICTURE_TAPS = 8.0;  // a footprint longer than so many times its width is widened
const float FOOTPRINT_MOST = 4.0;  // pictures: in one so long is all of it, and squares stay finite

struct PictureTaps {
    vec2 first, along;  // place of the first, and from each to the next
    float count;
    float level;
};

PictureTaps picture_taps(vec2 size, vec2 place, vec2 right, vec2 up) {
    vec2 a = clamp(right, -FOOTPRINT_MOST, FOOTPRINT_MOST) * size, b = clamp(up, -FOOTPRINT_MOST, FOOTPRINT_MOST) * size;
    // Longest half-axis of the ellipse that a and b span, by the eigenvalues of a aᵀ + b bᵀ.
    vec3 c = vec3(a.x * a.x + b.x * b.x, a.x * a.y + b.x * b.y, a.y * a.y + b.y * b.y);
    float half_trace = 0.5 * (c.x + c.z);
    float longest2 = half_trace + length(vec2(0.5 * (c.x - c.z), c.y));
    float area = abs(a.x * b.y - a.y * b.x);
    float longest = sqrt(max(longest2, 1e-12));
    float width = max(area / longest, 1.0);
    vec2 axis = c.x >= c.z ? vec2(longest2 - c.z, c.y) : vec2(c.y, longest2 - c.x);
    axis = longest2 > 1e-12 ? axis * inversesqrt(max(dot(axis, axis), 1e-30)) : vec2(1.0, 0.0);
    width = max(width, longest / PICTURE_TAPS);
    float count = max(ceil(longest / width), 1.0);
    // A tap is as wide as the footprint: they stand between its ends, and on each other where it is round.
    vec2 whole = axis * (max(longest - width, 0.0) / size);
    vec2 along = whole / max(count - 1.0, 1.0);
    return PictureTaps(place - 0.5 * along * (count - 1.0), along, count, log2(width));
}

vec4 picture_light(sampler2D picture, vec2 place, vec2 right, vec2 up) {
    PictureTaps taps = picture_taps(vec2(textureSize(picture, 0)), place, right, up);
    vec4 sum = vec4(0.0);
    float k = 0.0;
    do {
        sum += textureLod(picture, taps.first + k * taps.along, taps.level);
        k += 1.0;
    } while (k < taps.count);
    return sum / taps.count;
}

vec4 picture_light(sampler2DArray pictures, int layer, vec2 place, vec2 right, vec2 up) {
    PictureTaps taps = picture_taps(vec2(textureSize(pictures, 0).xy), place, right, up);
    vec4 sum = vec4(0.0);
    float k = 0.0;
    do {
        sum += textureLod(pictures, vec3(taps.first + k * taps.along, float(layer)), taps.level);
        k += 1.0;
    } while (k < taps.count);
    return layer < 0 ? vec4(0.0) : sum / taps.count;
}
