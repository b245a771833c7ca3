// Directions of escape as points of a plane, so that they can be interpolated in two numbers and stay unit vectors: stereographic, from the
// camera's forward direction. It is conformal: a piece of the plane at p is 2/(1 + |p|²) times as large on the sphere. Its one singular
// direction leads from the hole to the camera: light that was turned right back, which is seen beside the shadow's edge alone.
// Zero, the direction of rays that do not escape, is a point like any other.

float chart_scale(vec2 p) {
    return 2.0 / (1.0 + dot(p, p));
}

// In the frame of the camera's meridian, as the hit map's directions are.
vec2 chart_point(vec3 direction) {
    return vec2(dot(direction, camera_e_theta.xyz), dot(direction, camera_e_phi.xyz)) / (1.0 - dot(direction, camera_n.xyz));
}

vec3 chart_direction(vec2 p) {
    float scale = chart_scale(p);
    return scale * (p.x * camera_e_theta.xyz + p.y * camera_e_phi.xyz) + (1.0 - scale) * camera_n.xyz;
}
