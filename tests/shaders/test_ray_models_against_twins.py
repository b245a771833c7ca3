"""Every further ray model's shader against its float64 twin: cameras near and far, tilted, in the plane and on the axis. `-rP` shows the figures."""

from __future__ import annotations

import math

import numpy as np
import pytest

from blackhole_gl import listed_rays
from blackhole_gl.rendering.frame import Renderer
from blackhole_gl.scene import Scene, catalogue, presets
from tests.sampled import sampled
from tests.shaders.sampling import random_rays

# What float32 leaves at 1e-2 from the shadow's edge. The drag from infinity is of first order to the march's bound: bounds of its own.
DIRECTION_MEDIAN, DIRECTION_99 = 2e-6, 1e-5  # rad
CROSSING_MEDIAN, CROSSING_99 = 2e-6, 5e-5  # relative, within the largest disk
DISK = 20.0  # r_s

CAMERAS = [(20.0, 80.0), (4.0, 40.0), (300.0, 17.0), (12.0, 90.0), (8.0, 0.0)]

EXACT = ("schwarzschild_binet", "kerr_schild")
CLOSED = ("screen_lens", "weak_field")
WRONG = ("post_newtonian", "post_newtonian_drag")


def scene_of(model: str, distance: float, inclination: float, **changes) -> Scene:
    values = {"rays.model": model, "camera.distance": distance, "camera.inclination_deg": inclination, "camera.azimuth_deg": 25.0, "hole.spin": 0.9}
    control = catalogue.plug_ins("ray_model")[model].traits.step_control or "fixed"
    values |= {"rays.integrator": "rk4", "rays.step_control": control, "rays.step_angle": 0.05, "rays.step_length": 0.12, "rays.max_steps": 4000}
    return presets.load(["kerr"], values | {key.replace("__", "."): value for key, value in changes.items()})


def compared(renderer: Renderer, scene: Scene, rays: np.ndarray) -> dict[str, float]:
    """Quantiles of the differences, after the fates and the number of crossings were found equal."""
    found, twin = listed_rays.trace_by_shader(renderer, scene, rays), listed_rays.trace_by_reference(scene, rays)
    np.testing.assert_array_equal(found.fate, twin.fate)
    disk = twin.crossing_r < DISK
    # A crossing at the very edge of what is kept may fall on either side of it.
    clear = np.abs(twin.crossing_r / 1.02 - 1.0) > 1e-4
    np.testing.assert_array_equal(np.isnan(found.crossing_r)[disk & clear], False)
    angle = np.linalg.norm(found.direction - twin.direction, axis=1)[twin.fate == 1]
    apart = (np.abs(found.crossing_r / twin.crossing_r - 1.0) + np.abs(np.exp(1j * found.crossing_phi) - np.exp(1j * twin.crossing_phi)))[disk & clear]
    apart = np.append(apart, 0.0)
    figures = {"median": np.median(angle), "99": np.quantile(angle, 0.99), "crossing": np.median(apart), "crossing99": np.quantile(apart, 0.99)}
    print(f"{scene.rays.model}, r = {scene.camera.distance:g}, i = {scene.camera.inclination_deg:g}°: " + ", ".join(f"{k} {v:.1e}" for k, v in figures.items()))
    return figures


# The twin of Binet's equation takes a second each time: from the axis and in the plane, where angles are most delicate.
QUICK = [(model, *camera) for model in EXACT + CLOSED for camera in CAMERAS if model != "schwarzschild_binet" or camera[1] in (0.0, 90.0)]


@pytest.mark.parametrize("model, distance, inclination", sampled([(model, *camera) for model in EXACT + CLOSED for camera in CAMERAS], QUICK))
def test_listed_rays(renderer: Renderer, model: str, distance: float, inclination: float) -> None:
    scene = scene_of(model, distance, inclination)
    figures = compared(renderer, scene, random_rays(scene, 600, seed=8))
    assert figures["median"] <= DIRECTION_MEDIAN and figures["99"] <= DIRECTION_99
    # In its own plane a camera sees crossings only where rays run nearly along it.
    slack = 10.0 if inclination == 90.0 else 1.0
    assert figures["crossing"] <= slack * CROSSING_MEDIAN and figures["crossing99"] <= slack * CROSSING_99


@pytest.mark.parametrize("distance, inclination", CAMERAS)
@pytest.mark.parametrize("model", WRONG)
def test_wrong_models_do_what_was_published(renderer: Renderer, model: str, distance: float, inclination: float) -> None:
    scene = scene_of(model, distance, inclination)
    rng = np.random.default_rng(2)
    chi, b = rng.uniform(0.0, 2.0 * math.pi, 400), rng.uniform(5.5, 12.0, 400)  # outside every shadow of these models; inside is tested below
    rays = np.stack([np.arcsin(np.minimum(b / distance, 1.0)), chi], axis=-1)
    if distance < 6.0:
        rays[:, 0] = rng.uniform(2.0, math.pi, 400)
    figures = compared(renderer, scene, rays)
    slack = 10.0 if model == "post_newtonian_drag" or inclination == 90.0 else 1.0
    assert figures["median"] <= DIRECTION_MEDIAN and figures["99"] <= slack * DIRECTION_99
    assert figures["crossing99"] <= slack * CROSSING_99


@pytest.mark.parametrize("model", EXACT + CLOSED + WRONG)
def test_parallel_rays(renderer: Renderer, model: str) -> None:
    scene = scene_of(model, math.inf, 70.0)
    rng = np.random.default_rng(5)
    radius, turn = rng.uniform(9.0, 25.0, 300), rng.uniform(0.0, 2.0 * math.pi, 300)  # M
    figures = compared(renderer, scene, np.stack([radius * np.cos(turn), radius * np.sin(turn)], axis=-1))
    drag = model == "post_newtonian_drag"
    assert figures["median"] <= (1e-5 if drag else DIRECTION_MEDIAN) and figures["99"] <= (2e-4 if drag else DIRECTION_99)
    assert figures["crossing99"] <= (2e-4 if drag else CROSSING_99)


@pytest.mark.parametrize("model", EXACT + CLOSED + WRONG)
def test_rays_that_break_other_viewers(renderer: Renderer, model: str) -> None:
    """Exactly radial, 0.006° from it, and near-tangential outward rays."""
    psi = np.array([0.0, 1e-4, 1e-7, math.pi, math.pi - 1e-4, math.pi - 1e-7, 0.5 * math.pi, 0.5 * math.pi - 1e-4, 0.5 * math.pi + 1e-4])
    rays = np.stack([np.tile(psi, 4), np.repeat([0.0, 0.5 * math.pi, 2.0, math.pi], len(psi))], axis=-1)
    compared(renderer, scene_of(model, 20.0, 80.0), rays)


FINEST = [("kerr", "curvature"), ("schwarzschild_binet", "mino"), ("kerr_schild", "curvature")]


@pytest.mark.parametrize("model, control", sampled([(model, control) for model in ("kerr", *EXACT) for control in ("mino", "curvature")], FINEST))
def test_finest_settings(renderer: Renderer, model: str, control: str) -> None:
    """At spin 0 and 0.9: direction median 2e-6, 99 % 1e-5; crossing median 3e-7, 99 % 1e-5."""
    for spin in (0.0, 0.9):
        scene = scene_of(model, 20.0, 80.0, hole__spin=spin, rays__step_control=control)
        figures = compared(renderer, scene, random_rays(scene, 1000, seed=3))
        assert figures["median"] <= 2e-6 and figures["99"] <= 1e-5
        assert figures["crossing"] <= 3e-7 and figures["crossing99"] <= 1e-5


def test_first_order_weak_field(renderer: Renderer) -> None:
    scene = scene_of("weak_field", 50.0, 60.0, rays__weak_field__second_order=False)
    figures = compared(renderer, scene, random_rays(scene, 300, seed=1))
    assert figures["99"] <= DIRECTION_99


def test_lens_parameters_reach_the_shader(renderer: Renderer) -> None:
    scene = scene_of("screen_lens", 30.0, 60.0, rays__screen_lens__radius=3.0, rays__screen_lens__shadow=1.0)
    figures = compared(renderer, scene, random_rays(scene, 300, seed=1))
    assert figures["99"] <= DIRECTION_99
