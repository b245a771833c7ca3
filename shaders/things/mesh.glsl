/*---
label = "Mesh"
summary = "A shape of triangles from a file, at rest or on its way round the hole."
source = "Möller & Trumbore 1997, by signed volumes; Weiskopf, Schafhitzel & Ertl 2004"
slot = "thing"
rank = 2
moves = true
surface = true
meets = "crossing"
tells_apart = true
reach = ["size"]

[parameters.file]
default = "asset:meshes/knot.ply"
suffixes = [".obj", ".gltf", ".glb", ".stl", ".ply"]
help = "OBJ, glTF, GLB, STL or PLY."

[parameters.size]
default = 2.0
range = [0.001, 100.0]
unit = "r_s"
help = "From its middle to its farthest corner."

[parameters.up]
default = "y"
options = ["y", "z"]
help = "Which axis of the file points up."

[parameters.own_colours]
default = true
help = "Whether it has the colours that its file gives its corners, if it gives any."
---*/
#include "common/rotation.glsl"
#include "common/colour.glsl"
#include "common/surface.glsl"
#include "common/box_pairs.glsl"

// mesh_triangles, MESH_TEXELS to each: three corners, their normals, their colours (−1: none); w of the first six: texture coordinates (the first −1e6: none), of the
// others the triangle beyond the side opposite to each corner (−1: none).

// What a piece meets first of a mesh.
struct MeshSpot {
    float part;    // of the piece; 2: nothing
    int triangle;
    vec3 shares;   // of its corners
    bool enters;
};

// The nearest texel: docs/llvmpipe.md, texels.
vec4 mesh_texel(int triangle, int place) {
    vec2 texel = vec2(float(MESH_TEXELS * (triangle % MESH_ROW) + place), float(triangle / MESH_ROW)) + 0.5;
    return textureLod(mesh_triangles, texel / vec2(textureSize(mesh_triangles, 0)), 0.0);
}

const float BEND_PARTS = 16.0;  // straight ones of a way that bends

// Neighbours share what decides about their common edge, so that nothing slips through between them: on which side of each edge that straight part of the way leads
// which lies beside its middle.
void meet_triangle(int triangle, vec3 x, vec3 way, vec3 bow, inout MeshSpot found) {
    vec3 a = mesh_texel(triangle, 0).xyz - x, b = mesh_texel(triangle, 1).xyz - x, c = mesh_texel(triangle, 2).xyz - x;
    vec3 beside_a = cross(c, b), beside_b = cross(a, c), beside_c = cross(b, a), turned = cross(bow, way);
    vec3 volumes = vec3(dot(way, beside_a), dot(way, beside_b), dot(way, beside_c));
    vec3 along = vec3(dot(a, way), dot(b, way), dot(c, way)) / max(dot(way, way), 1e-30), aside = vec3(dot(a, turned), dot(b, turned), dot(c, turned));
    vec3 parts = (floor(clamp(0.5 * BEND_PARTS * (along.yzx + along.zxy), 0.0, BEND_PARTS - 1.0)) + 0.5) / BEND_PARTS;
    volumes += (4.0 - 8.0 * parts) * vec3(dot(bow, beside_a), dot(bow, beside_b), dot(bow, beside_c)) + 4.0 * parts * parts * (aside.yzx - aside.zxy);
    float whole = volumes.x + volumes.y + volumes.z;
    bool inside = min(volumes.x, min(volumes.y, volumes.z)) >= 0.0 || max(volumes.x, max(volumes.y, volumes.z)) <= 0.0;
    vec3 shares = volumes / (whole == 0.0 ? 1.0 : whole);
    float part = dot(shares.x * a + shares.y * b + shares.z * c, way) / max(dot(way, way), 1e-30);
    if (inside && whole != 0.0 && part >= 0.0 && part <= 1.0 && part < found.part) found = MeshSpot(part, triangle, shares, whole > 0.0);
}

// The first triangle of the mesh with that `root` (common/box_pairs.glsl) on a way from x to y, in its own axes, that bends by `bow` from the piece between them
// (common/curve.glsl); of a way that strays from there by a `pad` that is more than 0, the first that it may come to, as if that were met where the piece begins.
MeshSpot meet_mesh(int root, vec3 x, vec3 y, vec3 bow, float pad) {
    MeshSpot found = MeshSpot(2.0, -1, vec3(1.0, 0.0, 0.0), true);
    PairWalk walk = pair_walk(mesh_nodes, root, piece_of(PAIR_LATTICE, x, y, bow, pad));
    if (walk.node > 0) do {
        walk_on(mesh_nodes, min(found.part, 1.0), walk);
        int run = walk.first, after = walk.second;
        bool comes = run >= 0, left = comes && pad <= 0.0;
        if (left) do {
            meet_triangle(walk.triangles + (run >> 2), x, y - x, bow, found);
            bool within = (run & 3) > 0;
            left = within || after >= 0;
            run = within ? run + 3 : after;
            after = within ? after : -1;
        } while (left);
        if (comes && pad > 0.0) {
            found.part = 0.0;
            walk.node = 0;
        }
    } while (walk.node > 0);
    return found;
}

#if MEETINGS == 1
const int MOST_NEIGHBOURS = 8;

// Where the line from x along `way` meets the mesh, going in or out as it `enters`: looked for from a triangle near by, from neighbour to neighbour. Places that are
// interpolated in motion may lie `beside` the outline: then the nearest on the last triangle that is seen from there.
MeshSpot spot_near(int triangle, vec3 x, vec3 way, bool enters, out bool beside) {
    MeshSpot spot = MeshSpot(0.0, triangle, vec3(1.0), enters);
    bool done;
    int gone = 0, here = triangle;
    do {
        vec3 a = mesh_texel(here, 0).xyz - x, b = mesh_texel(here, 1).xyz - x, c = mesh_texel(here, 2).xyz - x;
        vec3 volumes = (enters ? 1.0 : -1.0) * vec3(dot(way, cross(c, b)), dot(way, cross(a, c)), dot(way, cross(b, a)));
        float whole = volumes.x + volumes.y + volumes.z, least = min(volumes.x, min(volumes.y, volumes.z));
        int next = int(mesh_texel(here, volumes.x == least ? 6 : volumes.y == least ? 7 : 8).w);
        if (whole > 0.0) spot = MeshSpot(0.0, here, volumes / whole, enters);
        done = whole <= 0.0 || least >= 0.0 || next < 0;
        here = done ? here : next;
    } while (!done && ++gone < MOST_NEIGHBOURS);
    beside = min(spot.shares.x, min(spot.shares.y, spot.shares.z)) < 0.0;
    spot.shares = max(spot.shares, 0.0);
    spot.shares /= spot.shares.x + spot.shares.y + spot.shares.z;
    return spot;
}
#endif

// A vector in the axes of the mesh, and one of theirs in the world.
vec3 to_mesh(int i, vec3 v) {
    vec3 own = unturned(thing_mesh_attitude(i), v);
    return thing_mesh_up(i) == 0 ? vec3(own.x, own.z, -own.y) : own;
}

vec3 from_mesh(int i, vec3 v) {
    vec4 attitude = thing_mesh_attitude(i);
    return unturned(vec4(-attitude.xyz, attitude.w), thing_mesh_up(i) == 0 ? vec3(v.x, -v.z, v.y) : v);
}

float thing_mesh_crossing(int i, vec3 x, vec3 y, vec3 bow, float stray, out bool enters, out int part) {
    vec4 bound = thing_mesh_bound(i);
    vec3 from = to_mesh(i, x - bound.xyz) / bound.w, way = to_mesh(i, y - x) / bound.w, bent = to_mesh(i, bow) / bound.w;
    // The part within a little more than the unit ball: single precision is for that.
    float pad = stray / bound.w, within = 1.025 + 2.0 * pad + 0.5 * length(bent);
    float way2 = max(dot(way, way), 1e-30), nearest = -dot(from + 0.5 * bent, way) / way2;
    vec3 aside = from + 0.5 * bent + nearest * way;
    float half_chord = sqrt(max(within * within - dot(aside, aside), 0.0) / way2);
    float begin = max(nearest - half_chord, 0.0), end = min(nearest + half_chord, 1.0);
    vec3 near = aside + (begin - nearest) * way + (4.0 * begin * (1.0 - begin) - 0.5) * bent;
    vec3 far = aside + (end - nearest) * way + (4.0 * end * (1.0 - end) - 0.5) * bent;
    MeshSpot found = meet_mesh(end > begin ? thing_mesh_file(i) : 0, near, far, (end - begin) * (end - begin) * bent, pad);
    enters = found.enters;
    part = max(found.triangle, 0);
    return found.part <= 1.0 ? mix(begin, end, found.part) : 2.0;
}

float thing_mesh_grain(int i) {
    return thing_mesh_bound(i).w * intBitsToFloat(pair_texel(mesh_nodes, 1.0 / vec2(textureSize(mesh_nodes, 0)), thing_mesh_file(i) >> 5).x);
}

vec3 thing_mesh_facing(int i, int part) {
    vec3 a = mesh_texel(part, 0).xyz;
    return normalize(from_mesh(i, cross(mesh_texel(part, 1).xyz - a, mesh_texel(part, 2).xyz - a)));
}

// The change of texture coordinates along `change`, on a triangle with the sides a, b, along which they change by at_a, at_b.
vec2 change_on(vec3 a, vec3 b, vec2 at_a, vec2 at_b, vec3 change) {
    float aa = dot(a, a), ab = dot(a, b), bb = dot(b, b), whole = max(aa * bb - ab * ab, 1e-30);
    float ca = dot(a, change), cb = dot(b, change);
    return ((bb * ca - ab * cb) * at_a + (aa * cb - ab * ca) * at_b) / whole;
}

Light thing_mesh_light(int i, Sight sight) {
    vec4 bound = thing_mesh_bound(i);
    vec3 arm = sight.place - bound.xyz;
    vec3 at = to_mesh(i, arm) / bound.w, towards = to_mesh(i, sight.towards);
#if MEETINGS == 1
    bool beside;
    MeshSpot spot = spot_near(max(sight.part, 0), at, -towards, sight.enters, beside);
#else
    const float BESIDE = 0.01;  // of its size, along the ray: where the surface is, to what a place is told
    const bool beside = false;
    MeshSpot spot = meet_mesh(thing_mesh_file(i), at + BESIDE * towards, at - BESIDE * towards, vec3(0.0), 0.0);
#endif
    int triangle = max(spot.triangle, 0);
    vec4 texels[6];
    for (int k = 0; k < 6; ++k) texels[k] = mesh_texel(triangle, k);
    mat3 colours = mat3(mesh_texel(triangle, 6).xyz, mesh_texel(triangle, 7).xyz, mesh_texel(triangle, 8).xyz);
    vec3 normal = mat3(texels[3].xyz, texels[4].xyz, texels[5].xyz) * spot.shares;
    bool outside = beside ? dot(normal, towards) >= 0.0 : spot.enters;
    normal = normalize(outside ? normal : -normal);
    vec2 first = vec2(texels[0].w, texels[1].w), second = vec2(texels[2].w, texels[3].w), third = vec2(texels[4].w, texels[5].w);
    vec3 a = texels[1].xyz - texels[0].xyz, b = texels[2].xyz - texels[0].xyz;
    Painted painted = Painted(
        mat3x2(first, second, third) * spot.shares,
        change_on(a, b, second - first, third - first, to_mesh(i, sight.right) / bound.w),
        change_on(a, b, second - first, third - first, to_mesh(i, sight.up) / bound.w), 0.0);
    vec4 attitude = thing_mesh_attitude(i);
    if (first.x < -1e5) painted = globe_place(unturned(attitude, arm), unturned(attitude, sight.right), unturned(attitude, sight.up));
    Finish finish = thing_mesh_finish(i);
    if (thing_mesh_own_colours(i) && colours[0].x >= 0.0) finish.colour = colours * spot.shares;
    vec3 velocity = thing_mesh_velocity(i).xyz + cross(thing_mesh_spin(i).xyz, arm);
    return Light(surface_radiance(finish, painted, sight, from_mesh(i, normal), velocity), vec3(0.0));
}
