"""The stars of the procedural sky: as many, as bright and as far from their cells' borders as they should be; the shader names the same grids."""

from __future__ import annotations

import re

import numpy as np

from blackhole_gl.rendering import star_cells
from blackhole_gl.resources import shaders_dir


def test_the_shader_names_the_same_grids() -> None:
    text = (shaders_dir() / "skies" / "procedural.glsl").read_text(encoding="utf-8")
    grids = re.findall(r"StarGrid\(([\d.]+), ([\d.]+), ([\d.]+), ([\d.]+)\)", text)
    assert tuple((int(float(cells)), float(low), float(high)) for cells, _, low, high in grids) == star_cells.GRIDS
    assert int(re.search(r"^stars = (\d+)$", text, re.M)[1]) == len(grids)
    assert [int(float(row)) for _, row, _, _ in grids] == list(np.cumsum([0] + [cells for cells, _, _ in star_cells.GRIDS])[:-1])
    columns, rows = re.search(r"STAR_TEXEL = 1.0 / vec2\(([\d.]+), ([\d.]+)\)", text).groups()
    assert (float(rows), float(columns)) == star_cells.table().shape[:2]
    assert float(re.search(r"STAR_MARGIN = ([\d.]+)", text)[1]) == star_cells.MARGIN


def test_entries_are_unit_vectors_with_fluxes_and_temperatures_in_range() -> None:
    stars = star_cells.table()
    row = 0
    for cells, low, high in star_cells.GRIDS:
        part = stars[row : row + cells, : 6 * cells]
        row += cells
        np.testing.assert_allclose(np.linalg.norm(part[..., :3].astype(float), axis=-1), 1.0, atol=1e-6)
        there = part[..., 3] > 0.0
        flux = part[..., 3][there]
        assert low * (1.0 - 1e-3) <= flux.min() and flux.max() <= high * (1.0 + 1e-3)
        kelvin = star_cells.KELVIN_STEP * (np.ascontiguousarray(flux).view(np.uint32) & 1023)
        assert 2880 <= kelvin.min() and kelvin.max() <= 26400
        # N(>F) ∝ F^(−4/3): half of the stars are fainter than this.
        middle = (0.5 * (low ** (-4 / 3) + high ** (-4 / 3))) ** -0.75
        assert abs(np.mean(flux < middle) - 0.5) < 2.0 / np.sqrt(len(flux))


def test_stars_crowd_in_the_galaxys_plane() -> None:
    stars = star_cells.table().reshape(-1, 4)
    stars = stars[np.linalg.norm(stars[:, :3], axis=1) > 0.5]
    height = np.abs(stars[:, :3] @ star_cells.POLE)
    share = [np.mean(stars[(height >= a) & (height < b), 3] > 0.0) for a, b in ((0.0, 0.1), (0.8, 1.0))]
    assert 2.0 < share[0] / share[1] < 4.0
