"""Kerr twice in float64: Kerr–Schild Hamiltonian against Carter's separated equations. They share no equation and no coordinate."""

from __future__ import annotations

import numpy as np
import pytest

from blackhole_gl import reference
from blackhole_gl.physics import deflection, observer, relativity

AWAY = 1e-3  # |ψ/ψ_c − 1| at least
BOUND = 1e-10  # rad: a thousandth of what float32 leaves, so that either form can be the shaders' truth
TOLERANCE = 3e-13

# Near the critical curve an error grows as its inverse distance, as 1/(ε √(1 − a²)) for spins near 1.
SPINS = (-0.9, -0.3, 0.0, 0.2, 0.6, 0.9, 0.95, 0.998)


def _angle(a: np.ndarray, b: np.ndarray) -> np.ndarray:
    return np.linalg.norm(a - b, axis=1)


def _both(spin: float, distance: float, inclination: float, count: int, seed: int, observer_kind: str = "static"):
    """Hits by both forms of `count` rays, half over the whole sky and half within 15 r_s of the hole, away from the critical curve."""
    rng = np.random.default_rng(seed)
    chi = rng.uniform(0.0, 2.0 * np.pi, count)
    reach = min(np.pi, 1.2 * np.arctan(15.0 / distance))
    share = rng.uniform(0.0, 1.0, count)
    psi = np.where(np.arange(count) % 2 == 0, np.arccos(1.0 - share * (1.0 - np.cos(reach))), share * np.pi)
    edge = relativity.shadow_angle(chi, distance, np.radians(inclination), spin, observer_kind)
    near = np.abs(psi / edge - 1.0) < AWAY
    psi = np.where(near, edge * (1.0 + np.sign(psi - edge) * (AWAY + share * 0.1)), psi)
    rays = observer.local_directions(psi, chi)
    given = dict(spin=spin, distance=distance, inclination_deg=inclination, azimuth_deg=40.0, observer=observer_kind, directions=rays, tolerance=TOLERANCE)
    return reference.trace("kerr", **given), reference.trace("kerr_schild", **given)


def _agree(count: int, seed: int) -> float:
    rng = np.random.default_rng(seed)
    worst = 0.0
    for k, spin in enumerate(SPINS):
        distance, inclination = float(np.exp(rng.uniform(np.log(2.0), np.log(1000.0)))), float(rng.uniform(1.0, 179.0))
        schild, mino = _both(spin, distance, inclination, count // len(SPINS), seed + k)
        np.testing.assert_array_equal(schild.fate, mino.fate)
        assert not np.any(schild.fate == reference.UNRESOLVED)
        np.testing.assert_array_equal(np.isnan(schild.crossing_r), np.isnan(mino.crossing_r))
        worst = max(worst, float(_angle(schild.direction, mino.direction).max()))
        # A crossing far out lies where a ray runs nearly along the plane: its error grows with r² there.
        off = np.abs(schild.crossing_r - mino.crossing_r) / np.maximum(1.0, schild.crossing_r) ** 2
        assert np.nanmax(off, initial=0.0) <= BOUND
    print(f"{count} rays: largest angle between the two forms {worst:.1e} rad")
    return worst


def test_two_thousand_random_rays():
    assert _agree(2000, 1) <= BOUND


@pytest.mark.slow
def test_ten_thousand_random_rays():
    assert _agree(10_000, 100) <= BOUND


def test_inside_the_ergosphere():
    """Where light of negative energy exists too."""
    schild, mino = _both(0.95, 0.8, 90.0, 200, 7, "zamo")
    np.testing.assert_array_equal(schild.fate, mino.fate)
    assert np.quantile(_angle(schild.direction, mino.direction), 0.99) <= BOUND


def test_parallel_rays():
    screen = np.random.default_rng(3).uniform(6.5, 15.0, (200, 2))
    given = dict(spin=0.9, distance=np.inf, inclination_deg=60.0, screen=screen, tolerance=TOLERANCE)
    schild, mino = (reference.trace(form, **given) for form in ("kerr", "kerr_schild"))
    assert np.all(schild.fate == reference.ESCAPED)
    assert _angle(schild.direction, mino.direction).max() <= BOUND
    np.testing.assert_allclose(schild.g, mino.g, rtol=1e-9)


@pytest.mark.parametrize("model", ["kerr", "kerr_schild", "schwarzschild_binet", "schwarzschild"])
def test_without_spin_the_deflection_is_the_elliptic_integral(model):
    b = np.array([2.62, 2.7, 3.0, 5.0, 20.0, 500.0])  # r_s
    found = reference.trace(model, spin=0.0, distance=np.inf, inclination_deg=90.0, screen=np.stack([2.0 * b, 0.0 * b], axis=1), tolerance=TOLERANCE)
    exact = deflection.exact(b)
    expected = np.stack([-np.cos(exact), -np.sin(exact), 0.0 * b], axis=1)
    assert _angle(found.direction, expected).max() <= BOUND
