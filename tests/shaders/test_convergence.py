"""Every integrator's declared order: by its float64 twin, and in the shader until float32 rounding flattens the curve. `-rP` shows the slopes.

Escape directions of the shader flatten out at 2e-7 rad (kerr, schwarzschild_binet with rk4), 3e-7 rad (schwarzschild) and 4e-7 rad
(kerr_schild); from there on shorter steps only add rounding, about as the square root of their number. That is at κ = 0.05 for rk4,
0.025 for bs3, and at κ = 0.2 to 0.4 for dopri5: before its fifth order has set in, so that the shader's curve for it is steeper than 5
and has no straight part.
"""

from __future__ import annotations

import math
from functools import lru_cache

import numpy as np
import pytest

from blackhole_gl import listed_rays
from blackhole_gl.reference import schemes
from blackhole_gl.rendering.frame import Renderer
from blackhole_gl.scene import catalogue, presets
from tests.sampled import sampled

WITHIN = 0.3  # measured order against the declared one: the nearest whole number is in no doubt
FLOOR = 1.5e-6  # rad: what rounding may leave at the finest steps used here

K = 36.0  # b = 6 M


def _orbit_rate(state: np.ndarray) -> np.ndarray:
    """Binet's equation in Mino time: w' and w'' = K w (3 w − 1), M = 1."""
    w, rate = state
    return np.array([rate, K * w * (3.0 * w - 1.0)])


def _orbit_end(scheme: str, steps: int) -> np.ndarray:
    """(w, w') of a ray from w = 0.025 that passes the hole, after 0.6 of Mino time."""
    state = np.array([0.025, math.sqrt(1.0 - K * 0.025**2 * (1.0 - 2.0 * 0.025))])
    for _ in range(steps):
        state = schemes.step(scheme, _orbit_rate, state, 0.6 / steps)
    return state


@lru_cache
def _exact_end() -> np.ndarray:
    return _orbit_end("dopri5", 5000)


def _slope(sizes: np.ndarray, errors: np.ndarray) -> float:
    return float(np.polyfit(np.log(sizes), np.log(errors), 1)[0])


def test_every_integrator_has_a_twin() -> None:
    assert set(schemes.SCHEMES) == set(catalogue.keys("integrator"))


@pytest.mark.parametrize("scheme", schemes.SCHEMES)
def test_order_in_float64(scheme: str) -> None:
    steps = 64 * 2 ** np.arange(4) * (8 if scheme == "euler" else 1)
    exact = _exact_end()
    errors = np.array([np.abs(_orbit_end(scheme, n) - exact).max() for n in steps])
    slope = _slope(1.0 / steps, errors)
    print(f"{scheme}: order {slope:.2f} in float64")
    assert abs(slope - catalogue.plug_ins("integrator")[scheme].traits.order) <= WITHIN


@pytest.mark.parametrize("scheme, power", [("bs3", 3.0), ("dopri5", 5.0)])
def test_error_estimates_grow_as_their_step_control_takes_them_to(scheme: str, power: float) -> None:
    state = np.array([0.2, 0.5])
    sizes = 0.04 / 2.0 ** np.arange(5)
    estimates = np.array([np.abs(np.subtract(*schemes.pair(scheme, _orbit_rate, state, h))).max() for h in sizes])
    assert abs(_slope(sizes, estimates) - power) <= WITHIN


def _shader_errors(renderer: Renderer, model: str, integrator: str, control: str, key: str, settings: tuple[float, ...]) -> np.ndarray:
    """Median error of the escape direction over 400 rays with b = 3.5 … 10 r_s, for each setting."""
    rng = np.random.default_rng(0)
    b, chi = rng.uniform(3.5, 10.0, 400), rng.uniform(0.0, 2.0 * math.pi, 400)
    rays = np.stack([np.arcsin(b * math.sqrt(1.0 - 1.0 / 20.0) / 20.0), chi], axis=-1)
    values = {"rays.model": model, "rays.integrator": integrator, "rays.step_control": control, "rays.max_steps": 8000}
    values |= {"rays.step_angle": 0.2, "rays.step_length": 0.3, "camera.distance": 20.0, "camera.inclination_deg": 70.0}
    values |= {"hole.spin": 0.6 if model.startswith("kerr") else 0.0}
    errors, twin = [], None
    for setting in settings:
        scene = presets.load(["kerr"], values | {key: setting})
        twin = twin or listed_rays.trace_by_reference(scene, rays)
        found = listed_rays.trace_by_shader(renderer, scene, rays)
        escaped = (found.fate == 1) & (twin.fate == 1)
        assert escaped.sum() > 300
        errors.append(np.median(np.linalg.norm(found.direction - twin.direction, axis=1)[escaped]))
    print(f"{model}, {integrator}, {control}: " + ", ".join(f"{s:g} → {e:.1e} rad" for s, e in zip(settings, errors)))
    return np.array(errors)


ORDERS = [
    ("kerr", "euler", (0.1, 0.05, 0.025)),
    ("kerr", "verlet", (0.2, 0.1, 0.05, 0.025)),
    ("kerr", "rk4", (0.4, 0.2, 0.1)),
    ("kerr", "nystrom4", (0.4, 0.2, 0.1)),
    ("schwarzschild_binet", "rk4", (0.4, 0.2, 0.1)),
    ("schwarzschild_binet", "nystrom5", (0.8, 0.56, 0.4)),
    ("kerr_schild", "rk4", (0.4, 0.2, 0.1)),
    ("kerr_schild", "bs3", (0.2, 0.1, 0.05)),
    ("schwarzschild", "verlet", (0.8, 0.4, 0.2, 0.1)),
    ("schwarzschild", "bs3", (0.8, 0.4, 0.2, 0.1)),
    ("schwarzschild", "rk4", (1.6, 0.8, 0.4)),
    ("schwarzschild", "nystrom4", (1.6, 0.8, 0.4)),
]
# Each integrator, and each model once at least: the others again with one that another has shown.
AGAIN = [("kerr", "verlet"), ("kerr", "rk4"), ("kerr", "nystrom4"), ("schwarzschild_binet", "rk4"), ("kerr_schild", "bs3")]


@pytest.mark.parametrize("model, integrator, settings", sampled(ORDERS, [order for order in ORDERS if order[:2] not in AGAIN]))
def test_order_in_the_shader(renderer: Renderer, model: str, integrator: str, settings: tuple[float, ...]) -> None:
    own = catalogue.plug_ins("ray_model")[model].traits.marches_in
    control, key = ("radius", "rays.step_length") if own == "cartesian" else ("mino", "rays.step_angle")
    errors = _shader_errors(renderer, model, integrator, control, key, settings)
    assert errors.min() > 5e-7, "a point on the floor says nothing about the order"
    slope = _slope(np.array(settings), errors)
    print(f"order {slope:.2f} in the shader")
    assert abs(slope - catalogue.plug_ins("integrator")[integrator].traits.order) <= WITHIN


def test_the_fifth_order_falls_onto_the_floor(renderer: Renderer) -> None:
    errors = _shader_errors(renderer, "kerr_schild", "dopri5", "mino", "rays.step_angle", (0.8, 0.4, 0.2))
    assert np.log2(errors[0] / errors[1]) >= 5.0 - WITHIN and errors[2] <= FLOOR


@pytest.mark.parametrize("model", ["kerr", "schwarzschild_binet", "kerr_schild", "schwarzschild"])
def test_the_floor(renderer: Renderer, model: str) -> None:
    own = catalogue.plug_ins("ray_model")[model].traits.marches_in
    control, key = ("radius", "rays.step_length") if own == "cartesian" else ("mino", "rays.step_angle")
    assert _shader_errors(renderer, model, "rk4", control, key, (0.05, 0.025)).max() <= FLOOR


WITH_TOLERANCES = [(model, *way) for model in ("kerr", "schwarzschild")
                   for way in (("embedded", "dopri5"), ("embedded", "bs3"), ("doubling", "rk4"), ("doubling", "verlet"))]


@pytest.mark.parametrize("model, control, integrator", sampled(
    WITH_TOLERANCES, [way for way in WITH_TOLERANCES if way[0] != "kerr" or way[2] in ("dopri5", "rk4")],
))
def test_a_tolerance_is_kept(renderer: Renderer, model: str, control: str, integrator: str) -> None:
    """The whole way's error stays within a few steps' tolerance, and falls with it."""
    settings = (1e-3, 1e-4, 1e-5)
    errors = _shader_errors(renderer, model, integrator, control, f"rays.{control}.tolerance", settings)
    assert np.all(errors <= 10.0 * np.array(settings))
    assert errors[0] > 3.0 * errors[2] and errors[0] >= errors[1] >= errors[2]  # doubling has steps of powers of two only
