/*---
label = "Lensing flare"
summary = "A flare on the inner edge where the matter comes towards the camera."
source = "BlackHoleGPU (docs/sources.md): light times 1 + 1.8 s ((c + 1)/2)², s rising from 1.5 to 1.05 inner radii, c the cosine between light and matter"
slot = "disk_layer"
rank = 70
enabled = false
moves = false
acts_on_light = true

[parameters.strength]
default = 1.8
range = [0.0, 10.0]
help = "How much light is added at its brightest; 1.8 as published."
---*/

DiskMatter disk_layer_lensing_flare(DiskMatter matter) {
    float inside = 1.0 - smoothstep(1.05, 1.5, matter.radius / disk_r_in);
    float towards = 0.5 * (matter.approach + 1.0);
    matter.gain *= 1.0 + disk_lensing_flare_strength * inside * towards * towards;
    return matter;
}
