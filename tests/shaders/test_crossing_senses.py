"""Which way the light runs at each crossing of the disk's plane: of pictures' own rays against the float64 twin, and where hits are interpolated."""

from __future__ import annotations

import math

import numpy as np
import pytest

from blackhole_gl import listed_rays
from blackhole_gl.physics import observer
from blackhole_gl.planning import choice
from blackhole_gl.rendering.frame import Renderer
from blackhole_gl.rendering.recording import pixel_direction
from blackhole_gl.scene import Scene, presets
from tests.sampled import sampled

WIDTH, HEIGHT = 60, 34
# k_r vanishes at a ray's turning point: where it is this small in units of E, rounding of float32 decides on its sign.
STEEP = 3e-3


def _rays(scene: Scene) -> np.ndarray:
    """(ψ, χ), or (α, β), of every pixel, row by row from the bottom."""
    seen = observer.observe(scene)
    places = [(x + 0.5, y + 0.5) for y in range(HEIGHT) for x in range(WIDTH)]
    local = np.array([seen.look @ pixel_direction(scene, (WIDTH, HEIGHT), place) for place in places])
    if math.isinf(scene.camera.distance):
        return np.stack([local[:, 2], -local[:, 1]], axis=-1)
    return np.stack(observer.screen_angles(local), axis=-1)


MODELS = [("kerr", 0.9), ("kerr_schild", -0.7), ("schwarzschild", 0.0), ("schwarzschild_binet", 0.0), ("schwarzschild_table", 0.0)]


FAR, NEAR = (10.0, 80.0), (2.5, 60.0)
DEAR = [("kerr", 0.9, *NEAR), ("schwarzschild_binet", 0.0, *FAR)]  # their twins take seconds
CASES = [(*model, *camera) for model in MODELS for camera in (FAR, NEAR)]


@pytest.mark.parametrize("model, spin, distance, inclination", sampled(CASES, [case for case in CASES if case not in DEAR]))
def test_the_sense_is_the_sign_of_the_twins_momentum(renderer: Renderer, model: str, spin: float, distance: float, inclination: float) -> None:
    changes = {"rays.model": model, "hole.spin": spin, "camera.distance": distance, "camera.inclination_deg": inclination, "camera.fov_deg": 100.0}
    scene = presets.load(["kerr", "reference"], changes | {"camera.observer": "zamo"})
    renderer.hit_map.forget()
    renderer.render(scene, 0.0, (WIDTH, HEIGHT))
    found = renderer.hits()
    twin = listed_rays.trace_by_reference(scene, _rays(scene))
    k_r = twin.crossing_k_r.reshape(HEIGHT, WIDTH, 3)
    there = np.any(found.crossing != 0.0, axis=-1) & (np.abs(k_r) > STEEP)
    assert np.sum(there & found.inbound) > 50 and np.sum(there & ~found.inbound) > 50
    wrong = there & (found.inbound != (k_r < 0.0))
    assert np.mean(wrong[there]) < 2e-3, "but for rays of pixels that are parted by the critical curve"
    assert not np.any(found.inbound & np.all(found.crossing == 0.0, axis=-1))


@pytest.mark.parametrize("values", [{}, {"camera.inclination_deg": 30.0, "hole.spin": 0.9}, {"camera.distance": 4.0}, {"camera.distance": math.inf}])
@pytest.mark.parametrize("reads", [{"disk.plunging": True}, {"disk.tilt_deg": 20.0}])
def test_interpolated_crossings_have_the_sense_of_traced_ones(renderer: Renderer, monkeypatch: pytest.MonkeyPatch, values: dict, reads: dict) -> None:
    """In scenes whose matter shines by it: it falls, or its disk is tilted."""
    monkeypatch.setattr(choice, "refinement", lambda scene: None)
    scene, size = presets.load([], {**values, **reads}), (480, 270)
    hits = []
    for progressive in (False, True):
        renderer.hit_map.forget()
        renderer.render(scene, 0.0, size, progressive=progressive)
        hits.append(renderer.hits())
    assert not renderer.hit_map.is_sharp, "nothing was interpolated"
    exact, found = hits
    radius = np.linalg.norm(exact.crossing, axis=-1)
    on_disk = (radius > 1.0) & (radius < scene.disk.outer_radius)
    assert np.sum(on_disk & exact.inbound) > 500 and np.sum(on_disk & ~exact.inbound) > 500
    assert np.mean((found.inbound != exact.inbound)[on_disk]) < 1e-4, "a turning point may lie just beside a cell"


def test_turning_points_need_no_rays_of_their_own_where_nothing_shines_by_the_sense(renderer: Renderer) -> None:
    """Across the disk light turns from coming in to going out where it is seen edge on: the light of circular orbits is the same on both sides."""
    shares = []
    for falls in (True, False):
        renderer.hit_map.forget()
        renderer.render(presets.load(["kerr"], {"hole.spin": 0.0, "rays.model": "schwarzschild", "disk.plunging": falls}), 0.0, (480, 270), progressive=True)
        shares.append(renderer.hit_map.own_rays()[:, :120].mean())  # of the disk's side, away from the hole
    assert shares[0] > 0.02 and shares[1] == 0.0, shares
