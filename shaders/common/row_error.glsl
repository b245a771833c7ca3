// What interpolation between the middle two of four nodes in a row leaves out, and how far that displaces what is seen.

// Shares of the differences that stand for the error, as in refine_nodes.frag.
const float OF_THIRD = 1.0 / 32.0, OF_FOURTH = 1.0 / 48.0, OF_SECOND = 1.0 / 256.0;

vec3 row_error(vec3 node[4]) {
    vec3 before = node[2] - 2.0 * node[1] + node[0], after = node[3] - 2.0 * node[2] + node[1];
    vec3 third = after - before, second = dot(before, before) > dot(after, after) ? before : after;
    return (OF_THIRD + OF_FOURTH * length(third) / max(length(second), 1e-12)) * third + OF_SECOND * second;
}

// What the polynomial through all six nodes of a row has halfway between its middle two beyond the cubic through the middle four, both of which take the means of the middle
// pair, of the pair about it and of the outermost.
vec3 beyond_cubic(vec3 mean, vec3 about, vec3 outermost) {
    return 3.0 / 128.0 * (2.0 * mean - 3.0 * about + outermost);
}

// How far in pixels what is seen moves for errors of rows and of columns: what of them lies along the surface, which changes by `right` and `up` from pixel to pixel.
float displacement(vec3 right, vec3 up, vec3 of_row, vec3 of_column) {
    float xx = dot(right, right), xy = dot(right, up), yy = dot(up, up), inverse = 1.0 / max(xx * yy - xy * xy, 1e-30);
    vec3 errors[2] = vec3[2](of_row, of_column);
    vec2 moved = vec2(0.0);
    for (int axis = 0; axis < 2; ++axis) {
        vec2 along = vec2(dot(right, errors[axis]), dot(up, errors[axis]));
        moved += abs(inverse * vec2(yy * along.x - xy * along.y, xx * along.y - xy * along.x));
    }
    return length(moved);
}
