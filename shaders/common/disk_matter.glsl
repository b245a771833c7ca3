// What a ray meets where it crosses the disk: what disk layers read and change.

struct DiskMatter {
    float radius;    // r_s
    vec2 heading;    // (cos φ, sin φ)
    vec2 footprint;  // of the pixel, in ln r and in φ
    float density;   // 1 on a smooth disk
};
