"""The stars of the sky `catalogue`: in their places and colours, continued without a step, each found by every ray that its kernel reaches, no light lost."""

from __future__ import annotations

import re

import numpy as np
import pytest

from blackhole_gl.rendering import sky_cube, star_catalogue, star_index
from blackhole_gl.rendering.star_catalogue import GALAXY_CENTRE, GALAXY_POLE, Stars
from blackhole_gl.resources import shaders_dir

DARK = np.zeros((6, star_index.TILE, star_index.TILE, 3))


def towards(ra_deg: float, dec_deg: float) -> np.ndarray:
    ra, dec = np.radians([ra_deg, dec_deg])
    return np.array([np.cos(dec) * np.cos(ra), np.cos(dec) * np.sin(ra), np.sin(dec)])


@pytest.fixture(scope="module")
def known() -> Stars:
    return star_catalogue.hipparcos()


@pytest.fixture(scope="module")
def continued(known: Stars) -> Stars:
    return star_catalogue.continued(known)


@pytest.fixture(scope="module")
def made(continued: Stars) -> star_index.Index:
    return star_index.index(continued, DARK)


@pytest.mark.parametrize(
    "rank, place, magnitude, kelvin",
    [(0, (101.2872, -16.7161), -1.09, (8500, 11000)), (1, (95.9880, -52.6957), -0.55, (6500, 8500)), (10, (88.7929, 7.4071), 0.55, (3000, 4200))],
    ids=["Sirius", "Canopus", "Betelgeuse"],
)
def test_bright_stars_stand_where_they_are(known: Stars, rank: int, place: tuple[float, float], magnitude: float, kelvin: tuple[int, int]) -> None:
    """Places of J2000 to 1.5 arc seconds, 7e-6 rad: the digits above."""
    star = int(np.argmax(known.direction @ towards(*place)))
    assert abs(star - rank) <= 2
    assert np.linalg.norm(known.direction[star] - towards(*place)) < 7e-6
    assert -2.5 * np.log10(known.flux[star]) == pytest.approx(magnitude, abs=0.1) and kelvin[0] < known.kelvin[star] < kelvin[1]


def test_the_galaxy_stands_where_it_is() -> None:
    for found, place in ((GALAXY_POLE, (192.8595, 27.1283)), (GALAXY_CENTRE, (266.405, -28.936))):
        np.testing.assert_allclose(found, towards(*place), atol=1e-5)
    assert abs(GALAXY_POLE @ GALAXY_CENTRE) < 1e-4


def test_the_law_continues_the_catalogue_without_a_step(known: Stars, continued: Stars) -> None:
    """N(>F) from half a magnitude before the join to where the law ends, in tenths: as it says after the join; nowhere is a jump. 6 %: 2,000 stars a bin."""
    assert len(known.flux) == 117_955
    magnitudes = -2.5 * np.log10(continued.flux)
    edges = np.arange(star_catalogue.WHOLE_TO - 0.5, star_catalogue.CONTINUED_TO + 0.01, 0.1)
    count = np.searchsorted(magnitudes, edges)
    after = edges >= star_catalogue.WHOLE_TO - 1e-6
    law = count[after][0] * 10.0 ** (0.4 * star_catalogue.LAW * (edges[after] - edges[after][0]))
    np.testing.assert_allclose(count[after], law, rtol=5e-3)  # bins of the law are wider than these
    steps = np.diff(count) / count[1:]
    assert np.abs(np.diff(steps)).max() < 0.06


def test_the_same_stars_are_added_every_time_and_crowd_in_the_galaxys_plane(known: Stars, continued: Stars) -> None:
    again = star_catalogue.continued(known)
    np.testing.assert_array_equal(again.direction, continued.direction)
    whole = np.searchsorted(-known.flux, -(10.0 ** (-0.4 * star_catalogue.WHOLE_TO)))
    alone = star_catalogue.continued(Stars(known.direction[:whole], known.flux[:whole], known.kelvin[:whole]))
    height = np.abs(alone.direction[whole:] @ GALAXY_POLE)
    assert 2.0 < np.mean(height < 0.1) / np.mean(height > 0.9) < 4.0


def cell_lists(made: star_index.Index, level: int) -> tuple[np.ndarray, np.ndarray]:
    """First entry and number of entries of each cell (row, column) of a grid."""
    row = sum(star_index.CELLS >> k for k in range(level))
    across = star_index.CELLS >> level
    number = made.cells[row : row + across, : 6 * across, 0].astype(int)
    return number // 16, number % 16


@pytest.mark.parametrize("level", range(star_index.LEVELS))
def test_every_ray_finds_the_stars_that_its_kernel_reaches(continued: Stars, made: star_index.Index, level: int) -> None:
    """Places about the brightest stars, out to a hundredth less than the reach: rims are asked in twelve places where they lie across a cube's edge."""
    rng = np.random.default_rng(level)
    star = np.arange(0, min(4000, np.searchsorted(-continued.flux, -(10.0 ** (-0.4 * min(star_index.FAINTEST[level], 9.0))))), 2)
    off = rng.standard_normal((len(star), 3))
    off -= np.sum(off * continued.direction[star], axis=1, keepdims=True) * continued.direction[star]
    off *= 0.96 * star_index.REACH * 2.0**level / np.linalg.norm(off, axis=1, keepdims=True)
    there = continued.direction[star] + off
    face, u, v = sky_cube.place_of(there / np.linalg.norm(there, axis=1, keepdims=True))
    across = star_index.CELLS >> level
    x, y = (np.minimum((0.5 * (place + 1.0) * across).astype(int), across - 1) for place in (u, v))
    first, count = (found[y, face * across + x] for found in cell_lists(made, level))
    entries = made.entries.reshape(-1, 4)
    lists = entries[first[:, None] + np.arange(star_index.MOST)]
    listed = np.abs(lists[..., :3] - continued.direction[star][:, None]).max(-1) < 1e-6
    found = (listed & (np.arange(star_index.MOST) < count[:, None])).any(axis=1)
    assert found.mean() > 0.995  # of a crowd the faintest are left to the haze


@pytest.mark.parametrize("level", [1, 3, 5])
def test_single_stars_and_haze_add_up_to_all_light(continued: Stars, made: star_index.Index, level: int) -> None:
    """0.5 %: cells at the cube's edges."""
    first, count = cell_lists(made, level)
    entries = made.entries.reshape(-1, 4)
    lists = [entries[a : a + n] for a, n in zip(first.ravel(), count.ravel()) if a > 0]
    single = np.unique(np.concatenate(lists), axis=0)
    tile = star_index.TILE >> level
    light = made.haze[level][..., 3].astype(float).reshape(2, tile, 3, tile)
    place = ((np.arange(tile) + 0.5) / tile * 2.0 - 1.0) * 8.0 / 7.0
    inside = np.abs(place) < 1.0
    area = sky_cube.solid_angle(place[None, :], place[:, None]) * (place[1] - place[0]) ** 2 * inside[None, :] * inside[:, None]
    haze = np.einsum("aybx,yx->", light, area)
    assert np.abs(single[:, 3].astype(float)).sum() + haze == pytest.approx(continued.flux.sum(), rel=0.005)
    assert haze > 0.05 * continued.flux.sum()


def test_the_shader_names_the_same_numbers() -> None:
    text = (shaders_dir() / "skies" / "catalogue.glsl").read_text(encoding="utf-8")
    assert float(re.search(r"CATALOGUE_REACH = ([\d.]+)", text)[1]) == star_index.REACH
    assert int(re.search(r"^stars = (\d+)$", text, re.M)[1]) == star_index.MOST


def test_entries_stay_within_what_a_float_counts(made: star_index.Index) -> None:
    assert made.cells.max() < 2**24 and made.entries.shape[1] == star_index.ROW
