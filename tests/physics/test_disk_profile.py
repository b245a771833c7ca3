"""The disk's temperature: Page & Thorne's flux against its definition, and the table the shaders read."""

from __future__ import annotations

import numpy as np
import pytest
from scipy import integrate

from blackhole_gl.physics import disk_profile, relativity

ORBITS = ["prograde", "retrograde"]


@pytest.mark.parametrize("orbit", ORBITS)
@pytest.mark.parametrize("spin", [0.0, 1e-9, 0.5, 0.9, 0.9999])
def test_page_thorne_against_its_definition(spin, orbit):
    a = abs(spin) if orbit == "prograde" else -abs(spin)

    def orbit_constants(r):
        omega = 1 / (r**1.5 + a)
        u_t = (1 + a / r**1.5) / np.sqrt(1 - 3 / r + 2 * a / r**1.5)
        energy = u_t * (1 - 2 / r + 2 * a * omega / r)
        return omega, energy, u_t * (-2 * a / r + omega * (r * r + a * a + 2 * a * a / r))

    def flux(r):
        # F ~ -Omega'/(r (E - Omega L)^2) int (E - Omega L) L' dr, by parts: E L - 2 int L E' dr ... taken directly here
        inner = 2 * float(relativity.isco_radius(spin, orbit))
        torque = integrate.quad(lambda x: (orbit_constants(x)[1] - orbit_constants(x)[0] * orbit_constants(x)[2]) * slope_l(x),
                                inner, r, epsabs=1e-13, epsrel=1e-12)[0]
        omega, energy, momentum = orbit_constants(r)
        return 1.5 * np.sqrt(r) / (r**1.5 + a) ** 2 / r / (energy - omega * momentum) ** 2 * torque

    def slope_l(r):
        step = 1e-4 * r
        left, right = (orbit_constants(r + s * step)[2] for s in (-1, 1))
        far_left, far_right = (orbit_constants(r + s * step)[2] for s in (-2, 2))
        return (8 * (right - left) - (far_right - far_left)) / (12 * step)

    inner = float(relativity.isco_radius(spin, orbit))
    radii = inner * np.array([1.02, 1.2, 2.0, 6.0, 30.0])
    ratio = disk_profile.page_thorne_flux(radii, spin, orbit) / np.array([flux(2 * r) for r in radii])
    # Differences of fourth order lose about 1e-4 of the torque next to the ISCO of a = 0.9999, where L' itself goes to 0.
    np.testing.assert_allclose(ratio / ratio[-1], 1.0, rtol=1e-3 if spin == 0.9999 else 1e-6)


def test_page_thorne_is_smooth_where_its_two_forms_meet_and_zero_inside():
    for spin in (-0.9999, 0.0, 1e-7, 0.5, 0.998, 0.9999, 1.0):
        inner = float(relativity.isco_radius(spin))
        r = inner * np.linspace(1.001, 3.0, 4000)
        flux = disk_profile.page_thorne_flux(r, spin)
        assert np.all(np.isfinite(flux)) and np.all(flux > 0)
        bend = np.diff(np.log(flux), 3)[20:]
        # third differences of a smooth function on this grid; a seam of 1e-9 would stand out
        assert np.abs(np.diff(bend)).max() < 1e-4
        assert np.all(disk_profile.page_thorne_flux(inner * np.array([0.2, 0.9]), spin) == 0)


@pytest.mark.parametrize("law", disk_profile.LAWS)
@pytest.mark.parametrize("spin", [0.0, 0.9, -0.9999])
def test_table_is_the_law_at_texel_centres_with_peak_one(law, spin):
    inner, outer = float(relativity.isco_radius(spin)), 20.0
    table = disk_profile.table(law, spin, "prograde", inner, outer, 512)
    assert table.dtype == np.float32 and table.shape == (512,)
    assert 0.0 <= table.min() and table.max() <= 1.0
    assert table.max() > 0.999  # the centre next to the peak lies at most half a texel from it
    t = (np.arange(512) + 0.5) / 512
    r = inner + (outer - inner) * t * t
    direct = disk_profile.temperature(law, r, spin=spin, orbit="prograde", r_in=inner, r_out=outer)
    np.testing.assert_allclose(table, direct, rtol=6e-8, atol=1e-30)  # float32
    assert disk_profile.temperature(law, np.array([0.9 * inner]), spin=spin, orbit="prograde", r_in=inner, r_out=outer) == 0


def test_laws_where_their_peaks_are_known():
    def at(law, r, **changes):
        return disk_profile.temperature(law, np.array([r]), **{"spin": 0.0, "orbit": "prograde", "r_in": 3.0, "r_out": 50.0, **changes})[0]

    assert at("shakura_sunyaev", 3.0) == 1.0
    assert at("shakura_sunyaev", 48.0) == pytest.approx(16 ** -0.75, rel=1e-14)
    # tapered: d/dr = 0 where 0.8 (1 - x) = 0.175 x, x = sqrt(r_in/r)
    assert at("tapered", 3.0 / (0.8 / 0.975) ** 2) == pytest.approx(1.0, abs=1e-12)
    # page_thorne in Schwarzschild peaks at 9.55 M; a disk cut off further out is brightest at its edge
    radii = np.linspace(3, 10, 7001)
    values = disk_profile.temperature("page_thorne", radii, spin=0.0, orbit="prograde", r_in=3.0, r_out=50.0)
    assert 2 * radii[np.argmax(values)] == pytest.approx(9.55, abs=0.01)
    assert at("page_thorne", 8.0, r_in=8.0) == 1.0


@pytest.mark.parametrize("spin, orbit", [(0.0, "prograde"), (0.9, "prograde"), (0.6, "retrograde")])
def test_a_torque_at_the_isco_adds_its_work_to_the_light(spin, orbit):
    """Efficiency, 2 ∫ 2πr F E dr over the mass that falls in: 1 − E_ISCO, and what the torque adds; light that falls back in counts."""
    a = abs(spin) if orbit == "prograde" else -abs(spin)
    inner = float(relativity.isco_radius(spin, orbit))

    def efficiency(torque):
        def light(y):  # r = inner/y², in M
            r = 2.0 * inner / y**2
            energy = (1.0 - 2.0 / r + a * r**-1.5) / np.sqrt(1.0 - 3.0 / r + 2.0 * a * r**-1.5)
            flux = 3.0 / (8.0 * np.pi) * disk_profile.page_thorne_flux(0.5 * r, spin, orbit, torque)
            return 4.0 * np.pi * r * flux * energy * 4.0 * inner / y**3
        return integrate.quad(light, 0.0, 1.0, epsabs=1e-11, epsrel=1e-9)[0]

    at_isco = np.sqrt(1.0 - 1.0 / (3.0 * inner))
    assert efficiency(0.0) == pytest.approx(1.0 - at_isco, rel=1e-6)
    assert efficiency(0.2) == pytest.approx(1.0 - at_isco + 0.2, rel=1e-6)
    assert disk_profile.page_thorne_flux(inner, spin, orbit, 0.2) > 0.0


def test_what_falls_in_goes_on_from_the_isco():
    made = {"spin": 0.0, "orbit": "prograde", "r_in": 3.0, "r_out": 10.0, "edge": 1.1}
    hot = disk_profile.temperature("page_thorne", np.array([1.05, 2.9999, 3.0, 3.0001]), torque=0.1, **made)
    assert hot[0] == 0.0 and hot[1] == pytest.approx(hot[2], rel=1e-3) and hot[3] == pytest.approx(hot[2], rel=1e-3) and hot[2] > 0.1
    assert np.all(disk_profile.temperature("page_thorne", np.array([1.5, 2.9]), **made) == 0.0), "without a torque there is no heat to take in"


@pytest.mark.parametrize("outer", [20.0, 100.0])
@pytest.mark.parametrize("law", ["page_thorne", "shakura_sunyaev", "tapered"])
def test_the_table_of_a_wide_disk_is_as_exact_as_that_of_a_narrow_one(law, outer):
    spin = 0.998
    inner = float(relativity.isco_radius(spin))
    values = disk_profile.table(law, spin, "prograde", inner, outer).astype(float)
    r = inner + (outer - inner) * np.linspace(0.01, 0.99, 20_001) ** 2
    place = np.sqrt((r - inner) / (outer - inner)) * len(values) - 0.5
    read = np.interp(place, np.arange(len(values)), values)
    exact = disk_profile.temperature(law, r, spin=spin, orbit="prograde", r_in=inner, r_out=outer)
    shines = exact > 0.2
    # A picture's half floats keep 5e-4; beside the edge where the two laws with one fall to 0 more is lost of less.
    assert np.quantile(np.abs((read[shines] / exact[shines]) ** 4 - 1.0), 0.99) < 2e-3


def test_errors_name_what_is_wrong():
    with pytest.raises(ValueError, match="tapered"):
        disk_profile.table("warm", 0.0, "prograde", 3.0, 10.0)
    with pytest.raises(ValueError, match="r_in"):
        disk_profile.table("tapered", 0.0, "prograde", 10.0, 10.0)
