/*---
label = "Stars and galaxy"
summary = "Procedural stars with a natural distribution of brightness and colour, and a galaxy band with dust."
source = "own; number of stars against flux N(>F) ∝ F^-4/3, a little flatter than Euclid's 3/2, as in the real sky"
slot = "sky"
rank = 10
stars = 4

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

[tables.galaxy_band]
make = "blackhole_gl.rendering.galaxy_band:table"
filter = "mipmap"
repeat_x = true

[tables.star_cells]
make = "blackhole_gl.rendering.star_cells:table"
---*/
#include "common/rotation.glsl"
#include "common/sky_cube.glsl"
#include "common/star_light.glsl"

// Stars sit in the cells of four grids on a cube round the world, one star a cell, each grid finer and fainter than the
// last. A star keeps a margin to its cell's border. So long as the pixel's footprint is smaller than the margin, only the
// star of the pixel's own cell can be seen in it: one look-up a grid, no neighbours, no seams at the cube's edges. Where the
// footprint grows beyond that, the grid fades into its own mean radiance.

uniform sampler2D star_cells;  // blackhole_gl/rendering/star_cells.py; nearest: docs/llvmpipe.md, texels
uniform sampler2D galaxy_band; // assets/galaxy_band.npz: longitude × sin(latitude) in −0.5…0.5, square root of radiance

const vec3 GALAXY_CENTRE = vec3(-0.947063, 0.290589, 0.136495);
const vec3 GALAXY_POLE = vec3(0.284464, 0.562425, 0.776375);
const float GALAXY_TEXEL = 6.2831853 / 1024.0;
const float STAR_MARGIN = 0.16; // of a cell
const vec2 STAR_TEXEL = 1.0 / vec2(360.0, 117.0); // of star_cells
const float STAR_UNIT = 4.0e-6; // radiance × sr of a star of flux 1

float sky_kernel(float away2) {
    float fall = max(1.0 - away2, 0.0);
    return fall * fall * fall;
}

// How many stars there are towards d against the galactic plane: 1 in the plane, a quarter far from it.
float star_richness(vec3 d) {
    float height = dot(d, GALAXY_POLE);
    return 0.25 + 0.75 / (1.0 + 20.0 * height * height);
}

// A grid of 6·cells² places for stars with fluxes from `low` to `high`, number ∝ flux^-4/3. `row`: where they begin in `star_cells`.
struct StarGrid {
    float cells;
    float row;
    float low, high;
};

const StarGrid STAR_GRIDS[4] = StarGrid[](
    StarGrid(7.0, 0.0, 1.0, 20.0), StarGrid(16.0, 7.0, 0.2536, 1.0), StarGrid(34.0, 23.0, 0.0783, 0.2536), StarGrid(60.0, 57.0, 0.0309, 0.0783));

// How much of the grid is a haze. `spread`: the footprint over the star's margin in a grid with one cell across a face.
float grid_haze(StarGrid grid, float spread) {
    float haze = clamp(spread * (5.0 * grid.cells) - 4.0, 0.0, 1.0); // smoothstep(0.8, 1, …), which would divide by a constant
    return haze * haze * (3.0 - 2.0 * haze);
}

// The star in the cell of `at`: unit vector and flux.
vec4 grid_star(StarGrid grid, SkyPlace at) {
    vec2 cell = min(at.place * (0.5 * grid.cells) + 0.5 * grid.cells, grid.cells - 0.5);
    return textureLod(star_cells, (cell + vec2(at.face * grid.cells, grid.row)) * STAR_TEXEL, 0.0);
}

float sky_spread(SkySpot spot, SkyPlace at) {
    return (2.0 / STAR_MARGIN) * sqrt(spot.reach2 * at.narrowness);
}

// `room`: square of a distance, in half kernels.
void add_star_grid(inout StarLight light, StarGrid grid, SkySpot spot, SkyPlace at, float spread, float room) {
    float tail = pow(grid.low / grid.high, 4.0 / 3.0);
    float mean_flux = 4.0 * (grid.low - grid.high * tail) / (1.0 - tail);
    float haze = grid_haze(grid, spread);

    vec4 star = grid_star(grid, at);
    vec2 d = vec2(dot(star.xyz, spot.across), dot(star.xyz, spot.along));
    float away2 = dot(d, d);
    float single = star.w - haze * star.w;
    float flux = single * sky_kernel(away2);
    light.flux += flux;
    light.heat += flux * star_kelvin(star.w);
    light.haze += haze * (mean_flux * grid.cells * grid.cells);
    light.near += single * (room - away2) > 0.0 ? 1.0 : 0.0;
}

StarLight star_light(SkySpot spot, float room) {
    SkyPlace at = sky_place(spot.centre);
    float spread = sky_spread(spot, at);
    StarLight stars = StarLight(0.0, 0.0, 0.0, 0.0);
    add_star_grid(stars, STAR_GRIDS[0], spot, at, spread, room);
    add_star_grid(stars, STAR_GRIDS[1], spot, at, spread, room);
    add_star_grid(stars, STAR_GRIDS[2], spot, at, spread, room);
    add_star_grid(stars, STAR_GRIDS[3], spot, at, spread, room);
    // A grid of n × n cells a face has n²/4 · 9/4 /1.4831 stars per steradian, wherever one looks, times the richness.
    stars.haze *= star_richness(spot.centre) * (0.5625 / 1.4831);
    return stars;
}

// `reach`: half the longest axis of the footprint, rad.
vec3 galaxy_radiance(vec3 direction, float reach) {
    float height = dot(direction, GALAXY_POLE);
    float longitude = turns(dot(direction, GALAXY_CENTRE), dot(direction, cross(GALAXY_POLE, GALAXY_CENTRE)));
    float level = log2(max(reach / GALAXY_TEXEL, 1.0));
    // A very wide footprint holds the sky beside the band too, which is as large as the band's map and dark.
    float whole_sky = smoothstep(0.1, 0.6, reach);
    vec2 place = vec2(longitude + 0.5, 0.5 + height * (1.0 - whole_sky));
    vec3 root = textureLod(galaxy_band, place, level).rgb;
    return root * root * ((0.06 - 0.03 * whole_sky) * sky_procedural_galaxy_brightness);
}

// The observer's shift in colour, and as a factor of the light.
vec2 sky_shift(float energy) {
#if !SKY_PROCEDURAL_FREQUENCY_SHIFT
    energy = 1.0;
#endif
    float boost = energy * energy;
    return vec2(energy, boost * boost);
}

struct SkyStars {
    int count;
    SkyPlace at;
    float spread;
};

SkyStars sky_stars(vec3 direction, vec3 right, vec3 up, float finer) {
    SkyPlace at = sky_place(direction);
    return SkyStars(4, at, sky_spread(sky_spot(direction, right, up, sky_procedural_star_size), at));
}

SkyStars sky_stars_at(SkyStars stars, vec3 direction, vec3 right, vec3 up, float finer) {
    return SkyStars(stars.count, stars.at, sky_stars(direction, right, up, finer).spread);
}

vec3 sky_star(SkyStars stars, int n, float energy, out vec4 star) {
    vec2 shift = sky_shift(energy);
    StarGrid grid = STAR_GRIDS[n];
    star = grid_star(grid, stars.at);
    float flux = star.w - star.w * grid_haze(grid, stars.spread);
    vec3 light = blackbody_colour(star_kelvin(star.w) * shift.x) * (flux * STAR_UNIT * sky_procedural_star_brightness * shift.y);
    star.w = max(sky_procedural_star_size, 3.2e-7); // as in sky_spot
    return light;
}

vec3 sky_radiance(vec3 direction, vec3 right, vec3 up, float energy, float finer, out float stars_near) {
    vec2 shift = sky_shift(energy);
    SkySpot spot = sky_spot(direction, finer * right, finer * up, sky_procedural_star_size);
    float room = star_room(spot, finer, sky_procedural_star_size);
    StarLight stars = star_light(spot, room * room);
    stars_near = stars.near;
    if (finer < 1.0) stars.flux = stars.heat = 0.0;
    return (star_radiance(stars, spot.kernel, shift.x) * (STAR_UNIT * sky_procedural_star_brightness) + galaxy_radiance(direction, sqrt(spot.reach2) / finer)) * shift.y;
}
