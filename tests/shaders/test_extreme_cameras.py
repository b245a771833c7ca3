"""Cameras at the ends of what a scene allows, and pictures of odd sizes."""

from __future__ import annotations

from itertools import product

import numpy as np
import pytest

from blackhole_gl.rendering.frame import Renderer
from blackhole_gl.scene import presets

CAMERAS = {
    "just outside the horizon": {"hole.spin": 0.0, "camera.distance": 1.0001, "camera.fov_deg": 150.0},
    "just outside a spinning horizon": {"hole.spin": 0.998, "camera.distance": 0.55, "camera.fov_deg": 150.0},
    "in the ergosphere, static asked": {"hole.spin": 0.9, "camera.distance": 0.8, "camera.inclination_deg": 90.0, "camera.fov_deg": 120.0},
    "on the north pole": {"hole.spin": 0.9, "camera.inclination_deg": 0.0},
    "on the south pole": {"hole.spin": 0.9, "camera.inclination_deg": 180.0},
    "in the plane": {"hole.spin": 0.9, "camera.inclination_deg": 90.0},
    "a hair off the plane": {"hole.spin": 0.9, "camera.inclination_deg": 89.99},
    "a hair off the axis": {"hole.spin": -0.9999, "camera.inclination_deg": 0.01},
    "at 10⁴": {"hole.spin": 0.9, "camera.distance": 1e4, "camera.fov_deg": 1.0},
    "at infinity": {"hole.spin": 0.9, "camera.distance": float("inf")},
    "at infinity on the axis": {"hole.spin": 0.9, "camera.distance": float("inf"), "camera.inclination_deg": 0.0},
    "at infinity in the plane": {"hole.spin": 0.9, "camera.distance": float("inf"), "camera.inclination_deg": 90.0},
    "spin at its limit": {"hole.spin": 0.9999, "camera.inclination_deg": 85.0},
    "inside the photon sphere": {"hole.spin": 0.0, "camera.distance": 1.3, "camera.fov_deg": 150.0},
}


def outside_the_horizon(camera: str, model: str) -> bool:
    """The others are the subject of test_a_camera_inside_the_horizon_is_refused."""
    return model not in ("schwarzschild", "kerr_like") or CAMERAS[camera].get("camera.distance", 20.0) > 1.0


@pytest.mark.parametrize("camera, model", [pair for pair in product(CAMERAS, ("kerr", "schwarzschild", "kerr_like", "flat")) if outside_the_horizon(*pair)])
def test_every_ray_has_a_fate(renderer: Renderer, camera: str, model: str) -> None:
    changes = {"rays.model": model, **CAMERAS[camera]}
    scene = presets.load(["kerr"], changes)
    renderer.render(scene, 1.0, (48, 27))
    hits = renderer.hits()
    assert np.count_nonzero(hits.fate == 0) == 0
    assert np.all(np.isfinite(hits.direction)) and np.all(np.isfinite(hits.crossing))
    assert np.all(np.isfinite(renderer.radiance()))


@pytest.mark.parametrize("model, spin, distance", [("kerr", 0.0, 0.99), ("kerr", 0.998, 0.53), ("schwarzschild", 0.9, 0.99), ("kerr_like", 0.9, 0.99)])
def test_a_camera_inside_the_horizon_is_refused(renderer: Renderer, model: str, spin: float, distance: float) -> None:
    with pytest.raises(ValueError, match="camera.distance.*horizon"):
        renderer.render(presets.load(["kerr"], {"rays.model": model, "hole.spin": spin, "camera.distance": distance}), 0.0, (8, 8))


@pytest.mark.parametrize("model", ["kerr", "schwarzschild"])
def test_hardly_any_light_leaves_just_outside_the_horizon(renderer: Renderer, model: str) -> None:
    """At 1.0001 r_s all but 1.5° about the outward direction is black, for every step that a preset may ask for."""
    for quality in ("blackholegpu_low", "blackholegpu_medium", "reference"):
        scene = presets.load(["kerr", quality], {"rays.model": model, "hole.spin": 0.0, "camera.distance": 1.0001, "camera.fov_deg": 150.0})
        renderer.render(scene, 0.0, (48, 27))
        assert np.all(renderer.hits().fate == 2)


@pytest.mark.parametrize("size", [(1, 1), (3, 5), (1, 40), (40, 1), (2, 2), (33, 17)])
def test_odd_sizes(renderer: Renderer, size: tuple[int, int]) -> None:
    renderer.render(presets.load(["kerr"]), 0.0, size)
    assert renderer.read_rgb8().shape == (size[1], size[0], 3)
    assert renderer.hits().fate.shape == (size[1], size[0])
    assert np.count_nonzero(renderer.hits().fate == 0) == 0
    assert np.all(np.isfinite(renderer.radiance()))


def test_a_picture_of_one_pixel_looks_at_the_hole(renderer: Renderer) -> None:
    renderer.render(presets.load(["schwarzschild"], {"disk.enabled": False}), 0.0, (1, 1))
    assert renderer.hits().fate[0, 0] == 2


@pytest.mark.parametrize("inclination", [60.0, 80.0, 89.0])
def test_from_afar_a_disk_is_no_brighter(renderer: Renderer, inclination: float) -> None:
    """Radiance does not grow with distance. Pixels on the far plane's horizon, thousands of r_s wide, once took the g-factor of impossible light."""

    def brightest(distance: float) -> float:
        scene = presets.load(["kerr"], {"camera.distance": distance, "camera.inclination_deg": inclination, "sky.enabled": False})
        renderer.render(scene, 0.0, (320, 180))
        return float(renderer.radiance().max())

    near = brightest(20.0)
    assert all(brightest(distance) <= near for distance in (300.0, 1000.0, 1e4))
