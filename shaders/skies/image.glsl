/*---
label = "Panorama"
summary = "A picture of the whole sky of one's own: equirectangular, or six faces of a cube."
source = "own"
slot = "sky"
rank = 25

[parameters.file]
default = ""
suffixes = [".png", ".jpg", ".jpeg", ".webp", ".bmp", ".hdr", ".npy"]
help = "PNG (8 or 16 bits), JPEG, WebP, BMP, Radiance .hdr or a NumPy array of light; twice as wide as high, or six squares: a row, a column, two rows of three, a cross, or six files (…_right, …_left, …_up, …_down, …_front, …_back), of which one is named."

[parameters.brightness]
default = 1.0
range = [0.0, 100.0]
unit = "×"
help = "Of its light."

[parameters.yaw_deg]
default = 180.0
range = [-360.0, 360.0]
unit = "°"
help = "Azimuth of its middle, where pitch is 0."

[parameters.pitch_deg]
default = 0.0
range = [-90.0, 90.0]
unit = "°"
help = "How far its middle is lifted above the equatorial plane."

[parameters.roll_deg]
default = 0.0
range = [-180.0, 180.0]
unit = "°"
help = "Turn about its middle, before the others."

[parameters.frequency_shift]
default = true
help = "Shift its brightness (as the fourth power) by the observer's place and motion, and its colours as those of light from 6500 K."

[numbers.image_attitude]
make = "blackhole_gl.rendering.sky_attitude:attitude"
of = ["sky.image.yaw_deg", "sky.image.pitch_deg", "sky.image.roll_deg"]
type = "vec4"
---*/
#include "common/shifted_light.glsl"
#include "common/rotation.glsl"
#include "common/sky_cube.glsl"

uniform sampler2D sky_image_file; // blackhole_gl/rendering/panorama_files.py: six tiles of the cube

const float IMAGE_TAPS = 8.0;    // a footprint longer than so many times its width is widened
const float IMAGE_LEVELS = 6.0;  // the coarsest

vec3 image_at(vec3 direction, float level) {
    SkyPlace at = sky_place(direction);
    float axis = floor(0.5 * at.face);
    vec2 tile = vec2(axis, at.face - 2.0 * axis) + 0.5 + 0.4375 * at.place;
    return textureLod(sky_image_file, tile * vec2(1.0 / 3.0, 0.5), level).rgb;
}

vec3 sky_radiance(vec3 direction, vec3 right, vec3 up, float energy) {
    vec3 ahead = unturned(image_attitude, direction), a = unturned(image_attitude, right), b = unturned(image_attitude, up);
    float texel = 5.3855874 / float(textureSize(sky_image_file, 0).x); // rad; π/2 over 7/8 of a tile, a third of the width
    // Longest half-axis of the ellipse that a and b span, by the eigenvector of their Gram matrix.
    float aa = dot(a, a), ab = dot(a, b), bb = dot(b, b);
    float longest2 = 0.5 * (aa + bb) + length(vec2(0.5 * (aa - bb), ab));
    float longest = sqrt(max(longest2, 1e-20));
    vec2 along = aa >= bb ? vec2(longest2 - bb, ab) : vec2(ab, longest2 - aa);
    vec3 axis = (a * along.x + b * along.y) * inversesqrt(max(dot(along, along), 1e-30));
    float width = max(max(length(cross(a, b)) / longest, texel), longest / IMAGE_TAPS);
    float count = clamp(ceil(longest / width), 1.0, IMAGE_TAPS), level = min(log2(width / texel), IMAGE_LEVELS);
    // A tap is as wide as the footprint: they stand between its ends, and on each other where it is round.
    vec3 apart = axis * (max(1.0 - width / longest, 0.0) / max(count - 1.0, 1.0));
    vec3 sum = vec3(0.0);
    float k = 0.0;
    do {
        sum += image_at(ahead + (k - 0.5 * (count - 1.0)) * apart, level);
        k += 1.0;
    } while (k < count);
    vec3 light = sum / count * sky_image_brightness;
#if SKY_IMAGE_FREQUENCY_SHIFT
    light = shifted_light(light, energy);
#endif
    return light;
}
