// The disk's temperature, and what frequency shifts make of its colour.

uniform sampler2D temperature_profile; // one row, T/T_peak at r = mix(disk_r_edge, disk_r_out, t²); blackhole_gl/physics/disk_profile.py

float disk_temperature(float r) {
    float t = sqrt(clamp((r - disk_r_edge) / (disk_r_out - disk_r_edge), 0.0, 1.0));
    return textureLod(temperature_profile, vec2(t, 0.5), 0.0).r;
}

// What multiplies the temperature that is seen, gravity's part and the motion's, each 1 where its switch is off. `shift` as in disk_orbit.glsl;
// `energy` is the observer's own E_observer/E_infinity, which counts as gravity's.
vec2 disk_colour_shift(vec2 shift, float energy) {
    return vec2(DISK_REDSHIFT == 1 ? shift.x * energy : 1.0, DISK_DOPPLER_COLOUR == 1 ? shift.y : 1.0);
}

// The same of what the brightness goes by.
vec2 disk_power_shift(vec2 shift, float energy) {
    return vec2(DISK_REDSHIFT == 1 ? shift.x * energy : 1.0, DISK_BEAMING == 1 ? shift.y : 1.0);
}
