"""The temperature of a real disk: its light adds up to what the rate of accretion says."""

from __future__ import annotations

import numpy as np
import pytest
from scipy import integrate

from blackhole_gl.physics import accretion, disk_profile, relativity
from blackhole_gl.scene import presets


def scene_of(**changes: object):
    values = {key.replace("__", "."): value for key, value in changes.items()}
    return presets.load(["kerr"], {"disk.temperature_of": "accretion", "disk.outer_radius": 20.0, "disk.colour_hardening": 1.0, **values})


@pytest.mark.parametrize("spin, mass, rate", [(0.0, 10.0, 0.1), (0.9, 6.5e9, 1e-3)])
def test_the_light_of_both_faces_is_the_share_of_eddingtons(spin: float, mass: float, rate: float) -> None:
    """2 ∫ 2πr σT⁴ E dr over r from the ISCO to 20 r_s, and Page and Thorne's own tail beyond; 1e-4 by the sum over radii."""
    scene = scene_of(hole__spin=spin, source__mass_suns=mass, disk__accretion_rate=rate)
    inner, unit = float(relativity.isco_radius(spin)), 2.0 * 1.3271244e20 * mass / 299792458.0**2  # r_s in m

    def light(y: float) -> float:
        r = inner / y**2
        energy = (1.0 - 1.0 / r + spin * (2.0 * r) ** -1.5) / np.sqrt(1.0 - 1.5 / r + 2.0 * spin * (2.0 * r) ** -1.5)
        kelvin = accretion.hottest(scene) * disk_profile.temperature(
            "page_thorne", np.array([r]), spin=spin, orbit="prograde", r_in=inner, r_out=20.0
        )[0]
        return 4.0 * np.pi * r * unit**2 * 5.670374419e-8 * kelvin**4 * energy * 2.0 * inner / y**3

    power = integrate.quad(light, 0.0, 1.0, epsrel=1e-8)[0]
    eddington = 1.2571e31 * mass  # W, 1.2571e38 erg/s a sun
    assert power == pytest.approx(rate * eddington, rel=2e-3)


def test_what_it_goes_as() -> None:
    base = accretion.hottest(scene_of(source__mass_suns=10.0))
    assert 1e6 < base < 1e7, "some 0.5 keV, as of an X-ray binary"
    assert accretion.hottest(scene_of(source__mass_suns=1e5)) == pytest.approx(0.1 * base, rel=1e-12)
    assert accretion.hottest(scene_of(source__mass_suns=10.0, disk__accretion_rate=1.6)) == pytest.approx(2.0 * base, rel=1e-12)
    assert accretion.hottest(scene_of(source__mass_suns=10.0, disk__colour_hardening=1.7)) == pytest.approx(1.7 * base, rel=1e-12)
    assert accretion.hottest(scene_of(disk__temperature_of="chosen", disk__temperature_k=5000.0)) == 5000.0
