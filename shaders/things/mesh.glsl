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
#include "common/hierarchy.glsl"

// mesh_triangles, MESH_TEXELS to each: three corners, their normals, their colours (−1: none); w of the first six: texture coordinates (the first −1e6: none).
// A leaf of mesh_nodes holds 4·(number of its first triangle) + how many follow.

// What a piece meets first of a mesh.
struct MeshSpot {
    float part;    // of the piece; 2: nothing
    int triangle;
    vec3 shares;   // of its corners
    bool enters;
};

vec4 mesh_texel(int triangle, int place) {
    return texelFetch(mesh_triangles, ivec2(MESH_TEXELS * (triangle % MESH_ROW) + place, triangle / MESH_ROW), 0);
}

// Neighbours share what decides about their common edge, so that nothing slips through between them.
void meet_triangle(int triangle, vec3 x, vec3 way, inout MeshSpot found) {
    vec3 a = mesh_texel(triangle, 0).xyz - x, b = mesh_texel(triangle, 1).xyz - x, c = mesh_texel(triangle, 2).xyz - x;
    vec3 volumes = vec3(dot(way, cross(c, b)), dot(way, cross(a, c)), dot(way, cross(b, a)));
    float whole = volumes.x + volumes.y + volumes.z;
    bool inside = min(volumes.x, min(volumes.y, volumes.z)) >= 0.0 || max(volumes.x, max(volumes.y, volumes.z)) <= 0.0;
    vec3 shares = volumes / (whole == 0.0 ? 1.0 : whole);
    float part = dot(shares.x * a + shares.y * b + shares.z * c, way) / max(dot(way, way), 1e-30);
    if (inside && whole != 0.0 && part >= 0.0 && part <= 1.0 && part < found.part) found = MeshSpot(part, triangle, shares, whole > 0.0);
}

// The first triangle of the mesh with the first node `root` on the piece from x to y, both in its own axes.
MeshSpot meet_mesh(int root, vec3 x, vec3 y) {
    MeshSpot found = MeshSpot(2.0, -1, vec3(1.0, 0.0, 0.0), true);
    Piece piece = piece_of(mesh_nodes, x, y, 0.0);
    int number = root;
    while (number > 0) {
        Node leaf;
        number = next_leaf(mesh_nodes, piece, number, min(found.part, 1.0), false, leaf);
        if (number > 0) {
            int first = held(leaf) >> 2, last = first + (held(leaf) & 3);
            for (int triangle = first; triangle <= last; ++triangle) meet_triangle(triangle, x, y - x, found);
            number = next_node(leaf, number, true);
        }
    }
    return found;
}

// A vector in the axes of the mesh, and one of theirs in the world.
vec3 to_mesh(int i, vec3 v) {
    vec3 own = unturned(thing_mesh_attitude(i), v);
    return thing_mesh_up(i) == 0 ? vec3(own.x, own.z, -own.y) : own;
}

vec3 from_mesh(int i, vec3 v) {
    vec4 attitude = thing_mesh_attitude(i);
    return unturned(vec4(-attitude.xyz, attitude.w), thing_mesh_up(i) == 0 ? vec3(v.x, -v.z, v.y) : v);
}

float thing_mesh_crossing(int i, vec3 x, vec3 y, out bool enters) {
    vec4 bound = thing_mesh_bound(i);
    vec3 from = to_mesh(i, x - bound.xyz) / bound.w, way = to_mesh(i, y - x) / bound.w;
    // The part within a little more than the unit ball: single precision is for that.
    float way2 = max(dot(way, way), 1e-30), nearest = -dot(from, way) / way2;
    vec3 aside = from + nearest * way;
    float half_chord = sqrt(max(1.05 - dot(aside, aside), 0.0) / way2);
    float begin = max(nearest - half_chord, 0.0), end = min(nearest + half_chord, 1.0);
    vec3 near = aside + (begin - nearest) * way, far = aside + (end - nearest) * way;
    MeshSpot found = meet_mesh(end > begin ? thing_mesh_file(i) : 0, near, far);
    enters = found.enters;
    return found.part <= 1.0 ? mix(begin, end, found.part) : 2.0;
}

bool thing_mesh_apart(int i, vec3 x, vec3 y, float stray) {
    vec4 bound = thing_mesh_bound(i);
    Piece piece = piece_of(mesh_nodes, to_mesh(i, x - bound.xyz) / bound.w, to_mesh(i, y - bound.xyz) / bound.w, stray / bound.w);
    Node leaf;
    return next_leaf(mesh_nodes, piece, thing_mesh_file(i), 1.0, false, leaf) == 0;
}

// The change of texture coordinates along `change`, on a triangle with the sides a, b, along which they change by at_a, at_b.
vec2 change_on(vec3 a, vec3 b, vec2 at_a, vec2 at_b, vec3 change) {
    float aa = dot(a, a), ab = dot(a, b), bb = dot(b, b), whole = max(aa * bb - ab * ab, 1e-30);
    float ca = dot(a, change), cb = dot(b, change);
    return ((bb * ca - ab * cb) * at_a + (aa * cb - ab * ca) * at_b) / whole;
}

Light thing_mesh_light(int i, Sight sight) {
    const float BESIDE = 0.01;  // of its size, along the ray: where the surface is, to what a place is told
    vec4 bound = thing_mesh_bound(i);
    vec3 arm = sight.place - bound.xyz;
    vec3 at = to_mesh(i, arm) / bound.w, towards = to_mesh(i, sight.towards);
    MeshSpot spot = meet_mesh(thing_mesh_file(i), at + BESIDE * towards, at - BESIDE * towards);
    // Places that are interpolated in motion may lie a little beside an outline: then it is what lies across the ray, seen from the side that faces it.
    bool is_beside = spot.triangle < 0;
    vec3 right = normalize(abs(towards.z) < 0.9 ? vec3(towards.y, -towards.x, 0.0) : vec3(0.0, towards.z, -towards.y)), up = cross(towards, right);
    for (int k = 0; k < 2; ++k) {
        vec3 aside = 2.0 * BESIDE * (k == 0 ? right : up);
        MeshSpot found = meet_mesh(spot.triangle < 0 ? thing_mesh_file(i) : 0, at + aside, at - aside);
        if (spot.triangle < 0) spot = found;
    }
    int triangle = max(spot.triangle, 0);
    vec4 texels[6];
    for (int k = 0; k < 6; ++k) texels[k] = mesh_texel(triangle, k);
    mat3 colours = mat3(mesh_texel(triangle, 6).xyz, mesh_texel(triangle, 7).xyz, mesh_texel(triangle, 8).xyz);
    vec3 normal = mat3(texels[3].xyz, texels[4].xyz, texels[5].xyz) * spot.shares;
    bool outside = is_beside ? dot(normal, towards) >= 0.0 : spot.enters;
    normal = spot.triangle < 0 ? towards : normalize(outside ? normal : -normal);
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
