"""A sphere about the hole and larger than it: how much of its surface is seen, against the closed form of the light that leaves it at a grazing angle."""

from __future__ import annotations

import numpy as np
import pytest

from blackhole_gl.physics import observer
from blackhole_gl.render.frame import Renderer
from blackhole_gl.scene import presets


def _grazing_angle(radius: float) -> tuple[float, float]:
    """Of light that leaves the sphere of `radius` (r_s) at a grazing angle in Schwarzschild's field and comes to a far observer: the angle between its
    start and the line of sight, and its impact parameter in r_s.

    ψ = ∫ du/√(1/b² − u² + u³) from 0 to u₀ = 1/R, with u = u₀(1 − s²), which takes its end's root away.
    """
    u0 = 1.0 / radius
    inverse_b2 = u0 * u0 * (1.0 - u0)
    nodes, weights = np.polynomial.legendre.leggauss(200)
    s = 0.5 * (nodes + 1.0)
    # 1/b² − u² + u³ = u0² s² (2 − s² − u0 (3 − 3s² + s⁴)), exactly.
    rate = 2.0 / np.sqrt(2.0 - s**2 - u0 * (3.0 - 3.0 * s**2 + s**4))
    return float(np.sum(0.5 * weights * rate)), 1.0 / np.sqrt(inverse_b2)


@pytest.mark.parametrize("model", ["kerr", "schwarzschild"])
@pytest.mark.parametrize("radius", [1.75, 3.0, 6.0])
def test_the_part_of_its_surface_that_is_seen_is_that_of_the_closed_form(renderer: Renderer, model: str, radius: float) -> None:
    """A share of (1 − cos ψ)/2 up to the farthest place that is met, within a hundredth; of 1.75 r_s all there is."""
    angle, impact = _grazing_angle(radius)
    star = {"kind": "sphere", "x": 0.0, "y": 0.0, "z": 0.0, "radius": radius}
    values = {"hole.spin": 0.0, "disk.enabled": False, "camera.distance": float("inf"), "camera.inclination_deg": 90.0, "camera.azimuth_deg": 0.0}
    values |= {"rays.model": model, "rays.integrator": "rk4", "rays.step_angle": 0.05, "rays.step_length": 0.05}
    scene = presets.load(["kerr"], {**values, **{f"things.star.{name}": value for name, value in star.items()}})
    offsets = 2.0 * impact * np.concatenate([np.linspace(0.05, 0.9, 40), 1.0 - np.geomspace(0.1, 1e-6, 60), 1.0 + np.geomspace(1e-6, 1.0, 40)])
    hits, _, _ = renderer.trace_listed(scene, observer.parallel_rays(offsets, 0.0))
    met = hits.met[:, 0, 0] >= 0
    np.testing.assert_array_equal(met[:80], True)
    assert not np.any(met[120:]), "beside it, light goes on"
    place = hits.met_place[met, 0].astype(float)
    seen = np.unwrap(np.arctan2(place[:, 1], place[:, 0]))
    farthest = float(np.max(np.abs(seen)))
    share, expected = (0.5 * (1.0 - np.cos(min(value, np.pi))) for value in (farthest, angle))
    assert share == pytest.approx(expected, rel=0.01)
    assert farthest == pytest.approx(angle, rel=0.01)
    if radius == 1.75:
        assert angle > 0.99 * np.pi and share > 0.999


def test_the_closed_form_is_a_straight_line_far_from_the_hole() -> None:
    angle, impact = _grazing_angle(1e6)
    assert angle == pytest.approx(0.5 * np.pi, rel=1e-5) and impact == pytest.approx(1e6, rel=1e-5)
