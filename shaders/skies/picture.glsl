/*---
label = "Picture"
summary = "A flat picture of one's own, infinitely far behind the hole, with one colour around it."
source = "own"
slot = "sky"
rank = 30

[parameters.file]
default = ""
suffixes = [".png", ".jpg", ".jpeg", ".webp", ".bmp"]
help = "The picture: PNG, JPEG, WebP or BMP, at most 64 MiB and 67 million pixels; asset:NAME is one that comes with the program."

[parameters.width_deg]
default = 60.0
range = [0.1, 170.0]
unit = "°"
help = "Angle that its width takes; its height follows."

[parameters.hung]
default = "behind"
options = ["behind", "fixed"]
help = "Always straight behind the hole as seen from the camera, or where azimuth and latitude say."

[parameters.azimuth_deg]
default = 180.0
range = [-180.0, 360.0]
unit = "°"
help = "Of its middle, where it is fixed."

[parameters.latitude_deg]
default = 0.0
range = [-90.0, 90.0]
unit = "°"
help = "Of its middle above the equatorial plane, where it is fixed."

[parameters.brightness]
default = 1.0
range = [0.0, 10.0]
unit = "×"
help = "Of its light."

[parameters.background_red]
default = 0.0
range = [0.0, 1.0]
help = "Red light around it."

[parameters.background_green]
default = 0.0
range = [0.0, 1.0]
help = "Green light around it."

[parameters.background_blue]
default = 0.0
range = [0.0, 1.0]
help = "Blue light around it."

[parameters.frequency_shift]
default = true
help = "Shift its brightness (as the fourth power) by the observer's place and motion, and its colours as those of light from 6500 K."

[numbers.sky_picture_axes]
make = "blackhole_gl.rendering.hung_picture:axes"
of = ["sky.picture.hung", "sky.picture.azimuth_deg", "sky.picture.latitude_deg", "camera.azimuth_deg", "camera.inclination_deg"]
type = "mat4"

[numbers.sky_picture_half_width]
make = "blackhole_gl.rendering.hung_picture:half_width"
of = ["sky.picture.width_deg"]
---*/
#include "common/pictures.glsl"
#include "common/shifted_light.glsl"

// The picture lies in the plane at distance 1 along its axis: a direction d meets it at (d·right, d·up)/(d·ahead).

uniform sampler2D sky_picture_file;

const float LEAST_AHEAD = 1e-3;

// 0…1 across the picture, of what is at `place` (right, up, ahead) of its axes; `change` from pixel to pixel.
vec2 change_on_picture(vec3 place, vec3 change, vec2 scale) {
    return scale * (change.xy * place.z - place.xy * change.z) / (place.z * place.z);
}

vec3 sky_radiance(vec3 direction, vec3 right, vec3 up, float energy) {
    mat3 axes = mat3(sky_picture_axes);
    vec3 place = axes * direction;
    float ahead = place.z;
    place.z = max(ahead, LEAST_AHEAD);
    vec2 size = vec2(textureSize(sky_picture_file, 0));
    vec2 scale = (0.5 / sky_picture_half_width) * vec2(1.0, size.x / size.y);
    vec2 on = 0.5 + scale * place.xy / place.z;
    vec2 a = change_on_picture(place, axes * right, scale), b = change_on_picture(place, axes * up, scale);
    vec4 light = picture_light(sky_picture_file, clamp(on, -1.0, 2.0), a, b);
    vec2 pixel = max(sqrt(a * a + b * b), 1e-7);
    vec2 cover = clamp((0.5 - abs(on - 0.5)) / pixel + 0.5, 0.0, 1.0);
    light *= ahead > LEAST_AHEAD ? cover.x * cover.y : 0.0;
    vec3 background = vec3(sky_picture_background_red, sky_picture_background_green, sky_picture_background_blue);
    vec3 seen = light.rgb * sky_picture_brightness + (1.0 - light.a) * background;
#if SKY_PICTURE_FREQUENCY_SHIFT
    seen = shifted_light(seen, energy);
#endif
    return seen;
}
