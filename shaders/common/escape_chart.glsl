// Directions of escape as points of a plane, so that they can be interpolated in two numbers and stay unit vectors: stereographic, from the
// direction that the camera looks in. It is conformal: a piece of the plane at p is 2/(1 + |p|²) times as large on the sphere. Its one singular
// direction lies straight behind the camera: such light was turned right back, and is seen beside the shadow's edge alone.
// Zero, the direction of rays that do not escape, is a point like any other.

float chart_scale(vec2 p) {
    return 2.0 / (1.0 + dot(p, p));
}

// In the plan's frame, as the hit map's directions are.
vec2 chart_point(vec3 direction) {
    return vec2(dot(direction, view_down.xyz), dot(direction, view_right.xyz)) / (1.0 - dot(direction, view_back.xyz));
}

vec3 chart_direction(vec2 p) {
    float scale = chart_scale(p);
    return scale * (p.x * view_down.xyz + p.y * view_right.xyz) + (1.0 - scale) * view_back.xyz;
}
