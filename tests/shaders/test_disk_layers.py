"""Look layers: no seam, no winding up, mean density kept, finite whatever the footprint."""

from __future__ import annotations

import math

import numpy as np
import pytest

from blackhole_gl.physics.shear import RENEWAL_PERIOD, shear_phases
from tests.shaders.harness import Piece

LAYERS = ("turbulence", "point_field", "lanes", "micro_turbulence", "dust")
WIDTH, HEIGHT = 512, 128
TEN_HOURS = 36_000.0 * 4.0

SNIPPET = """#version 330 core
#defines
#blocks
#include "common/noise.glsl"
#include "common/disk_orbit.glsl"
#include "common/disk_matter.glsl"
#slots disk_layer
uniform vec2 azimuths;   // from, to
uniform vec2 radii;
uniform vec2 footprint;
uniform float approach, doppler;
out vec4 o;
void main() {
    vec2 place = gl_FragCoord.xy / vec2(SIZE);
    float phi = mix(azimuths.x, azimuths.y, place.x);
    DiskMatter matter = DiskMatter(mix(radii.x, radii.y, place.y), vec2(cos(phi), sin(phi)), footprint, approach, doppler, 1.0, 1.0);
#each disk_layer : matter = disk_layer_$key(matter);
    o = vec4(matter.density, matter.gain, 0.0, 1.0);
}
""".replace("SIZE", f"{WIDTH}.0, {HEIGHT}.0")


@pytest.fixture()
def density(ctx, tmp_path):
    """(layer, time, azimuths, radii, footprint, uniforms) → density (HEIGHT, WIDTH)."""
    path = tmp_path / "layer.frag"
    path.write_text(SNIPPET)

    def run(layer: str, time: float = 0.0, azimuths=(0.0, 2 * math.pi), radii=(3.2, 9.8), footprint=(2e-3, 2e-3), **uniforms) -> np.ndarray:
        ages, weights, seeds = shear_phases(time)
        piece = Piece(ctx, path, chosen={"disk_layer": [f"disks/{layer}.glsl"]}, shear_phase=(*ages, *weights), shear_seed=(*seeds, 0.0, 0.0), **uniforms)
        return piece.set(azimuths=azimuths, radii=radii, footprint=footprint).draw((WIDTH, HEIGHT))[..., 0]

    return run


@pytest.mark.parametrize("layer", LAYERS)
def test_no_seam(density, layer: str) -> None:
    """Across φ = ±π the density changes no more than across any other azimuth."""
    step = 1e-3
    span = step * WIDTH / 2
    at_seam = np.abs(np.diff(density(layer, 7.0, (math.pi - span, math.pi + span)), axis=1))
    elsewhere = np.abs(np.diff(density(layer, 7.0, (1.0 - span, 1.0 + span)), axis=1))
    middle = at_seam[:, WIDTH // 2 - 2 : WIDTH // 2 + 2].max()
    assert middle <= max(at_seam.max(), elsewhere.max())
    assert middle <= 3.0 * np.quantile(at_seam, 0.99) + 1e-3  # a seam would be a jump in nearly every row


@pytest.mark.parametrize("layer", LAYERS)
def test_ten_hours_in_looks_like_the_first_second(density, layer: str) -> None:
    """Contrast and the finest radial detail, averaged over a pattern's life, are as at the start. 15 %: eight draws of a random pattern."""

    def statistics(start: float) -> np.ndarray:
        maps = [density(layer, start + RENEWAL_PERIOD * k / 8) for k in range(8)]
        return np.array([np.mean([m.std() for m in maps]), np.mean([np.abs(np.diff(m, axis=0)).mean() for m in maps])])

    np.testing.assert_allclose(statistics(TEN_HOURS), statistics(0.0), rtol=0.15)


@pytest.mark.parametrize("layer", LAYERS)
def test_no_jump_when_a_pattern_is_renewed(density, layer: str) -> None:
    """Weights near a renewal are sin²: 1e-3 of a period on either side of it the new pattern has weight 1e-5."""
    at = 5 * RENEWAL_PERIOD
    before, after = density(layer, at - 1e-3 * RENEWAL_PERIOD), density(layer, at + 1e-3 * RENEWAL_PERIOD)
    moved = np.abs(density(layer, at + 3e-3 * RENEWAL_PERIOD) - after).mean()  # the same step of time without a renewal
    assert np.abs(after - before).mean() <= 1.5 * moved + 1e-3


@pytest.mark.parametrize("layer", LAYERS)
def test_mean_is_near_one(density, layer: str) -> None:
    """So that a layer changes the look of the disk and not its light. A quarter: large eddies are few; points favour small radii."""
    mean = np.mean([density(layer, t).mean() for t in (0.0, 20.0, 40.0, 60.0)])
    assert mean == pytest.approx(1.0, abs=0.25)


@pytest.mark.parametrize("layer", LAYERS)
@pytest.mark.parametrize("footprint", [(0.0, 0.0), (1e-6, 1e3), (1e6, 1e6)])
def test_any_footprint_gives_a_finite_density(density, layer: str, footprint: tuple[float, float]) -> None:
    found = density(layer, 11.0, footprint=footprint)
    assert np.isfinite(found).all() and (found >= 0.0).all()


@pytest.mark.parametrize("layer", ["turbulence", "lanes", "micro_turbulence", "dust"])
def test_what_cannot_be_resolved_fades_out(density, layer: str) -> None:
    """A pixel wider than every eddy sees the smooth disk; float32 exp leaves 1e-6."""
    np.testing.assert_allclose(density(layer, footprint=(20.0, 20.0)), 1.0, atol=1e-5)


@pytest.mark.parametrize("layer", ["turbulence", "lanes", "micro_turbulence", "dust"])
def test_a_layer_has_the_same_mean_however_wide_the_pixels_are(density, layer: str) -> None:
    """From pixels that resolve all to ones that resolve nothing, over four lives of the patterns. 4 %: few large eddies."""
    means = [np.mean([density(layer, 30.0 + RENEWAL_PERIOD * k, footprint=(f, f)).mean() for k in range(4)]) for f in (1e-4, 3e-3, 1e-2, 3e-2, 0.1, 0.3)]
    np.testing.assert_allclose(means, 1.0, atol=0.04)


def test_speed_zero_stands_still(density) -> None:
    """Away from a renewal a pattern that does not orbit only fades over: the eddies stay where they are."""
    first, second = (density("turbulence", t, disk_noise_speed=0.0) for t in (47.9, 48.1))
    np.testing.assert_allclose(first, second, atol=0.1 * first.std())


def test_the_pattern_turns_with_the_matter(density) -> None:
    """After a short time the pattern at one radius is the earlier one, turned by Ω·Δt·speed in the sense of the orbit."""
    radius, step = 5.0, 1.0
    omega = math.sqrt(0.5 / radius**3)
    for sense in (1.0, -1.0):
        facts = dict(radii=(radius, radius), disk_spin_sign=sense, disk_turbulence_eddy_rate=0.0)
        before = density("turbulence", 47.5, **facts)[0]
        shift = sense * omega * step
        after = density("turbulence", 48.5, (shift, shift + 2 * math.pi), **facts)[0]
        # 0.99: in one of 96 units the two patterns' weights change by 3e-2 at most near a maximum
        assert np.corrcoef(before, after)[0, 1] > 0.99


FINER = 4


@pytest.mark.parametrize("layer", ["lanes", "micro_turbulence", "dust"])
def test_a_pattern_finer_than_a_pixel_is_nearer_its_mean_for_the_fading(density, layer: str) -> None:
    """Against the mean of 16 places in each pixel of 0.03 rad, root mean square: less than 0.6 of the difference without fading (0.37 to 0.47)."""
    wide = 0.03

    def drawn(right: float, up: float, own: float) -> np.ndarray:
        low, turned = 3.2 * (1.0 + wide * up), wide * right
        return density(layer, 40.0, (turned, turned + WIDTH * wide), (low, low + HEIGHT * 0.3 * 3.2 * wide), (0.23 * own, own))

    shifts = [(k + 0.5) / FINER - 0.5 for k in range(FINER)]
    mean = np.mean([drawn(x, y, wide / FINER) for x in shifts for y in shifts], axis=0)
    faded, raw = (float(np.sqrt(np.mean((drawn(0.0, 0.0, own) - mean) ** 2))) for own in (wide, 0.0))
    assert faded < 0.6 * raw, (faded, raw)


@pytest.mark.parametrize("footprint, bound", [((4e-3, 4e-3), 0.42), ((1.2e-2, 2e-3), 0.95)], ids=str)
def test_points_and_rings_finer_than_a_pixel_are_their_mean(density, footprint: tuple[float, float], bound: float) -> None:
    """Against the mean of 16 places in each pixel, each with a sixteenth of it for its own: root mean square difference, over a mean density of 1.

    What one place cannot tell of a random pattern remains. What was seen was the rest: points that had grown beyond their cells and were cut off there drew
    the lattice, and boosted rings were taken at the middle of the pixel alone (0.47 and 1.08; now 0.37 and 0.82).
    """

    def drawn(right: float, up: float, own: tuple[float, float]) -> np.ndarray:
        low = 3.5 * (1.0 + footprint[0] * up)
        turned = footprint[1] * right
        radii = low, low * (1.0 + HEIGHT * footprint[0])  # nearly even steps of ln r
        return density("point_field", 40.0, (turned, turned + WIDTH * footprint[1]), radii, own, disk_point_field_turbulence=0.0)

    shifts = [(k + 0.5) / FINER - 0.5 for k in range(FINER)]
    mean = np.mean([drawn(x, y, (footprint[0] / FINER, footprint[1] / FINER)) for x in shifts for y in shifts], axis=0)
    found = float(np.sqrt(np.mean((drawn(0.0, 0.0, footprint) - mean) ** 2)))
    assert found < bound, found
