"""Where it is measured: cameras and holes, the rays through their pixels, and what is true of those rays."""

from __future__ import annotations

import math
from dataclasses import dataclass
from functools import cached_property

import numpy as np

from .. import listed_rays
from ..listed_rays import TracedRays
from ..physics import lensed_circles, observer, relativity
from ..physics.space_time import is_field, is_inside, ray_model
from ..planning.choice import REFINED_SIZE
from ..scene import Scene, met, presets

ASPECT = REFINED_SIZE[0] / REFINED_SIZE[1]
FULL_HD = 1080
"""Pixels in the height of the picture whose pixels errors are also given in."""

NEAR_CRITICAL = 1e-3
"""Rays within this relative distance ε of the critical curve are counted apart."""

SEED = 20

_FAR = 1e7  # r_s: what stands for infinity where only a finite place has a shadow's angle

# name: (a*, distance in r_s, inclination, angle of view, observer); near and far cameras for each kind of hole, and falling ones inside.
_OWN = {
    "a0_far": (0.0, 50.0, 30.0, 25.0, "static"),
    "a0_near": (0.0, 4.0, 80.0, 90.0, "static"),
    "a0_distant": (0.0, 1000.0, 80.0, 45.0, "static"),
    "a06_far": (0.6, 200.0, 60.0, 6.0, "static"),
    "a095_near": (0.95, 5.0, 75.0, 90.0, "static"),
    "a0998_near": (0.998, 3.0, 60.0, 100.0, "static"),
    "a0_inside": (0.0, 0.12, 80.0, 130.0, "rain"),
    "a09_inside": (0.9, 0.6, 80.0, 130.0, "rain"),
    "a09_deep": (0.9, 0.3, 80.0, 130.0, "rain"),
    "a0998_inside": (0.998, 0.52, 60.0, 130.0, "rain"),
}
SHOWN = ("a0_near", "a06_far", "a095_near", "a0998_near")
"""The scenes of the pictures and of a quick run."""


@dataclass(frozen=True)
class ChartScene:
    """A scene with a name and a fixed sample of rays.

    Attributes:
        count: rays through the centres of random pixels; a tenth as many more lie close to the critical curve.
        whole: whether every sensible method is measured in it, or the best ones only.
    """

    name: str
    scene: Scene
    count: int = 1500
    whole: bool = True

    @property
    def pixel(self) -> float:
        """Angle in radians of one pixel of a picture 1080 pixels high, at its middle."""
        return math.radians(self.scene.camera.fov_deg) / FULL_HD

    @cached_property
    def pixels(self) -> np.ndarray:
        """(count, 2) integers: x and y, from the bottom left, of the pixels of a picture of `REFINED_SIZE` whose rays come first in `rays`."""
        return _pixels(np.random.default_rng(SEED), self.count)

    @cached_property
    def rays(self) -> np.ndarray:
        """(N, 2) as `listed_rays.read` gives them."""
        rng = np.random.default_rng(SEED)
        right, up = (2.0 * (_pixels(rng, self.count) + 0.5) / REFINED_SIZE - 1.0).T
        at_infinity = math.isinf(self.scene.camera.distance)
        half = 0.5 * self.scene.camera.field_m if at_infinity else math.tan(math.radians(0.5 * self.scene.camera.fov_deg))
        radius, chi = self._from_the_hole(half * np.hypot(ASPECT * right, up), np.arctan2(up, ASPECT * right))
        if is_field(self.scene):  # no shadow, and no edge of one
            return np.stack([radius * np.cos(chi), radius * np.sin(chi)] if at_infinity else [radius, chi], axis=-1)
        chi_near = rng.uniform(-np.pi, np.pi, self.count // 10)
        epsilon = 10.0 ** rng.uniform(-6.0, math.log10(NEAR_CRITICAL), len(chi_near)) * rng.choice([-1.0, 1.0], len(chi_near))
        near = critical_radius(self.scene, chi_near) * (1.0 + epsilon)
        if observer.is_moving(self.scene.camera):  # the hole's centre may be seen elsewhere than straight inwards
            near, chi_near = observer.screen_angles(lensed_circles.directions(observer.observe(true_scene(self.scene)), near, chi_near))
        radius, chi = np.append(radius, near), np.append(chi, chi_near)
        return np.stack([radius * np.cos(chi), radius * np.sin(chi)] if at_infinity else [radius, chi], axis=-1)

    def _from_the_hole(self, radius: np.ndarray, chi: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
        """Places on the screen, in polar coordinates from its middle, as angles (ψ, χ) from the hole; in M for a camera at infinity."""
        look = observer.look_rotation(self.scene.camera)
        if math.isinf(self.scene.camera.distance):
            return radius, chi - math.atan2(look[1, 2], look[2, 2])
        psi = np.arctan(radius)
        if np.array_equal(look, np.eye(3)):
            return psi, chi
        return observer.screen_angles(observer.local_directions(psi, chi) @ look.T)

    @cached_property
    def epsilon(self) -> np.ndarray:
        """That of each ray, (N,): see `from_critical`."""
        return from_critical(self.scene, self.rays)

    @cached_property
    def truth(self) -> TracedRays:
        """What the rays really do."""
        return listed_rays.trace_by_reference(true_scene(self.scene), self.rays)


def _pixels(rng: np.random.Generator, count: int) -> np.ndarray:
    return np.stack([rng.uniform(0.0, side, count).astype(int) for side in REFINED_SIZE], axis=-1)


def true_scene(scene: Scene) -> Scene:
    """`scene` traced by the model that is exact for its hole; a field is exact itself."""
    if is_field(scene):
        return scene.with_values({"rays.lensing": True, "rays.orders": 3})
    kerr = scene.hole.spin != 0.0 or is_inside(scene)
    return scene.with_values({"rays.model": "kerr" if kerr else "schwarzschild", "rays.lensing": True, "rays.orders": 3})


def from_critical(scene: Scene, rays: np.ndarray) -> np.ndarray:
    """(N,) relative distance |ε| of `rays` (N, 2) of a scene that `is_physical` from the critical curve; infinite in a field, which has none."""
    if is_field(scene):
        return np.full(len(rays), np.inf)
    if math.isinf(scene.camera.distance):
        radius, chi = np.hypot(*rays.T), np.arctan2(rays[:, 1], rays[:, 0])
    else:
        radius, chi = rays.T
        if observer.is_moving(scene.camera):
            radius, chi = lensed_circles.from_hole(observer.observe(true_scene(scene)), observer.local_directions(radius, chi))
    return np.abs(radius / critical_radius(scene, chi) - 1.0)


def critical_radius(scene: Scene, chi: np.ndarray) -> np.ndarray:
    """The shadow's edge in the screen direction `chi`: ψ in radians, or √(α² + β²) in M for a camera at infinity.

    For one that moves both are about where it sees the hole's centre (`lensed_circles.directions`), and ψ is true within 3e-5 of itself.
    """
    seen = observer.observe(true_scene(scene))
    if observer.is_moving(scene.camera):
        return lensed_circles.shadow_edge(seen, chi)
    distance = min(scene.camera.distance, _FAR)
    kind = "static" if seen.kind == "infinity" else seen.kind
    psi = relativity.shadow_angle(chi, distance, math.radians(scene.camera.inclination_deg), scene.hole.spin, kind)
    return psi if seen.w > 0.0 else 2.0 * _FAR * np.sin(psi) / math.sqrt(1.0 - 1.0 / _FAR)


def is_physical(scene: Scene) -> bool:
    """Whether `scene` shows a hole as it is, or a field: only then is there a truth to compare with."""
    return is_field(scene) or scene.hole.gravity_strength == 1.0 and scene.hole.horizon_size == 1.0


def chart_scenes(quick: bool = False) -> list[ChartScene]:
    """The chart's own scenes, then every shipped physics and scene preset that `is_charted` but those of another's view; a quick run has `SHOWN` alone."""
    kerr = presets.load(["kerr"])
    own = {}
    for name, (spin, distance, inclination, view, seen_by) in _OWN.items():
        camera = {"camera.distance": distance, "camera.inclination_deg": inclination, "camera.fov_deg": view, "camera.observer": seen_by}
        own[name] = kerr.with_values({"hole.spin": spin, **camera})
    if quick:
        return [ChartScene(name, own[name], 400, whole=False) for name in SHOWN]
    shipped = {info.name: presets.load([info.name]) for info in presets.available() if info.group in ("physics", "scene")}
    physical = {name: scene for name, scene in shipped.items() if is_charted(scene)}
    first = {view_of(scene): name for name, scene in reversed(physical.items())}
    physical = {name: scene for name, scene in physical.items() if first[view_of(scene)] == name}
    return [ChartScene(name, scene, whole=name in SHOWN) for name, scene in (own | physical).items()]


def view_of(scene: Scene) -> tuple[object, ...]:
    """All of `scene` that its measurements depend on, beside the method."""
    camera, disk = scene.camera, scene.disk
    view = camera.distance, camera.inclination_deg, camera.fov_deg, camera.field_m, camera.observer
    motion = camera.fall_from, camera.velocity_right, camera.velocity_up, camera.velocity_forward, camera.aberration
    return scene.hole.spin, *view, *motion, disk.enabled, disk.inner_radius, disk.outer_radius, disk.orbit


def is_charted(scene: Scene) -> bool:
    """Whether the chart measures `scene`: a hole as it is, by light as it goes there, and nothing to meet but a disk in its equator, as the reference knows no
    more."""
    plain = met.is_empty(scene) and not scene.disk.tilt_deg and scene.sky.model != "picture"  # which a hole bends as it does any sky
    as_it_is = is_physical(scene) and ray_model(scene).traits.exact and scene.rays.lensing
    return as_it_is and plain and not is_field(scene)
