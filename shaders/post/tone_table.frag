#version 330 core
// Light before exposure → the screen's code of it (where the curve mixes channels: the curve's answer), for one channel, as a table
// that the tone map looks up. Column: the ten leading bits of the mantissa; row: the exponent. The light of the nearest entry is
// right to 2^-11, and so its code to 0.05 grey levels at white.
#defines
#blocks
#include "common/tone_table.glsl"
#include "common/tone.glsl"

out vec4 entry;

void main() {
    ivec2 place = ivec2(gl_FragCoord.xy);
    float light = place.y == 0 ? 0.0 : tone_table_light(place);
    float shown = clamp(tone_channel(light * exp2(post_exposure)), 0.0, 1.0);
#if !TONE_MIXES
    shown = srgb_code(shown);
#endif
    // Sixteen bits in two channels of eight: fetched in half the time of a float (docs/llvmpipe.md).
    float high = floor(shown * 255.0);
    entry = vec4(high / 255.0, shown * 255.0 - high, 0.0, 1.0);
}
