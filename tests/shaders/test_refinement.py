"""A moving camera's refined hit map against the exact one: how far interpolated hits lie, and that it sharpens to the exact map itself."""

from __future__ import annotations

import math

import numpy as np
import pytest

from blackhole_gl.planning import choice
from blackhole_gl.rendering.frame import Renderer
from blackhole_gl.rendering.hit_texels import HitArrays
from blackhole_gl.scene import Scene, presets
from studies.displacement import beside_an_edge, displacement_px

SIZE = (480, 270)
CAMERAS = {
    "default": {},
    "from above": {"camera.inclination_deg": 45.0},
    "over the pole": {"camera.inclination_deg": 0.0},
    "near the plane": {"camera.inclination_deg": 89.5},
    "in the plane": {"camera.inclination_deg": 90.0},
    "a disk thinner than a cell": {"camera.distance": 23.4, "camera.inclination_deg": 89.8, "hole.spin": 0.0},
    "a far disk thinner than a cell": {
        "camera.distance": 79.0,
        "camera.inclination_deg": 89.75,
        "camera.fov_deg": 42.3,
        "hole.spin": -0.9,
        "disk.outer_radius": 20.0,
    },
    "from below": {"camera.inclination_deg": 110.0},
    "close": {"camera.distance": 4.0, "camera.inclination_deg": 70.0},
    "at 1.6 r_s": {"camera.distance": 1.6, "camera.fov_deg": 110.0},
    "inside the photon sphere, looking out too": {"camera.distance": 1.2, "camera.fov_deg": 150.0},
    "seeing the chart's singular direction": {
        "camera.distance": 1.21,
        "camera.inclination_deg": 128.4,
        "camera.fov_deg": 140.0,
        "hole.spin": 0.9,
        "disk.outer_radius": 20.0,
    },
    "fast hole": {"hole.spin": 0.998, "camera.inclination_deg": 85.0},
    "turning the other way": {"hole.spin": -0.9},
    "a hole smaller than a cell": {"camera.distance": 3000.0, "camera.inclination_deg": 60.0},
    "parallel rays": {"camera.distance": math.inf},
    "small disk": {"disk.outer_radius": 3.0},
    "no disk": {"disk.enabled": False},
    "one order": {"rays.orders": 1},
    "two orders": {"rays.orders": 2},
    "table": {"hole.spin": 0.0, "rays.model": "schwarzschild_table"},
    "marched without spin": {"hole.spin": 0.0, "rays.model": "schwarzschild_binet"},
}


@pytest.fixture(autouse=True)
def refined_whether_or_not_it_pays(monkeypatch: pytest.MonkeyPatch) -> None:
    """What the chart measured on some machine is the plan's matter (test_plan.py): at a fine tolerance it may have found a ray for every pixel cheaper."""
    monkeypatch.setattr(choice, "refinement", lambda scene: None)


def _scene(**values) -> Scene:
    return presets.load([], values)


def _hits(renderer: Renderer, scene: Scene, *, progressive: bool, size: tuple[int, int] = SIZE) -> HitArrays:
    renderer.hit_map.forget()
    assert renderer.render(scene, 0.0, size, progressive=progressive).traced
    return renderer.hits()


@pytest.mark.parametrize("name", CAMERAS)
def test_interpolated_hits_stay_within_the_tolerance(renderer: Renderer, name: str) -> None:
    """All of them and not 99 %: the estimate is twice what third differences make (shaders/refine_nodes.frag), for what it cannot see."""
    scene = _scene(**CAMERAS[name])
    exact, found = _hits(renderer, scene, progressive=False), _hits(renderer, scene, progressive=True)
    assert not renderer.hit_map.is_sharp, "nothing was interpolated"
    assert displacement_px(scene, found, exact).max() <= scene.rays.tolerance
    wrong = found.fate != exact.fate
    assert not np.any(wrong & ~beside_an_edge(exact.fate))
    assert np.mean(wrong) <= 1e-4


def test_a_smaller_tolerance_is_kept_and_costs_more_rays(renderer: Renderer) -> None:
    share = {}
    for tolerance in (0.5, 0.1, 0.02):
        # The march stays as it is; only the interpolation has to do better.
        scene = _scene(**{"rays.tolerance": tolerance, "rays.model": "kerr", "rays.integrator": "rk4", "rays.step_angle": 0.2})
        exact, found = _hits(renderer, scene, progressive=False), _hits(renderer, scene, progressive=True)
        assert displacement_px(scene, found, exact).max() <= tolerance
        share[tolerance] = np.mean(np.any(found.direction != exact.direction, axis=-1))
    assert share[0.5] > share[0.1] > share[0.02] > 0.0, "the closer, the fewer pixels are interpolated"


def test_most_pixels_of_a_large_picture_are_interpolated(renderer: Renderer) -> None:
    """Of 1280×720 about a twentieth of the cells is traced; a quarter would no longer be worth it."""
    scene = _scene()
    exact = _hits(renderer, scene, progressive=False, size=(1280, 720))
    found = _hits(renderer, scene, progressive=True, size=(1280, 720))
    lone = (found.fate == 1) & np.any(found.direction != exact.direction, axis=-1)
    assert np.mean(lone) > 0.7


def test_at_rest_it_sharpens_to_the_exact_map(renderer: Renderer) -> None:
    scene = _scene()
    exact = _hits(renderer, scene, progressive=False)
    before = displacement_px(scene, _hits(renderer, scene, progressive=True), exact)
    slices = 0
    while not renderer.hit_map.is_sharp:
        report = renderer.render(scene, 0.1 * slices, SIZE, progressive=True)
        assert report.traced and report.sharpened
        now = displacement_px(scene, renderer.hits(), exact)
        assert np.all(now <= before), "no pixel gets worse on the way"
        before, slices = now, slices + 1
    assert 4 <= slices <= 30, "a slice a frame: neither a jump nor a wait"
    for name in ("fate", "direction", "crossing", "lambda_", "steps"):
        np.testing.assert_array_equal(getattr(renderer.hits(), name), getattr(exact, name))
    assert not renderer.render(scene, 9.0, SIZE, progressive=True).traced


def test_what_is_sharpened_is_seen_at_once(renderer: Renderer) -> None:
    """The rows traced so far are those of the exact picture, also where linear interpolation did before (shaders/refine_classes.frag)."""
    scene = _scene(**{"post.bloom": False, "rays.edges": 1})
    renderer.hit_map.forget()
    renderer.render(scene, 0.0, SIZE)
    exact = renderer.radiance()
    renderer.hit_map.forget()
    renderer.render(scene, 0.0, SIZE, progressive=True)
    for _ in range(6):
        renderer.render(scene, 0.0, SIZE, progressive=True)
    assert not renderer.hit_map.is_sharp
    traced = renderer.hit_map.own_rays()[::-1].all(axis=1)
    traced[np.argmax(traced)] = False  # the uppermost row's slopes go by the row above
    assert 0.4 < traced.mean() < 0.6
    differs = np.any(renderer.radiance()[traced] != exact[traced], axis=-1)
    assert np.mean(differs) < 0.002, "but for single pixels beside the disk, which a cell's shared class does not see: a tenth of all differ where interpolated"


def test_exact_is_what_is_asked_for(renderer: Renderer) -> None:
    """A picture that is to be kept does not take over interpolated hits."""
    scene = _scene()
    _hits(renderer, scene, progressive=True)
    report = renderer.render(scene, 0.0, SIZE)
    assert report.traced and report.sharp and not report.sharpened


@pytest.mark.parametrize("values", [{"rays.refine": False}, {"rays.lensing": False}, {"post.view": "steps"}, {"rays.model": "weak_field", "hole.spin": 0.0}])
def test_where_refinement_is_off_or_saves_nothing_rays_are_exact(renderer: Renderer, values: dict) -> None:
    renderer.hit_map.forget()
    assert renderer.render(_scene(**values), 0.0, SIZE, progressive=True).sharp


def test_a_wider_disk_is_judged_anew(renderer: Renderer) -> None:
    """What lies beyond the disk's edge was not looked at; a map that every pixel was traced for is kept (test_hit_map.py)."""
    _hits(renderer, _scene(**{"disk.outer_radius": 5.0}), progressive=True)
    report = renderer.render(_scene(**{"disk.outer_radius": 9.0}), 0.0, SIZE, progressive=True)
    assert report.traced and not report.sharpened


def test_the_picture_is_that_of_exact_rays(renderer: Renderer) -> None:
    """No blocks, no seams: of a large picture next to no pixels differ by more than two grey levels, beside the brightest edges."""
    scene = _scene()
    renderer.hit_map.forget()
    renderer.render(scene, 0.0, (1280, 720))
    exact = renderer.read_rgb8().astype(int)
    renderer.hit_map.forget()
    renderer.render(scene, 0.0, (1280, 720), progressive=True)
    apart = np.abs(renderer.read_rgb8().astype(int) - exact).max(axis=-1)
    assert np.mean(apart > 2) < 0.0005
