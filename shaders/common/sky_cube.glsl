// A place on the cube: face 0…5, place in −1…1 on it, spread so that cells have nearly equal solid angles.
struct SkyPlace {
    float face;
    vec2 place;
    float narrowness; // inverse square of the angular distance between the nearer two opposite sides of a cell that is the whole face, rad⁻²
};

SkyPlace sky_place(vec3 d) {
    vec3 a = abs(d);
    bool x_face = a.x >= a.y && a.x >= a.z;
    bool y_face = !x_face && a.y >= a.z;
    vec3 turned = x_face ? d : (y_face ? d.yzx : d.zxy);
    vec2 flat_place = turned.yz * (1.0 / abs(turned.x));
    vec2 stretch = 1.0 + 3.0 * abs(flat_place);
    vec2 place = sign(flat_place) * (sqrt(stretch) - 1.0);
    float face = (x_face ? 0.0 : (y_face ? 2.0 : 4.0)) + (turned.x < 0.0 ? 1.0 : 0.0);
    // Sides are 4/3 √stretch/√((1 + flat²)(1 + flat.x² + flat.y²)) apart.
    vec2 squares = flat_place * flat_place;
    vec2 apart = (1.0 + squares) * stretch.yx;
    float narrowness = 0.5625 * (1.0 + squares.x + squares.y) * max(apart.x, apart.y) / (stretch.x * stretch.y);
    return SkyPlace(face, place, narrowness);
}
