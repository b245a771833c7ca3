/*---
label = "The real sky"
summary = "118,000 measured stars with their colours, fainter ones by their law, and a galaxy band where the Milky Way is."
source = "van Leeuwen 2007 (Hipparcos, the new reduction); temperatures by Ballesteros 2012; the band's clouds are invented"
slot = "sky"
rank = 20
stars = 15

[parameters.star_brightness]
default = 1.0
range = [0.0, 20.0]
unit = "×"
help = "Brightness of the stars."

[parameters.galaxy_brightness]
default = 0.5
range = [0.0, 20.0]
unit = "×"
help = "Brightness of the Milky Way."

[parameters.star_size]
default = 0.00025
range = [0.0, 0.01]
unit = "rad"
help = "Angular radius of a star where pixels are smaller than that: under high magnification stars become arcs of bounded brightness."

[parameters.constellations]
default = false
help = "Lines of the constellations' figures over it, bent as its light is."

[parameters.line_brightness]
default = 1.0
range = [0.0, 20.0]
unit = "×"
help = "Of these lines."

[parameters.yaw_deg]
default = 0.0
range = [-360.0, 360.0]
unit = "°"
help = "Turn of the sky about the hole's axis. At 0, with no pitch and no roll, right ascension is the azimuth and the celestial north pole is on the axis."

[parameters.pitch_deg]
default = 0.0
range = [-90.0, 90.0]
unit = "°"
help = "How far the vernal equinox is lifted above the equatorial plane."

[parameters.roll_deg]
default = 0.0
range = [-180.0, 180.0]
unit = "°"
help = "Turn of the sky about the vernal equinox, before the others."

[parameters.frequency_shift]
default = true
help = "Shift the sky's colour and brightness (as the fourth power) by the observer's place and motion."

[tables.catalogue_cells]
make = "blackhole_gl.rendering.star_index:cells"
constants = "blackhole_gl.rendering.star_index:CONSTANTS"

[tables.catalogue_entries]
make = "blackhole_gl.rendering.star_index:entries"

[tables.catalogue_haze]
make = "blackhole_gl.rendering.star_index:haze"
filter = "mipmap"

[tables.constellation_cells]
make = "blackhole_gl.rendering.constellations:cells"
constants = "blackhole_gl.rendering.constellations:CONSTANTS"

[tables.constellation_lines]
make = "blackhole_gl.rendering.constellations:lines"

[numbers.catalogue_attitude]
make = "blackhole_gl.rendering.sky_attitude:attitude"
of = ["sky.catalogue.yaw_deg", "sky.catalogue.pitch_deg", "sky.catalogue.roll_deg"]
type = "vec4"
---*/
#include "common/rotation.glsl"
#include "common/sky_cube.glsl"
#include "common/star_light.glsl"

// One look-up tells where a pixel's cell has its list of stars, in the grid for footprints of its size; all stars whose kernels reach the pixel are in it. As
// the footprint grows towards the next grid's, the stars which that one does not list fade into a haze, whose levels are made for this
// (blackhole_gl/rendering/star_index.py): no light is lost or counted twice.

uniform sampler2D catalogue_cells;   // these two are nearest: docs/llvmpipe.md, texels
uniform sampler2D catalogue_entries;
uniform sampler2D catalogue_haze;    // the galaxy's radiance, 0…1, and the haze in stars of Hp = 0 a steradian

const float CATALOGUE_REACH = 0.003;      // rad, of kernels in the finest grid
const float CATALOGUE_STAR = 1.2e-4;      // radiance × sr of a star of Hp = 0
const float CATALOGUE_GALAXY = 0.06;      // radiance of its brightest part

// Of such powers the one whose sum over a grid of pixels changes least as the star moves: by 0.6 %.
float sky_kernel(float away2) {
    float fall = max(1.0 - away2, 0.0), square = fall * fall;
    return 1.25 * square * square;
}

// The stars of a cell.
struct StarList {
    float first, end;  // entries
    float grid;
    float fading;      // how much of those is left that the next grid does not list
};

struct SkyStars {
    int count;
    StarList list;
};

// How much wider than the finest grid's a kernel is, in octaves. In a picture that is shown enlarged six times as wide a one counts: some 1,000 stars of a
// whole picture are then drawn apart and not 20,000, and all that may lie in a coarse pixel are listed.
float catalogue_level(SkySpot spot, float finer) {
    float wider = finer < 1.0 ? 6.0 : 1.0;
    return 0.5 * log2(max(spot.reach2, 1e-14) * wider * wider * (4.0 / (CATALOGUE_REACH * CATALOGUE_REACH)));
}

float list_fading(float grid, float level) {
    return clamp(1.0 + grid - level, 0.0, 1.0);
}

StarList star_list(SkyPlace at, float level) {
    float grid = clamp(floor(level), 0.0, float(CATALOGUE_LEVELS - 1));
    float cells = float(CATALOGUE_CELLS >> int(grid));
    vec2 cell = min(at.place * (0.5 * cells) + 0.5 * cells, cells - 0.5) + vec2(at.face * cells, 2.0 * (float(CATALOGUE_CELLS) - cells));
    float number = textureLod(catalogue_cells, cell / vec2(textureSize(catalogue_cells, 0)), 0.0).x;
    float first = floor(number * 0.0625);
    return StarList(first, first + number - 16.0 * first, grid, list_fading(grid, level));
}

vec4 list_entry(float entry, vec2 texel) {
    float row = floor(entry * (1.0 / float(CATALOGUE_ROW)));
    return textureLod(catalogue_entries, (vec2(entry - row * float(CATALOGUE_ROW), row) + 0.5) * texel, 0.0);
}

float star_flux(vec4 entry, StarList list) {
    return entry.w < 0.0 ? -entry.w * list.fading : entry.w;
}

// `room`: square of a distance, in half kernels.
StarLight star_light(SkySpot spot, StarList list, float room) {
    StarLight stars = StarLight(0.0, 0.0, 0.0, 0.0);
    vec2 texel = 1.0 / vec2(textureSize(catalogue_entries, 0));
    float entry = list.first;
    do {
        vec4 star = list_entry(entry, texel);
        vec2 d = vec2(dot(star.xyz, spot.across), dot(star.xyz, spot.along));
        float away2 = dot(d, d);
        float single = entry < list.end ? star_flux(star, list) : 0.0;
        float flux = single * sky_kernel(away2);
        stars.flux += flux;
        stars.heat += flux * star_kelvin(star.w);
        stars.near += single * (room - away2) > 0.0 ? 1.0 : 0.0;
        entry += 1.0;
    } while (entry < list.end);
    return stars;
}

// The galaxy's radiance, and the haze of stars in stars of Hp = 0 a steradian.
vec4 galaxy_and_haze(SkyPlace at, float level) {
    float axis = floor(0.5 * at.face);
    vec2 tile = vec2(axis, at.face - 2.0 * axis) + 0.5 + 0.4375 * at.place;
    vec4 light = textureLod(catalogue_haze, tile * vec2(1.0 / 3.0, 0.5), clamp(level, 0.0, float(CATALOGUE_LEVELS)));
    return light * vec4(vec3(CATALOGUE_GALAXY * sky_catalogue_galaxy_brightness), 1.0);
}

#if SKY_CATALOGUE_CONSTELLATIONS
uniform sampler2D constellation_cells, constellation_lines; // blackhole_gl/rendering/constellations.py

const vec3 CONSTELLATION_COLOUR = vec3(0.03, 0.05, 0.09);
const float CONSTELLATION_REACH = 0.012; // rad beside a line, in which it is listed: wider pixels show none

// How much of the pixel a line covers, 1.1 pixels wide however the lens draws it out. `right` and `up` as `centre` in the sky's own axes.
float constellation_line(SkyPlace at, vec3 centre, vec3 right, vec3 up) {
    float cells = float(CONSTELLATION_CELLS);
    vec2 cell = min(at.place * (0.5 * cells) + 0.5 * cells, cells - 0.5) + vec2(at.face * cells, 0.0);
    float number = textureLod(constellation_cells, cell / vec2(textureSize(constellation_cells, 0)), 0.0).x;
    float line = floor(number * 0.0625), end = line + number - 16.0 * line;
    float row = 1.0 / float(textureSize(constellation_lines, 0).y);
    float cover = 0.0;
    do {
        float y = (line + 0.5) * row;
        vec3 pole = textureLod(constellation_lines, vec2(0.25, y), 0.0).xyz;
        vec4 middle = textureLod(constellation_lines, vec2(0.75, y), 0.0);
        vec2 slope = vec2(dot(pole, right), dot(pole, up));
        float width = sqrt(max(dot(slope, slope), 1e-16)), away = abs(dot(pole, centre)) / width;
        bool on = line < end && dot(middle.xyz, centre) > middle.w;
        float seen = clamp(2.0 - width * (2.0 / CONSTELLATION_REACH), 0.0, 1.0);
        cover = max(cover, on ? seen * clamp(1.1 - away, 0.0, 1.0) : 0.0);
        line += 1.0;
    } while (line < end);
    return cover;
}
#endif

// The observer's shift in colour, and as a factor of the light.
vec2 sky_shift(float energy) {
#if !SKY_CATALOGUE_FREQUENCY_SHIFT
    energy = 1.0;
#endif
    float boost = energy * energy;
    return vec2(energy, boost * boost);
}

SkyStars sky_stars(vec3 direction, vec3 right, vec3 up, float finer) {
    SkySpot spot = sky_spot(direction, right, up, sky_catalogue_star_size);
    StarList list = star_list(sky_place(unturned(catalogue_attitude, direction)), catalogue_level(spot, finer));
    return SkyStars(int(list.end - list.first), list);
}

SkyStars sky_stars_at(SkyStars stars, vec3 direction, vec3 right, vec3 up, float finer) {
    stars.list.fading = list_fading(stars.list.grid, catalogue_level(sky_spot(direction, right, up, sky_catalogue_star_size), finer));
    return stars;
}

vec3 sky_star(SkyStars stars, int n, float energy, out vec4 star) {
    vec2 shift = sky_shift(energy);
    star = list_entry(stars.list.first + float(n), 1.0 / vec2(textureSize(catalogue_entries, 0)));
    float flux = star_flux(star, stars.list);
    vec3 light = blackbody_colour(star_kelvin(star.w) * shift.x) * (flux * CATALOGUE_STAR * sky_catalogue_star_brightness * shift.y);
    vec4 back = vec4(-catalogue_attitude.xyz, catalogue_attitude.w);
    star = vec4(unturned(back, star.xyz), max(sky_catalogue_star_size, 3.2e-7)); // as in sky_spot
    return light;
}

vec3 sky_radiance(vec3 direction, vec3 right, vec3 up, float energy, float finer, out float stars_near) {
    vec2 shift = sky_shift(energy);
    vec4 attitude = catalogue_attitude;
    vec3 across = unturned(attitude, right), along = unturned(attitude, up);
    SkySpot spot = sky_spot(unturned(attitude, direction), finer * across, finer * along, sky_catalogue_star_size);
    float level = catalogue_level(spot, finer);
    SkyPlace at = sky_place(spot.centre);
    float room = star_room(spot, finer, sky_catalogue_star_size);
    StarLight stars = star_light(spot, star_list(at, level), room * room);
    stars_near = stars.near;
    if (finer < 1.0) stars.flux = stars.heat = 0.0;
    vec4 behind = galaxy_and_haze(at, level);
    stars.haze = behind.a;
#if SKY_CATALOGUE_CONSTELLATIONS
    behind.rgb += constellation_line(at, spot.centre, across, along) * sky_catalogue_line_brightness * CONSTELLATION_COLOUR;
#endif
    return (star_radiance(stars, spot.kernel, shift.x) * (CATALOGUE_STAR * sky_catalogue_star_brightness) + behind.rgb) * shift.y;
}
