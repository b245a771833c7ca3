"""The figures of the constellations: between stars that there are, and found by every ray beside them."""

from __future__ import annotations

import re

import numpy as np
import pytest

from blackhole_gl.rendering import constellations, sky_cube, star_catalogue
from blackhole_gl.resources import assets_dir, shaders_dir


@pytest.fixture(scope="module")
def ends() -> tuple[np.ndarray, np.ndarray]:
    return constellations.ends()


def test_lines_join_the_stars_that_they_name(ends: tuple[np.ndarray, np.ndarray]) -> None:
    """Orion's belt and shoulders are among them, and no line is longer than 45°."""
    pairs = {tuple(pair) for pair in np.load(assets_dir() / "constellations.npz")["pairs"].tolist()}
    assert {(25336, 27989), (26311, 26727)} <= pairs and len(pairs) == len(ends[0]) == 742
    numbers, directions = star_catalogue.numbered()
    assert set(np.unique(list(pairs))) <= set(numbers.tolist())
    betelgeuse = directions[numbers == 27989][0]
    assert np.abs(np.concatenate(ends) - betelgeuse).max(axis=1).min() == 0.0
    assert np.degrees(np.arccos(np.sum(ends[0] * ends[1], axis=1))).max() < 45.0


def test_rays_beside_a_line_find_it(ends: tuple[np.ndarray, np.ndarray]) -> None:
    """Places along every line, up to nine tenths of the reach beside it."""
    cells, lines = constellations.tables(*ends)
    rng = np.random.default_rng(4)
    pole, middle, cosine = lines[:, 0, :3].astype(float), lines[:, 1, :3].astype(float), lines[:, 1, 3].astype(float)
    turn = (rng.uniform(-0.98, 0.98, len(lines)) * np.arccos(cosine))[:, None]
    place = np.cos(turn) * middle + np.sin(turn) * np.cross(pole, middle) + rng.uniform(-0.9, 0.9, (len(lines), 1)) * constellations.REACH * pole
    face, u, v = sky_cube.place_of(place)
    x, y = (np.minimum((0.5 * (side + 1.0) * constellations.CELLS).astype(int), constellations.CELLS - 1) for side in (u, v))
    number = cells[y, face * constellations.CELLS + x, 0].astype(int)
    listed = [np.abs(lines[n // 16 : n // 16 + n % 16, 0, :3] - own).max(axis=1).min(initial=1.0) < 1e-6 for n, own in zip(number, pole)]
    assert np.mean(listed) > 0.995  # places are asked 0.004 rad apart: a cell's corner between two is missed


def test_the_shader_names_the_same_reach() -> None:
    text = (shaders_dir() / "skies" / "catalogue.glsl").read_text(encoding="utf-8")
    assert float(re.search(r"CONSTELLATION_REACH = ([\d.]+)", text)[1]) == constellations.REACH
