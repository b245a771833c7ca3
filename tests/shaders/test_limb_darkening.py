"""Limb darkening: the light of each pixel over what it is without, against the angle that float64 finds in the frame of the matter."""

from __future__ import annotations

import numpy as np
import pytest

from blackhole_gl.physics import lensed_circles, polarization, relativity
from blackhole_gl.physics.observer import observe
from blackhole_gl.rendering.frame import Renderer
from blackhole_gl.rendering.recording import pixel_direction
from blackhole_gl.scene import presets

SIZE = (96, 54)
LAWS = {"grey": lambda mu: 0.5 + 0.75 * mu, "scattering": lambda mu: (1.0 + 2.06 * mu) / (1.0 + 2.06 * 2.0 / 3.0)}


@pytest.mark.parametrize("law", LAWS)
@pytest.mark.parametrize("spin, orbit, distance, inclination", [(0.9, "prograde", 20.0, 70.0), (0.5, "retrograde", np.inf, 30.0), (0.0, "prograde", 8.0, 85.0)])
def test_light_goes_as_the_law_of_its_angle(renderer: Renderer, law: str, spin: float, orbit: str, distance: float, inclination: float) -> None:
    scene = presets.load(
        ["kerr", "reference", "smooth"],
        {"hole.spin": spin, "disk.orbit": orbit, "camera.distance": distance, "camera.inclination_deg": inclination, "disk.colour": "white",
         "disk.temperature_law": "shakura_sunyaev", "disk.compositing": "additive", "disk.orders_shown": "direct", "sky.enabled": False,
         "post.bloom": False, "rays.edges": 1},
    )  # fmt: skip
    light = []
    for chosen in (law, "none"):
        renderer.render(scene.with_values({"disk.limb_darkening": chosen}), 0.0, SIZE)
        light.append(renderer.radiance()[::-1, :, 0].astype(float))
    hits, seen = renderer.hits(), observe(scene)
    r = np.linalg.norm(hits.crossing[..., 0, :].astype(float), axis=-1)
    there = (r > 1.15 * float(relativity.isco_radius(spin, orbit))) & (r < 9.0)
    y, x = np.nonzero(there)
    local = np.array([seen.look @ pixel_direction(scene, SIZE, (i + 0.5, j + 0.5)) for i, j in zip(x, y)])
    rays = lensed_circles.light(seen, local)
    momentum = lensed_circles.crossing_momentum(rays, np.zeros(len(x), int), r[there])
    rise = polarization.emitted(r[there], momentum, polarization.circular_velocity(r[there], spin, orbit), np.array([0.0, -1.0, 0.0]), spin).rise
    ratio = light[0][there] / light[1][there]
    assert len(ratio) > 500 and rise.max() - rise.min() > 0.3
    np.testing.assert_allclose(ratio, LAWS[law](rise), rtol=2e-3)  # of two half floats, 5e-4 each


@pytest.mark.parametrize("law", LAWS)
def test_a_law_changes_the_angles_and_not_the_flux(law: str) -> None:
    nodes, weights = np.polynomial.legendre.leggauss(8)
    mu = 0.5 * (1.0 + nodes)
    assert np.sum(weights * mu * LAWS[law](mu)) == pytest.approx(1.0, rel=1e-12)
