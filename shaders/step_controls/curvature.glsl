/*---
label = "Curvature"
summary = "The model's plain step, shrunk where orbits bend hard, near the photon sphere and near the disk's plane."
source = "an orbital-plane renderer (docs/sources.md)"
slot = "step_control"
rank = 4
shortest = 0.4  # of the plain step, on a ray's whole way
fits = ["cartesian", "mino"]

[parameters.bend]
default = 1.0
range = [0.0, 10.0]
unit = "×"
help = "How much shorter steps are where the relativistic part of the orbit equation, (3/2)u² against u, is large."
[parameters.photon_sphere]
default = 1.0
range = [0.0, 10.0]
unit = "×"
help = "How much shorter steps are within half a Schwarzschild radius of r = 3/2."
[parameters.disk_plane]
default = 0.5
range = [0.0, 10.0]
unit = "×"
help = "How much shorter steps are within a tenth of a radian of the disk's plane."
---*/

// 1 at 0, falling off over a distance of 1.
float step_nearness(float x) {
    return 1.0 / (1.0 + x * x);
}

float step_size(Orbit orbit, State s) {
    float r = ray_radius(s);
    float crowding = 1.5 * rays_curvature_bend / max(r, 0.5) + rays_curvature_photon_sphere * step_nearness(2.0 * (r - 1.5));
#if ORDERS > 0
    crowding += rays_curvature_disk_plane * step_nearness(10.0 * ray_elevation(s));
#endif
    return ray_plain_step(orbit, s) / (1.0 + crowding);
}
