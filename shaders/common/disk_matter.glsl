// What a ray meets where it crosses the disk: what disk layers read and change.

struct DiskMatter {
    float radius;    // r_s
    vec2 heading;    // (cos φ, sin φ)
    vec2 footprint;  // of the pixel, in ln r and in φ
    float approach;  // cosine between the light and the way the matter goes, as a ZAMO there sees them: 1 straight at the camera, −1 straight away
    float doppler;   // D: the part of the frequency shift that comes of the motion (common/disk_orbit.glsl)
    float density;   // 1 on a smooth disk
    float gain;      // of its light alone, 1 on a smooth disk
};
