/*---
label = "Relativistic lanes"
summary = "Brightens what comes towards the camera and dims what goes away, whatever the temperature: added to the Doppler effect, not a part of it."
source = "BlackHoleGPU (docs/sources.md): light times clamp(1 + 0.75 c, 0.25, 2.5)³, c the cosine between light and matter"
slot = "disk_layer"
rank = 60
enabled = false
moves = false
acts_on_light = true

[parameters.strength]
default = 1.0
range = [0.0, 1.0]
help = "0 leaves the light as it is, 1 is the published factor."
---*/

DiskMatter disk_layer_relativistic_lanes(DiskMatter matter) {
    float factor = clamp(1.0 + 0.75 * matter.approach, 0.25, 2.5);
    matter.gain *= mix(1.0, factor * factor * factor, disk_relativistic_lanes_strength);
    return matter;
}
