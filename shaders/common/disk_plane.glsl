// The disk's plane: z = 0, or with DISK_TILTED a plane through the hole whose axes the host has worked out (blackhole_gl/physics/tilted_disk.py).

// Above the plane. What is in a tilted plane but for rounding is in it, as a camera there that would else cross it where it is.
float disk_height(vec3 x) {
#if DISK_TILTED
    float height = dot(x, disk_axis_z.xyz);
    return abs(height) < 3e-7 * length(x) ? 0.0 : height;
#else
    return x.z;
#endif
}

// x in the disk's axes: disk_axis_z stands on the plane.
vec3 in_disk_axes(vec3 x) {
#if DISK_TILTED
    return vec3(dot(x, disk_axis_x.xyz), dot(x, disk_axis_y.xyz), disk_height(x));
#else
    return x;
#endif
}

// Where a point of the plane is in space.
vec3 disk_place(vec2 point) {
#if DISK_TILTED
    return point.x * disk_axis_x.xyz + point.y * disk_axis_y.xyz;
#else
    return vec3(point, 0.0);
#endif
}
