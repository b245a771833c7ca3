#version 330 core
// A mesh over the picture of a view, each corner with its place in a picture that has directions at even steps of longitude and latitude. Between corners places
// are linear, to a quarter of a pixel (blackhole_gl/rendering/turning.py).
#blocks

uniform mat3 from_plane;    // (x, y, 1) at distance 1, −1 to 1 within the view → (right, up, ahead) in the frame of the other picture
uniform vec4 around_place;  // from (longitude, latitude) in radians to the place there, 0…1: scale, shift
uniform int columns;        // of quads
uniform vec2 quad;          // their sides, of the picture's 2

noperspective out vec2 place;

const vec2 CORNERS[6] = vec2[6](vec2(0.0, 0.0), vec2(1.0, 0.0), vec2(0.0, 1.0), vec2(0.0, 1.0), vec2(1.0, 0.0), vec2(1.0, 1.0));

// Within 1e-5 rad (Abramowitz & Stegun 4.4.47).
float angle(float across, float along) {
    float a = abs(across), b = abs(along);
    float t = min(a, b) / max(max(a, b), 1e-12), t2 = t * t;
    float small = t * (0.9998660 + t2 * (-0.3302995 + t2 * (0.1801410 + t2 * (-0.0851330 + t2 * 0.0208351))));
    float right_angle = a > b ? 1.5707963 - small : small;
    return across < 0.0 ? -right_angle : right_angle;
}

void main() {
    int n = gl_VertexID / 6;
    vec2 corner = quad * (vec2(n % columns, n / columns) + CORNERS[gl_VertexID % 6]) - 1.0;
    vec3 v = from_plane * vec3(corner, 1.0);
    place = vec2(angle(v.x, v.z), angle(v.y, length(v.xz))) * around_place.xy + around_place.zw;
    gl_Position = vec4(corner, 0.0, 1.0);
    carry();
}
