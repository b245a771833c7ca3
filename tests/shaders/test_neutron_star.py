"""A sphere about the hole and larger than it: where each ray ends and how much of the surface is seen, by the closed form in Schwarzschild's field."""

from __future__ import annotations

import numpy as np
import pytest

from blackhole_gl.physics import observer
from blackhole_gl.rendering.frame import Renderer
from blackhole_gl.scene import presets

STAR = {"kind": "sphere", "x": 0.0, "y": 0.0, "z": 0.0}
FAR = {"hole.spin": 0.0, "disk.enabled": False, "camera.distance": float("inf"), "camera.inclination_deg": 90.0, "camera.azimuth_deg": 0.0}
STEPS = {"rays.integrator": "rk4", "rays.step_angle": 0.05, "rays.step_length": 0.05}

RIM = 2e-4
"""Share of the impact parameter within which rays at the rim count as met or as not: a ray is met by straight pieces, which stray from it a little."""


def _grazing_impact(radius: float) -> float:
    """Impact parameter in r_s of light that leaves the sphere of `radius` (r_s) at a grazing angle."""
    return radius / np.sqrt(1.0 - 1.0 / radius)


def _angle(radius: float, short: np.ndarray) -> np.ndarray:
    """Between the line of sight and the place that light leaves, its impact parameter being `short` (shares) less than that of grazing light.

    ψ = ∫ du/√(1/b² − u² + u³) from 0 to u₀ = 1/R, with u = u₀(1 − s²), which takes the root at grazing angles away.
    """
    u0 = 1.0 / radius
    nodes, weights = np.polynomial.legendre.leggauss(300)
    s = 0.5 * (nodes + 1.0)
    # 1/b² − u² + u³ less its value at grazing angles, which is u₀² s² (2 − s² − u₀ (3 − 3s² + s⁴)).
    more = (1.0 / (1.0 - short) ** 2 - 1.0) / _grazing_impact(radius) ** 2
    grazing = u0 * u0 * s**2 * (2.0 - s**2 - u0 * (3.0 - 3.0 * s**2 + s**4))
    return np.sum(0.5 * weights * 2.0 * u0 * s / np.sqrt(grazing + more[:, None]), axis=-1)


@pytest.mark.parametrize("model", ["kerr", "schwarzschild"])
@pytest.mark.parametrize("radius", [1.75, 3.0, 6.0])
def test_the_part_of_its_surface_that_is_seen_is_that_of_the_closed_form(renderer: Renderer, model: str, radius: float) -> None:
    """Of each ray the place it ends at; and the share of the surface, (1 − cos ψ)/2 at the rim, within a hundredth: of 1.75 r_s all there is.

    ψ runs with the root of the way to the rim, along which it is carried on to there.
    """
    values = {**FAR, **STEPS, "rays.model": model, **{f"things.star.{name}": value for name, value in STAR.items()}, "things.star.radius": radius}
    scene = presets.load(["kerr"], values)
    short = np.geomspace(1e-3, 0.9, 200)
    beside = np.geomspace(RIM, 1.0, 60)
    impact = 2.0 * _grazing_impact(radius)  # M
    hits, _, _ = renderer.trace_listed(scene, observer.parallel_rays(impact * np.concatenate([1.0 - short, [1.0 - RIM], 1.0 + beside]), 0.0))
    met = hits.met[:, 0, 0] >= 0
    assert np.all(met[:201]) and not np.any(met[201:])
    place = hits.met_place[:200, 0].astype(float)
    seen = np.abs(np.unwrap(np.arctan2(place[::-1, 1], place[::-1, 0]))[::-1])
    expected = _angle(radius, short)
    apart = np.abs(seen / expected - 1.0)
    assert np.max(apart) < 0.01 and np.quantile(apart, 0.8) < 1e-3, "most beside the rim, where a little on the way is much on the surface"
    rim = np.polyval(np.polyfit(np.sqrt(short[:60]), seen[:60], 2), 0.0)
    share, of_closed_form = (0.5 * (1.0 - np.cos(min(angle, np.pi))) for angle in (rim, _angle(radius, np.zeros(1))[0]))
    assert share == pytest.approx(of_closed_form, rel=0.01)
    if radius == 1.75:
        assert rim > 0.99 * np.pi and share > 0.999


def test_the_closed_form_is_a_straight_line_far_from_the_hole() -> None:
    assert _angle(1e6, np.array([0.0, 0.5])) == pytest.approx([0.5 * np.pi, np.arcsin(0.5)], rel=1e-5)
