"""The frequency shift of matter that moves in any way: GLSL against float64, and both against closed forms."""

from __future__ import annotations

from pathlib import Path

import moderngl
import numpy as np
import pytest

from blackhole_gl.physics import relativity
from blackhole_gl.physics.moving_matter import emitted_shift, own_time_squared
from tests.shaders.harness import Piece

COUNT = 2048
TEXT = """#version 330 core
#defines
#blocks
#include "common/hits.glsl"
#include "common/matter.glsl"
uniform sampler2D cases;
out vec4 o;
vec4 given(int k) { return texelFetch(cases, ivec2(gl_FragCoord.x, k), 0); }
void main() {
    Meeting met = Meeting(0, 0, 0, true, given(0).xyz, Momentum(given(2).w, given(2).xyz), vec3(0.0));
    o = vec4(emitted_shift(sight_of(met, vec2(1.0)), given(1).xyz));
}
"""


def _by_glsl(ctx: moderngl.Context, folder: Path, spin: float, flat: bool, cases: np.ndarray) -> np.ndarray:
    path = folder / "shift.frag"
    path.write_text(TEXT)
    root = np.sqrt((1.0 - spin) * (1.0 + spin))
    factors = (1.0 + root, spin * spin / (1.0 + root))
    piece = Piece(ctx, path, switches={"MEETINGS": 1, "SPACE_TIME_FLAT": int(flat)}, hole_spin=spin, hole_w_factors=factors)
    return piece.table("cases", cases, nearest=True).draw((COUNT, 1))[0, :, 0].astype(float)


def _cases(spin: float, flat: bool, place: np.ndarray, velocity: np.ndarray, direction: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """Texels (3, COUNT, 4) of place, velocity and momentum, and (k_r, k_θ, k_φ), of light whose k_r, k_θ/r and k_φ/(r sin θ) are `direction`."""
    r = 2.0 * np.linalg.norm(place, axis=-1)
    n = 2.0 * place / r[:, None]
    sine = np.hypot(n[:, 0], n[:, 1])
    e_phi = np.stack([-n[:, 1], n[:, 0], 0.0 * r], axis=-1) / sine[:, None]
    e_theta = np.cross(e_phi, n)
    k = direction * np.stack([np.ones_like(r), r, r * sine], axis=-1)
    fall = np.ones_like(r) if flat else 1.0 - 2.0 / r + (spin / r) ** 2
    rates = -(r * direction[:, 1])[:, None] * e_theta - (r * direction[:, 2])[:, None] * e_phi
    texels = np.zeros((3, COUNT, 4))
    texels[0, :, :3], texels[1, :, :3], texels[2] = place, velocity, np.concatenate([rates, (fall * direction[:, 0])[:, None]], axis=-1)
    return texels, k


@pytest.mark.parametrize("spin, flat", [(0.0, True), (0.0, False), (0.9, False), (-0.9, False), (0.998, False)])
def test_any_motion_anywhere_outside_the_ergosphere(ctx: moderngl.Context, tmp_path: Path, spin: float, flat: bool) -> None:
    """Speeds up to six tenths of what can be; 1e-4 is what is asked of g, 2e-5 what the disk's has."""
    rng = np.random.default_rng(3)
    place = rng.normal(size=(COUNT, 3))
    place *= (rng.uniform(1.3, 30.0, COUNT) / np.linalg.norm(place, axis=-1))[:, None]
    place, mass = place.astype(np.float32).astype(float), 0.0 if flat else 1.0
    velocity = rng.normal(size=(COUNT, 3))
    velocity *= (rng.uniform(0.0, 0.6, COUNT) * (1.0 - mass / np.linalg.norm(place, axis=-1)) / np.linalg.norm(velocity, axis=-1))[:, None]
    velocity = velocity.astype(np.float32).astype(float)
    direction = rng.normal(size=(COUNT, 3))
    direction /= np.linalg.norm(direction, axis=-1)[:, None]
    can = own_time_squared(place, velocity, spin, mass) > 0.02
    assert can.mean() > 0.9
    texels, k = _cases(spin, flat, place, velocity, direction)
    expected = emitted_shift(place, velocity, k, spin, mass)
    found = _by_glsl(ctx, tmp_path, spin, flat, texels)
    assert np.max(np.abs(found / expected - 1.0)[can]) < 2e-5


@pytest.mark.parametrize("spin", [0.0, 0.9])
@pytest.mark.parametrize("sense", ["prograde", "retrograde"])
def test_a_circular_geodesic_has_the_closed_form(ctx: moderngl.Context, tmp_path: Path, spin: float, sense: str) -> None:
    """From a tenth outside the innermost stable orbit to 40 r_s, for light of any direction: λ alone matters."""
    rng = np.random.default_rng(4)
    radius = float(relativity.isco_radius(spin, sense)) * np.geomspace(1.1, 20.0, COUNT)
    phi = rng.uniform(-np.pi, np.pi, COUNT)
    place = radius[:, None] * np.stack([np.cos(phi), np.sin(phi), 0.0 * phi], axis=-1)
    speed = radius * relativity.orbital_frequency(radius, spin, sense)
    velocity = speed[:, None] * np.stack([-np.sin(phi), np.cos(phi), 0.0 * phi], axis=-1)
    direction = rng.normal(size=(COUNT, 3))
    direction /= np.linalg.norm(direction, axis=-1)[:, None]
    texels, k = _cases(spin, False, place, velocity, direction)
    expected = relativity.circular_orbit_g(radius, k[:, 2], spin, sense)
    np.testing.assert_allclose(emitted_shift(place, velocity, k, spin), expected, rtol=1e-12)
    np.testing.assert_allclose(_by_glsl(ctx, tmp_path, spin, False, texels), expected, rtol=2e-5)


def test_matter_at_rest_has_the_redshift_of_its_place_and_what_moves_in_flat_space_has_dopplers() -> None:
    place, rest, k = np.array([2.0, 1.0, 0.5]), np.zeros(3), np.array([0.3, -0.2, 0.8])
    assert emitted_shift(place, rest, k, 0.0) == pytest.approx(np.sqrt(1.0 - 1.0 / np.linalg.norm(place)))
    theta = np.arccos(0.5 / np.linalg.norm(place))
    assert emitted_shift(place, rest, k, 0.9) == pytest.approx(float(relativity.static_lapse(np.linalg.norm(place), theta, 0.9)))
    outward = place / np.linalg.norm(place)
    assert emitted_shift(place, -0.6 * outward, np.array([1.0, 0.0, 0.0]), 0.0, mass=0.0) == pytest.approx(np.sqrt((1.0 - 0.6) / (1.0 + 0.6)))
