/*---
label = "Beaming boost"
summary = "A bounded boost of the light by the third power of the Doppler factor, on top of the beaming itself."
source = "BlackHoleGPU (docs/sources.md): light times clamp(0.6 + 0.65 (D³ − 1), 0.35, 1.95)"
slot = "disk_layer"
rank = 80
enabled = false
moves = false
acts_on_light = true

[parameters.strength]
default = 1.0
range = [0.0, 1.0]
help = "0 leaves the light as it is, 1 is the published factor."
---*/

DiskMatter disk_layer_beaming_boost(DiskMatter matter) {
    float cube = matter.doppler * matter.doppler * matter.doppler;
    matter.gain *= mix(1.0, clamp(0.6 + 0.65 * (cube - 1.0), 0.35, 1.95), disk_beaming_boost_strength);
    return matter;
}
