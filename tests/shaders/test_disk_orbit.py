"""Frequency shifts in GLSL against their closed forms in float64."""

from __future__ import annotations

import numpy as np
import pytest

from tests.shaders.harness import Piece

SIZE = (64, 32)


def isco(a: float) -> float:
    """Prograde ISCO in M of a hole with spin `a` along the orbit (Bardeen, Press & Teukolsky 1972)."""
    z1 = 1 + (1 - a * a) ** (1 / 3) * ((1 + a) ** (1 / 3) + (1 - a) ** (1 / 3))
    z2 = np.sqrt(3 * a * a + z1 * z1)
    return 3 + z2 - np.sign(a) * np.sqrt((3 - z1) * (3 + z1 + 2 * z2))


def lambda_bounds(r: np.ndarray, a: float) -> tuple[np.ndarray, np.ndarray]:
    """λ of tangential photons, against and along the orbit: roots of (r² + a² − aλ)² = Δ(λ − a)². M = 1.

    In the ergosphere the lower one is unbounded; −10 stands in.
    """
    root = np.sqrt(r * r - 2 * r + a * a)
    high = (r * r + a * a + a * root) / (a + root)
    low = np.where(root > a, (r * r + a * a - a * root) / np.where(root > a, a - root, -1.0), -10.0)
    return np.maximum(low, -1e3), high


@pytest.fixture()
def shifts(ctx, tmp_path):
    """(spin, sense, radii in r_s float32, λ float32, function) → GLSL values of the function; with switches and uniforms of its own."""

    def run(spin: float, sense: float, radius: np.ndarray, lam: np.ndarray, function: str, switches=None, **uniforms) -> np.ndarray:
        path = tmp_path / "shift.frag"
        path.write_text(
            "#version 330 core\n#defines\n#blocks\n#include \"common/disk_orbit.glsl\"\n"
            "#define LIGHT DiskLight(c.y, c.z, vec2(1.0))\nuniform sampler2D cases;\nout vec4 o;\n"
            f"void main() {{ vec4 c = texelFetch(cases, ivec2(gl_FragCoord.xy), 0); o = vec4({function}, 0.0, 0.0); }}\n"
        )
        piece = Piece(ctx, path, switches=switches, hole_spin=spin, disk_spin_sign=sense, hole_spin_complement=1.0 - abs(spin), **uniforms)
        cases = np.stack([radius, lam, lam, lam], -1).reshape(SIZE[1], SIZE[0], 4)
        return piece.table("cases", cases, nearest=True).draw(SIZE)[..., :2].reshape(-1, 2)

    return run


@pytest.mark.parametrize("spin", [0.0, 0.5, 0.9, 0.998, 0.9999, -0.998])
@pytest.mark.parametrize("sense", [1.0, -1.0])
def test_exact_g(shifts, spin: float, sense: float) -> None:
    """2e-5 is the bound on g that README.md states; float32 input alone gives up to 1e-6 near the ISCO of a fast hole."""
    rng = np.random.default_rng(5)
    a = spin * sense
    count = SIZE[0] * SIZE[1]
    radius = (0.5 * isco(a) * np.geomspace(1.0 + 1e-6, 40.0, count)).astype(np.float32)
    x = np.sqrt(2.0 * radius.astype(float))
    low, high = lambda_bounds(x * x, a)
    lam = (sense * (low + (high - low) * rng.random(count))).astype(np.float32)
    orbit = x**3 + a
    exact = x**1.5 * np.sqrt(x**3 - 3 * x + 2 * a) / (orbit - sense * lam.astype(float))
    got = shifts(spin, sense, radius, lam, "disk_g(c.x, LIGHT, false), 0.0")[:, 0]
    assert np.isfinite(got).all()
    assert np.abs(got / exact - 1.0).max() <= 2e-5


def test_exact_g_is_s0_in_schwarzschild(shifts) -> None:
    """With a = 0 the exact g is δ √(1 − 1/r) with the local speed √(M/(r − 2M)). Both sides are float32: 2e-6."""
    radius = np.geomspace(3.0, 50.0, SIZE[0] * SIZE[1]).astype(np.float32)
    lam = (2.0 * radius * np.linspace(-0.9, 0.9, radius.size)).astype(np.float32)
    exact = shifts(0.0, 1.0, radius, lam, "disk_shift_exact(c.x, c.y)").prod(-1)
    s0 = shifts(0.0, 1.0, radius, lam, "disk_shift_s0(c.x, c.y)").prod(-1)
    np.testing.assert_allclose(exact, s0, rtol=2e-6)


def test_s1_formula(shifts) -> None:
    """γ(1 + β·n), β = √((M/r)(1 − 3M/r)), n_φ = λ √(1 − 1/r)/(2r); float32: 2e-6."""
    radius = np.geomspace(1.6, 50.0, SIZE[0] * SIZE[1])
    lam = 2.0 * radius * np.linspace(-0.9, 0.9, radius.size)
    beta = np.sqrt(0.5 / radius * (1.0 - 1.5 / radius))
    cosine = 0.5 * lam * np.sqrt(1.0 - 1.0 / radius) / radius
    expected = (1.0 + beta * cosine) / np.sqrt(1.0 - beta**2)
    got = shifts(0.0, 1.0, radius.astype(np.float32), lam.astype(np.float32), "disk_shift_s1(c.x, c.y)").prod(-1)
    np.testing.assert_allclose(got, expected, rtol=2e-6)


@pytest.mark.parametrize("function", ["disk_shift_exact", "disk_shift_s0", "disk_shift_s1"])
def test_shifts_are_finite_everywhere(shifts, function: str) -> None:
    """Inside the ISCO, at the horizon and for λ that no photon has: art may ask for it, and no pixel may be NaN."""
    radius = np.geomspace(0.5, 1e4, SIZE[0] * SIZE[1]).astype(np.float32)
    for lam in (-1e4, -5.0, 0.0, 5.0, 1e4):
        for spin in (0.0, 0.9999, -0.9999):
            got = shifts(spin, 1.0, radius, np.full_like(radius, lam), f"{function}(c.x, c.y)")
            assert np.isfinite(got).all() and (got >= 0.0).all()


@pytest.mark.parametrize("spin", [0.0, 0.9, 0.998, -0.6])
@pytest.mark.parametrize("sense", [1.0, -1.0])
def test_light_that_cannot_be_there_is_shifted_as_the_most_that_can(shifts, spin: float, sense: float) -> None:
    """λ up to ten times what r allows; 2e-4 as rounding of λ near its bound is divided by 1 − Ωλ, which is 0.06 at the ISCO of the fastest hole."""
    a, count = spin * sense, SIZE[0] * SIZE[1]
    radius = (0.5 * isco(a) * np.geomspace(1.001, 20.0, count)).astype(np.float32)
    most = lambda_bounds(2.0 * radius.astype(float), a)[1]
    beyond = (sense * most * np.linspace(1.0, 10.0, count)).astype(np.float32)
    at_most = shifts(spin, sense, radius, (sense * most).astype(np.float32), "disk_shift(c.x, LIGHT, false)")
    np.testing.assert_allclose(shifts(spin, sense, radius, beyond, "disk_shift(c.x, LIGHT, false)"), at_most, rtol=2e-4)
    assert np.all(at_most > 0.0) and np.all(np.isfinite(at_most))


def metric(r: np.ndarray, a: float) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """g_tt, g_tφ, g_φφ in the plane. M = 1."""
    return -(1.0 - 2.0 / r), np.full_like(r, -2.0 * a) / r, r * r + a * a * (1.0 + 2.0 / r)


def cases_along(a: float, sense: float, inner: float) -> tuple[np.ndarray, np.ndarray]:
    """Radii in r_s from `inner` ISCOs on and λ in M between those of tangential photons, float32."""
    count = SIZE[0] * SIZE[1]
    radius = (0.5 * isco(a) * inner * np.geomspace(1.0, 20.0, count)).astype(np.float32)
    low, high = lambda_bounds(2.0 * radius.astype(float), a)
    return radius, (sense * (low + (high - low) * np.random.default_rng(3).random(count))).astype(np.float32)


@pytest.mark.parametrize("spin", [0.0, 0.9, 0.998, -0.998])
@pytest.mark.parametrize("sense", [1.0, -1.0])
def test_the_cosine_between_light_and_matter_is_a_zamos(shifts, spin: float, sense: float) -> None:
    """p_φ/√g_φφ over the energy (1 − ωλ)/√(−g^tt). Float32: 1e-5 beside λ's own bound."""
    a = spin * sense
    radius, lam = cases_along(a, sense, 1.0)
    r, along = 2.0 * radius.astype(float), sense * lam.astype(float)
    g_tt, g_tp, g_pp = metric(r, a)
    lapse = np.sqrt(g_tp * g_tp / g_pp - g_tt)
    exact = along / np.sqrt(g_pp) * lapse / (1.0 + g_tp / g_pp * along)
    assert np.abs(exact).max() > 0.99
    np.testing.assert_allclose(shifts(spin, sense, radius, lam, "disk_approach(c.x, c.y), 0.0")[:, 0], exact, atol=2e-5)


@pytest.mark.parametrize("spin", [0.6, -0.6])
@pytest.mark.parametrize("sense", [1.0, -1.0])
def test_dragged_matter_has_the_g_of_its_rate(shifts, spin: float, sense: float) -> None:
    """1/(u^t (1 − Ωλ)) with Ω that of a circular orbit and the dragging's, 0.5 k a*/r³ (r in r_s). Float32: 2e-5, as the exact g."""
    a = spin * sense
    radius, lam = cases_along(a, sense, 1.5)
    r, along = 2.0 * radius.astype(float), sense * lam.astype(float)
    rate = 1.0 / (r**1.5 + a) + 0.5 * (0.5 * a * 1.5 / radius.astype(float) ** 3)
    g_tt, g_tp, g_pp = metric(r, a)
    clock = -g_tt - 2.0 * g_tp * rate - g_pp * rate * rate
    assert clock.min() > 0.05
    switches = {"RAYS_MODEL_KERR_LIKE": 1, "RAYS_KERR_LIKE_FLOW": 1}
    got = shifts(spin, sense, radius, lam, "disk_shift(c.x, LIGHT, false)", switches, rays_kerr_like_drag=1.5).prod(-1)
    np.testing.assert_allclose(got, np.sqrt(clock) / (1.0 - rate * along), rtol=2e-5)
