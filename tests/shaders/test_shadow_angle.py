"""The shadow has the size that closed forms give it, for every observer. `-rP` shows the figures."""

from __future__ import annotations

import math

import numpy as np
import pytest

from blackhole_gl.physics import relativity
from blackhole_gl.rendering.frame import Renderer
from blackhole_gl.scene import presets
from tests.shaders.sampling import SCREEN_ANGLES, shadow_edge

# README.md states this bound. Float32 directions alone are good to 1e-7; the rest is the march's rounding on the critical curve.
RELATIVE = 1e-5


@pytest.mark.parametrize("model", ["kerr", "schwarzschild", "auto"])
@pytest.mark.parametrize("distance", [1.7, 3.0, 10.0, 15.0, 100.0])
def test_schwarzschild_shadow_of_a_static_observer(renderer: Renderer, model: str, distance: float) -> None:
    scene = presets.load(["schwarzschild", "reference"], {"rays.model": model, "camera.distance": distance})
    psi = shadow_edge(renderer, scene, SCREEN_ANGLES)
    exact = float(relativity.schwarzschild_shadow_angle(distance))
    error = np.abs(psi / exact - 1.0).max()
    print(f"{model}, r = {distance:g} r_s: relative error of the half-angle at most {error:.1e}")
    assert error <= RELATIVE
    assert np.abs(np.sin(psi) / (relativity.CRITICAL_IMPACT * math.sqrt(1.0 - 1.0 / distance) / distance) - 1.0).max() <= RELATIVE


@pytest.mark.parametrize(
    "distance, inclination, kind",
    [(20.0, 80.0, "static"), (3.0, 60.0, "zamo"), (10.0, 90.0, "static"), (50.0, 17.0, "static"), (1.05, 75.0, "zamo")],
)
@pytest.mark.parametrize("spin", [0.5, 0.9, 0.998])
def test_kerr_shadow_through_the_observers_tetrad(renderer: Renderer, spin: float, distance: float, inclination: float, kind: str) -> None:
    changes = {"hole.spin": spin, "camera.distance": distance, "camera.inclination_deg": inclination, "camera.observer": kind}
    psi = shadow_edge(renderer, presets.load(["kerr", "reference"], changes), SCREEN_ANGLES)
    exact = relativity.shadow_angle(SCREEN_ANGLES, distance, math.radians(inclination), spin, kind)
    error = np.abs(psi / exact - 1.0).max()
    print(f"kerr, a* = {spin:g}, r = {distance:g} r_s, i = {inclination:g}°, {kind}: relative error of the half-angle at most {error:.1e}")
    assert error <= RELATIVE


def test_shadow_fills_more_than_half_the_sky_inside_the_photon_sphere(renderer: Renderer) -> None:
    for model in ("kerr", "schwarzschild"):
        scene = presets.load(["schwarzschild", "reference"], {"rays.model": model, "camera.distance": 1.2})
        psi = shadow_edge(renderer, scene, SCREEN_ANGLES)
        assert np.all(psi > 0.5 * np.pi)
        assert np.abs(psi / float(relativity.schwarzschild_shadow_angle(1.2)) - 1.0).max() <= RELATIVE
