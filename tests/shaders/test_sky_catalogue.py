"""The sky of measured stars: all their light is in the picture, wherever they fall on its pixels and however it is bent; nothing is torn where cells meet."""

from __future__ import annotations

import math

import numpy as np
import pytest

from blackhole_gl.rendering import constellations, star_catalogue, star_index
from blackhole_gl.rendering.sky_attitude import attitude
from blackhole_gl.rendering.star_catalogue import Stars
from tests.shaders.harness import Piece
from tests.shaders.test_sky_procedural import SIZE, SNIPPET, VIEWS

LUMINANCE = np.array([0.2126, 0.7152, 0.0722])
"""A black body's is 1 at every temperature: with it light is what fluxes say."""
STAR_UNIT = 1.2e-4
"""Radiance × sr of a star of Hp = 0."""
DARK = np.zeros((6, star_index.TILE, star_index.TILE, 3))


def sky_of(ctx, path, made: star_index.Index) -> Piece:
    path.write_text(SNIPPET)
    piece = Piece(ctx, path, chosen={"sky": ["skies/catalogue.glsl"]}, energy=1.0, blur=1.0, squeeze=1.0)
    return piece.table("catalogue_cells", made.cells, nearest=True).table("catalogue_entries", made.entries, nearest=True).levels("catalogue_haze", made.haze)


def seen(piece: Piece, forward, turn=(0.0, 0.0), pixel: float = 1e-3, **more) -> np.ndarray:
    """Luminance (256, 256)."""
    f = np.asarray(forward, float) / np.linalg.norm(forward)
    side = np.cross([0.0, 0.0, 1.0] if abs(f[2]) < 0.9 else [1.0, 0.0, 0.0], f)
    side /= np.linalg.norm(side)
    above = np.cross(f, side)
    f = f + turn[0] * pixel * side + turn[1] * pixel * above
    piece.set(forward=tuple(f), side=tuple(side), above=tuple(above), pixel=pixel, **{"blur": 1.0, "energy": 1.0, **more})
    return piece.draw(SIZE)[..., :3].astype(float) @ LUMINANCE


@pytest.fixture(scope="module")
def whole(ctx, tmp_path_factory) -> Piece:
    """The sky as the program has it, without the galaxy."""
    return sky_of(ctx, tmp_path_factory.mktemp("sky") / "whole.frag", star_index.index(star_catalogue.continued(star_catalogue.hipparcos()), DARK))


@pytest.mark.parametrize("forward", VIEWS)
def test_a_lone_star_does_not_flicker_in_a_slow_turn(ctx, tmp_path, forward) -> None:
    """Its light in turns of a tenth of a pixel across 1.3 pixels, aslant: within 2 %; the kernel's own ripple on the pixel grid is 0.6 %."""
    star = np.asarray([forward], float) / np.linalg.norm(forward)
    piece = sky_of(ctx, tmp_path / "lone.frag", star_index.index(Stars(star, np.ones(1), np.full(1, 6000.0)), DARK))
    light = np.array([seen(piece, forward, (3.0 + 0.1 * k, 2.0 + 0.07 * k)).sum() for k in range(14)])
    assert light.max() / light.min() < 1.02
    assert light.mean() * 1e-6 == pytest.approx(STAR_UNIT, rel=0.005)


def test_the_whole_sky_shines_as_its_stars_do(whole: Piece) -> None:
    """Unlensed, all six sides of a cube: 0.5 % of the sum of all fluxes, which the catalogue's own are to three quarters. Some of it is haze at this pixel."""
    stars = star_catalogue.continued(star_catalogue.hipparcos())
    pixel = 2.0 / SIZE[0] / 4
    place = (np.arange(SIZE[0]) + 0.5 - SIZE[0] / 2) * pixel
    total = 0.0
    for axis in range(3):
        for sign in (-1.0, 1.0):
            forward = sign * np.eye(3)[axis]
            side = np.cross([0.0, 0.0, 1.0] if abs(forward[2]) < 0.9 else [1.0, 0.0, 0.0], forward)
            above = np.cross(forward, side)
            for x in (-0.75, -0.25, 0.25, 0.75):
                for y in (-0.75, -0.25, 0.25, 0.75):
                    whole.set(forward=tuple(forward + x * side + y * above), side=tuple(side), above=tuple(above), pixel=pixel, blur=1.0, energy=1.0)
                    light = whole.draw(SIZE)[..., :3].astype(float) @ LUMINANCE
                    r2 = 1.0 + (x + place[None, :]) ** 2 + (y + place[:, None]) ** 2
                    total += (light * pixel**2 / r2**1.5).sum()
    assert total == pytest.approx(STAR_UNIT * stars.flux.sum(), rel=0.005)


@pytest.mark.parametrize("squeeze", [0.5, 0.25])
def test_magnified_stars_are_brighter(ctx, tmp_path, squeeze: float) -> None:
    """A lens that squeezes the sky by s along one axis makes a star's light on the picture 1/s as much. 1 %: the star's own size, and the kernel's ripple."""
    star = np.array([[1.0, 0.0, 0.0]])
    piece = sky_of(ctx, tmp_path / "lone.frag", star_index.index(Stars(star, np.ones(1), np.full(1, 6000.0)), DARK))
    plain, lensed = (seen(piece, (1, 0, 0), squeeze=at).sum() for at in (1.0, squeeze))
    assert lensed == pytest.approx(plain / squeeze, rel=0.01)


@pytest.mark.parametrize("blur", [1.0, 3.0, 10.0, 40.0])
@pytest.mark.parametrize("forward", VIEWS[3:])
def test_wide_footprints_see_as_much_light(whole: Piece, forward, blur: float) -> None:
    """Across an edge and a corner of the cube, for footprints up to 0.04 rad in a view of 0.26 rad: as single stars, as a haze and in between. What is beyond
    the border comes in and what is within goes out: 25 %, where the brightest stars do."""
    piece = whole
    assert seen(piece, forward, blur=blur).sum() == pytest.approx(seen(piece, forward, blur=0.5).sum(), rel=0.25)


def test_nothing_is_torn_where_the_cubes_sides_meet(ctx, tmp_path) -> None:
    """A galaxy that is alike everywhere is alike in the picture of an edge and a corner, at every width of the footprint. 1 %: half floats."""
    even = np.full_like(DARK, 0.5)
    piece = sky_of(ctx, tmp_path / "even.frag", star_index.index(Stars(np.array([[0.0, 0.0, 1.0]]), np.full(1, 1e-6), np.full(1, 6000.0)), even))
    for forward in VIEWS[3:]:
        for blur in (1.0, 10.0, 300.0):
            found = seen(piece, forward, blur=blur, sky_catalogue_galaxy_brightness=1.0)
            assert found.max() < 1.01 * found.min() and found.min() > 0.0
    piece.set(sky_catalogue_galaxy_brightness=0.0)


@pytest.mark.parametrize("blur", [0.0, 1e-9, 1.0, 1e2, 1e6])
@pytest.mark.parametrize("forward", [(0, 0, 1), (0, 0, -1), (1, 0, 0), (0, 1, 0), (1, 1, 1)])
def test_every_direction_and_footprint_is_finite(whole: Piece, forward, blur: float) -> None:
    found = seen(whole, forward, blur=blur)
    assert np.isfinite(found).all() and (found >= 0.0).all()


def test_the_sky_is_turned_by_roll_then_pitch_then_yaw() -> None:
    """What a quaternion does, against the three turns one after the other."""
    yaw, pitch, roll = 40.0, -25.0, 70.0
    x, y, z, w = attitude(yaw, pitch, roll)
    found = np.array(
        [
            [1 - 2 * (y * y + z * z), 2 * (x * y - z * w), 2 * (x * z + y * w)],
            [2 * (x * y + z * w), 1 - 2 * (x * x + z * z), 2 * (y * z - x * w)],
            [2 * (x * z - y * w), 2 * (y * z + x * w), 1 - 2 * (x * x + y * y)],
        ]
    )
    (cz, sz), (cy, sy), (cx, sx) = ((math.cos(math.radians(a)), math.sin(math.radians(a))) for a in (yaw, pitch, roll))
    about_z, about_x = np.array([[cz, -sz, 0], [sz, cz, 0], [0, 0, 1]]), np.array([[1, 0, 0], [0, cx, -sx], [0, sx, cx]])
    up = np.array([[cy, 0, -sy], [0, 1, 0], [sy, 0, cy]])
    np.testing.assert_allclose(found, about_z @ up @ about_x, atol=1e-12)


@pytest.mark.parametrize("pixel", [2e-4, 1e-3])
def test_lines_of_figures_are_a_pixel_wide_at_every_scale_and_only_where_asked_for(ctx, tmp_path, pixel: float) -> None:
    """Across the line from Betelgeuse to Bellatrix its cover adds up to 1.1 pixels, the area of its triangle 1.21; 5 %: where pixels' middles are."""
    path = tmp_path / "lines.frag"
    path.write_text(SNIPPET)
    made = star_index.index(Stars(np.array([[0.0, 0.0, -1.0]]), np.full(1, 1e-9), np.full(1, 6000.0)), DARK)
    numbers, directions = star_catalogue.numbered()
    first, second = directions[numbers == 27989][0], directions[numbers == 25336][0]
    for shown in (0, 1):
        switches = {**constellations.CONSTANTS, "SKY_CATALOGUE_CONSTELLATIONS": shown}
        piece = Piece(ctx, path, chosen={"sky": ["skies/catalogue.glsl"]}, switches=switches, squeeze=1.0)
        piece.table("catalogue_cells", made.cells, nearest=True).table("catalogue_entries", made.entries, nearest=True).levels("catalogue_haze", made.haze)
        cells, lines = constellations.tables(np.array([first]), np.array([second]))
        piece.table("constellation_cells", cells, nearest=True).table("constellation_lines", lines, nearest=True)
        piece.set(sky_catalogue_line_brightness=1.0)
        found = seen(piece, first + second, pixel=pixel) / (np.array([0.03, 0.05, 0.09]) @ LUMINANCE)
        if not shown:
            assert found.max() < 1e-6
            continue
        slant = abs((second - first)[2]) / np.linalg.norm(second - first)  # rows against the line
        columns = found[:, 108:148].sum(axis=0).mean()
        assert columns == pytest.approx(1.21 / np.sqrt(1.0 - slant**2), rel=0.05)
