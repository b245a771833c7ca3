// The part 0…1 of the straight piece from x to y at which the sphere about `middle` is first met, and whether it is entered there; 2: not at all.
// A piece that begins and ends on two sides of it meets it, whatever rounding makes of the part: else a ray might slip through where one piece joins the next.
float sphere_crossing(vec3 middle, float radius, vec3 x, vec3 y, out bool enters) {
    vec3 way = y - x, arm = x - middle, end = y - middle;
    float way2 = max(dot(way, way), 1e-30), nearest = -dot(arm, way) / way2;
    vec3 aside = arm + nearest * way;  // the difference before the squares
    float deep = (radius - length(aside)) * (radius + length(aside));
    float chord = sqrt(max(deep, 0.0) / way2);
    enters = dot(arm, arm) >= radius * radius;
    bool passes = enters == (dot(end, end) < radius * radius);
    float part = enters ? nearest - chord : nearest + chord;
    return passes ? clamp(part, 0.0, 1.0) : deep > 0.0 && enters && part >= 0.0 && part <= 1.0 ? part : 2.0;
}
