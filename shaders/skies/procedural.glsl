/*---
label = "Stars and galaxy"
summary = "Procedural stars with a natural distribution of brightness and colour, and a galaxy band with dust."
source = "own; number of stars against flux N(>F) ∝ F^-4/3, a little flatter than Euclid's 3/2, as in the real sky"
slot = "sky"
rank = 10

[parameters.star_brightness]
default = 1.0
range = [0.0, 20.0]
unit = "×"
help = "Brightness of the stars."

[parameters.galaxy_brightness]
default = 1.0
range = [0.0, 20.0]
unit = "×"
help = "Brightness of the galaxy band."

[parameters.star_size]
default = 0.00025
range = [0.0, 0.01]
unit = "rad"
help = "Angular radius of a star where pixels are smaller than that: under high magnification stars become arcs of bounded brightness."

[parameters.frequency_shift]
default = true
help = "Shift the sky's colour and brightness (as the fourth power) by the observer's place and motion."
---*/
#include "common/noise.glsl"
#include "common/colour.glsl"

// Stars sit in the cells of four grids on a cube round the world, one star a cell, each grid finer and fainter than the
// last. A star keeps a margin to its cell's border. So long as the pixel's footprint is smaller than the margin, only the
// star of the pixel's own cell can be seen in it: one look-up a grid, no neighbours, no seams at the cube's edges. Where the
// footprint grows beyond that, the grid fades into its own mean radiance.
//
// A star of flux F has radiance F·K/A: A the solid angle of sky in the footprint, K a kernel of integral 1 over it. So its
// light, summed over pixels, is F times the lens's magnification, wherever the star falls between the pixels.

uniform sampler2D galaxy_band; // assets/galaxy_band.npz: longitude × sin(latitude) in −0.5…0.5, square root of radiance

const vec3 GALAXY_CENTRE = vec3(-0.947063, 0.290589, 0.136495);
const vec3 GALAXY_POLE = vec3(0.284464, 0.562425, 0.776375);
const float GALAXY_TEXEL = 6.2831853 / 1024.0;
const float STAR_MARGIN = 0.16; // of a cell
const float STAR_UNIT = 4.0e-6; // radiance × sr of a star of flux 1

// A footprint on the sky as the inverse of its covariance in the plane that touches the sphere at `centre`.
struct SkySpot {
    vec3 centre;
    vec3 e1, e2;      // orthonormal, perpendicular to centre
    vec3 metric;      // (C⁻¹)₁₁, (C⁻¹)₁₂, (C⁻¹)₂₂
    float area;       // √det C, sr
    float reach;      // longest half-axis, rad
};

SkySpot sky_spot(vec3 centre, vec3 right, vec3 up) {
    SkySpot spot;
    spot.centre = centre;
    vec3 along = right - centre * dot(right, centre);
    vec3 spare = cross(centre, abs(centre.z) < 0.9 ? vec3(0.0, 0.0, 1.0) : vec3(1.0, 0.0, 0.0));
    spot.e1 = normalize(dot(along, along) > 1e-18 ? along : spare);
    spot.e2 = cross(centre, spot.e1);
    vec2 a = vec2(dot(right, spot.e1), dot(right, spot.e2));
    vec2 b = vec2(dot(up, spot.e1), dot(up, spot.e2));
    float least = max(sky_procedural_star_size * sky_procedural_star_size, 1e-13); // float32 directions resolve no less
    vec3 c = vec3(a.x * a.x + b.x * b.x + least, a.x * a.y + b.x * b.y, a.y * a.y + b.y * b.y + least);
    // det C = (a × b)² + least·(|a|² + |b|²) + least²: no difference of large numbers
    float cross_ab = a.x * b.y - a.y * b.x;
    float det = cross_ab * cross_ab + least * (dot(a, a) + dot(b, b)) + least * least;
    spot.metric = vec3(c.z, -c.y, c.x) / det;
    spot.area = sqrt(det);
    float half_trace = 0.5 * (c.x + c.z);
    spot.reach = sqrt(half_trace + sqrt(max(half_trace * half_trace - det, 0.0)));
    return spot;
}

// How many stars there are towards d against the galactic plane: 1 in the plane, a quarter far from it.
float star_richness(vec3 d) {
    float height = dot(d, GALAXY_POLE);
    return 0.25 + 0.75 / (1.0 + 20.0 * height * height);
}

// A place on the cube: face 0…5, place in −1…1 on it, spread so that cells have nearly equal solid angles.
struct SkyPlace {
    int face;
    vec2 place;
    float cell_width; // rad × cells across a face
};

vec3 cube_direction(int face, vec2 place) {
    vec2 flat_place = place * (abs(place) + 2.0) / 3.0;
    vec3 turned = vec3((face & 1) == 1 ? -1.0 : 1.0, flat_place);
    return normalize(face < 2 ? turned : (face < 4 ? turned.zxy : turned.yzx));
}

// Solid angle of a cell at `place` against the largest there is (1.483 of the one at a face's middle).
float cube_cell_share(vec2 place) {
    vec2 p = abs(place);
    vec2 flat_place = p * (p + 2.0) / 3.0;
    float square = 1.0 + dot(flat_place, flat_place);
    return (1.0 + p.x) * (1.0 + p.y) / (1.4831 * square * sqrt(square));
}

// Angular distance between the nearer two opposite sides of a cell at `place`, times the number of cells across a face.
float cube_cell_width(vec2 place) {
    vec2 p = abs(place);
    vec2 squares = p * (p + 2.0) / 3.0;
    squares *= squares;
    vec2 width = (1.0 + p) * inversesqrt(1.0 + squares);
    return 4.0 / 3.0 * min(width.x, width.y) * inversesqrt(1.0 + squares.x + squares.y);
}

SkyPlace sky_place(vec3 d) {
    vec3 a = abs(d);
    bool x_face = a.x >= a.y && a.x >= a.z;
    bool y_face = !x_face && a.y >= a.z;
    vec3 turned = x_face ? d : (y_face ? d.yzx : d.zxy);
    vec2 flat_place = turned.yz / abs(turned.x);
    vec2 place = sign(flat_place) * (sqrt(1.0 + 3.0 * abs(flat_place)) - 1.0);
    int face = (x_face ? 0 : (y_face ? 2 : 4)) + (turned.x < 0.0 ? 1 : 0);
    return SkyPlace(face, place, cube_cell_width(place));
}

// Light of stars, kept as one number and its temperature: colour is looked up once, at the end.
struct StarLight {
    float power;  // radiance × sr of a star of flux 1
    float heat;   // the same, times K
};

// Adds one grid of 6·cells² places for stars with fluxes from `low` to `high`, number ∝ flux^-4/3.
// `richness`: stars per place and steradian of a grid with one cell across a face.
StarLight add_star_grid(StarLight light, SkySpot spot, SkyPlace at, float cells, float low, float high, float richness) {
    float tail = pow(low / high, 4.0 / 3.0);
    float mean_flux = 4.0 * (low - high * tail) / (1.0 - tail);
    float mean_power = mean_flux * richness * cells * cells;
    float single = 1.0 - smoothstep(0.8, 1.0, 2.0 * spot.reach * cells / (STAR_MARGIN * at.cell_width));

    vec2 cell = min(floor((at.place * 0.5 + 0.5) * cells), cells - 1.0);
    uint h = hash_lattice(ivec3(ivec2(cell), at.face), uint(cells));
    vec2 where = (cell + mix(vec2(STAR_MARGIN), vec2(1.0 - STAR_MARGIN), hash_vec3(h).xy)) / cells * 2.0 - 1.0;
    vec3 star = cube_direction(at.face, where);
    vec2 d = vec2(dot(star, spot.e1), dot(star, spot.e2));
    float distance2 = spot.metric.x * d.x * d.x + 2.0 * spot.metric.y * d.x * d.y + spot.metric.z * d.y * d.y;
    float fall = max(1.0 - 0.25 * distance2, 0.0); // ∫ fall³ over the disc of radius 2 is π

    vec3 draw = hash_vec3(hash_bits(h + 1u));
    float exists = step(draw.x, star_richness(star) * cube_cell_share(where));
    float root = inversesqrt(mix(1.0, tail, draw.y));
    float flux = low * root * sqrt(root); // the inverse of the count, to the power 3/4
    float rare = draw.z * draw.z;
    rare *= rare;
    float kelvin = 2900.0 + 5500.0 * draw.z + 18000.0 * rare * rare;
    float power = exists * single * flux * fall * fall * fall / (3.1415927 * spot.area);
    mean_power *= 1.0 - single;
    return StarLight(light.power + power + mean_power, light.heat + power * kelvin + mean_power * 6200.0);
}

vec3 galaxy_radiance(SkySpot spot) {
    float height = dot(spot.centre, GALAXY_POLE);
    float longitude = atan(dot(spot.centre, cross(GALAXY_POLE, GALAXY_CENTRE)), dot(spot.centre, GALAXY_CENTRE));
    float level = log2(max(spot.reach / GALAXY_TEXEL, 1.0));
    // A very wide footprint holds the sky beside the band too, which is as large as the band's map and dark.
    float whole_sky = smoothstep(0.1, 0.6, spot.reach);
    vec2 place = vec2(longitude / 6.2831853 + 0.5, 0.5 + height * (1.0 - whole_sky));
    vec3 root = textureLod(galaxy_band, place, level).rgb;
    return root * root * (1.0 - 0.5 * whole_sky);
}

vec3 sky_radiance(vec3 direction, vec3 right, vec3 up, float energy) {
#if !SKY_PROCEDURAL_FREQUENCY_SHIFT
    energy = 1.0;
#endif
    SkySpot spot = sky_spot(direction, right, up);
    SkyPlace at = sky_place(direction);
    // A grid of n × n cells a face has n²/4 · 9/4 /1.4831 stars per steradian, wherever one looks, times the richness.
    float richness = star_richness(direction) * 0.5625 / 1.4831;
    StarLight stars = StarLight(0.0, 0.0);
    stars = add_star_grid(stars, spot, at, 7.0, 1.0, 20.0, richness);
    stars = add_star_grid(stars, spot, at, 16.0, 0.2536, 1.0, richness);
    stars = add_star_grid(stars, spot, at, 34.0, 0.0783, 0.2536, richness);
    stars = add_star_grid(stars, spot, at, 60.0, 0.0309, 0.0783, richness);
    vec3 colour = blackbody_colour(stars.heat / max(stars.power, 1e-20) * energy);
    vec3 galaxy = galaxy_radiance(spot) * (0.06 * sky_procedural_galaxy_brightness);
    float boost = energy * energy;
    return (colour * (stars.power * STAR_UNIT * sky_procedural_star_brightness) + galaxy) * (boost * boost);
}
