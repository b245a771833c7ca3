"""The procedural sky: stars keep their light under every turn of the camera, and nothing is torn at the cube's edges."""

from __future__ import annotations

import math

import numpy as np
import pytest

from blackhole_gl.rendering import galaxy_band
from tests.shaders.harness import Piece

SIZE = (256, 256)
PIXEL = 1.0e-3  # rad

SNIPPET = """#version 330 core
#defines
#blocks
#include "common/constants.glsl"
#slot sky
uniform vec3 forward, side, above;
uniform float pixel, energy, blur;
uniform float squeeze;  // how much finer the rays lie along the picture's rows: a lens's magnification
out vec4 o;
vec3 ray(vec2 place) {
    vec2 p = (place - 0.5 * vec2(SIZE)) * pixel;
    return normalize(forward + p.x * squeeze * side + p.y * above);
}
void main() {
    vec3 d = ray(gl_FragCoord.xy);
    float near;
    o = vec4(sky_radiance(d, blur * (ray(gl_FragCoord.xy + vec2(1.0, 0.0)) - d), blur * (ray(gl_FragCoord.xy + vec2(0.0, 1.0)) - d), energy, 1.0, near), 1.0);
}
""".replace("SIZE", f"{SIZE[0]}.0, {SIZE[1]}.0")


@pytest.fixture(scope="module")
def sky(ctx, tmp_path_factory):
    """(forward, turn in pixels (right, up), uniforms) → radiance (256, 256, 3)."""
    path = tmp_path_factory.mktemp("sky") / "sky.frag"
    path.write_text(SNIPPET)
    piece = Piece(ctx, path, chosen={"sky": ["skies/procedural.glsl"]})

    def run(forward, turn=(0.0, 0.0), pixel=PIXEL, energy=1.0, blur=1.0, squeeze=1.0, stars=1.0, galaxy=0.0) -> np.ndarray:
        f = np.asarray(forward, float) / np.linalg.norm(forward)
        side = np.cross([0.0, 0.0, 1.0] if abs(f[2]) < 0.9 else [1.0, 0.0, 0.0], f)
        side /= np.linalg.norm(side)
        above = np.cross(f, side)
        f = f + turn[0] * pixel * squeeze * side + turn[1] * pixel * above
        piece.set(sky_procedural_star_brightness=stars, sky_procedural_galaxy_brightness=galaxy)
        piece.set(forward=tuple(f), side=tuple(side), above=tuple(above), pixel=pixel, energy=energy, blur=blur, squeeze=squeeze)
        return piece.draw(SIZE)[..., :3].astype(float)

    return run


def lone_star(image: np.ndarray) -> tuple[int, int]:
    """Row and column of the brightest star that has no other within 9 pixels and lies 12 pixels from the border."""
    light = image.sum(-1)
    for flat in np.argsort(light[12:-12, 12:-12], axis=None)[::-1]:
        row, column = (int(k) + 12 for k in np.unravel_index(flat, (SIZE[1] - 24, SIZE[0] - 24)))
        around = light[row - 9 : row + 10, column - 9 : column + 10].copy()
        around[5:14, 5:14] = 0.0
        if around.max() < 1e-3 * light[row, column]:
            return row, column
    raise AssertionError("no star stands alone in this view")


VIEWS = [(1, 0.2, 0.1), (-1, 0.3, 0.15), (0.1, 0.2, -1), (1, 1, 0.02), (1, 1, 1)]  # the last two: an edge and a corner of the cube


@pytest.mark.parametrize("forward", VIEWS)
def test_a_star_does_not_blink_when_the_camera_turns(sky, forward) -> None:
    """One star's light, summed over its pixels, for turns of fractions of a pixel. 3 %: the kernel's own ripple on the pixel grid is 2 %."""
    row, column = lone_star(sky(forward))
    window = slice(row - 6, row + 7), slice(column - 6, column + 7)
    sums = [sky(forward, (dx, dy))[window].sum() for dx in (0.0, 0.25, 0.5, 0.75) for dy in (0.0, 0.3, 0.6)]
    assert max(sums) / min(sums) < 1.03


@pytest.mark.parametrize("forward", VIEWS)
def test_all_stars_together_do_not_shimmer(sky, forward) -> None:
    """The whole picture's light under a turn of half a pixel. 3 %: what enters and leaves at the border, of some hundred stars."""
    still, turned = sky(forward).sum(), sky(forward, (0.5, 0.5)).sum()
    assert turned == pytest.approx(still, rel=0.03)


@pytest.mark.parametrize("squeeze", [0.5, 0.25])
def test_magnified_stars_are_brighter(sky, squeeze: float) -> None:
    """A lens that squeezes the sky by s along one axis makes a star's light on the picture 1/s as much. 3 %: star's own size, kernel."""
    forward = VIEWS[0]
    row, column = lone_star(sky(forward))
    plain = sky(forward)[row - 6 : row + 7, column - 6 : column + 7].sum()
    # Turn so that the star stays near the middle of the squeezed picture.
    shift = (column + 0.5 - SIZE[0] / 2) / squeeze, row + 0.5 - SIZE[1] / 2
    lensed = sky(forward, shift, squeeze=squeeze)
    middle = lensed[SIZE[1] // 2 - 6 : SIZE[1] // 2 + 6, SIZE[0] // 2 - 8 : SIZE[0] // 2 + 8].sum()
    assert middle == pytest.approx(plain / squeeze, rel=0.03)


def test_wide_footprints_see_the_mean_of_the_stars(sky) -> None:
    """Stars seen one by one and stars seen as a haze give the same light. 30 %: some hundred stars whose fluxes follow a steep law."""
    views = [(math.cos(k), math.sin(k), 0.3 * math.cos(2.3 * k)) for k in range(12)]
    singly = np.mean([sky(v, pixel=8e-4).mean() for v in views])
    hazy = np.mean([sky(v, pixel=8e-4, blur=1e3).mean() for v in views])
    assert hazy == pytest.approx(singly, rel=0.3)


def test_blue_shift_brightens_as_the_fourth_power(sky) -> None:
    """Luminance of black bodies is 1 at all temperatures, so the ratio is exact up to rounding: 1e-3."""
    weights = np.array([0.2126, 0.7152, 0.0722])
    plain, shifted = (float((sky(VIEWS[0], energy=e) @ weights).sum()) for e in (1.0, 1.2))
    assert shifted / plain == pytest.approx(1.2**4, rel=1e-3)


@pytest.mark.parametrize("blur", [0.0, 1e-9, 1.0, 1e2, 1e6])
@pytest.mark.parametrize("forward", [(0, 0, 1), (0, 0, -1), (1, 0, 0), (0, 1, 0), (1, 1, 1), (-0.947063, 0.290589, 0.136495), (0.284464, 0.562425, 0.776375)])
def test_every_direction_and_footprint_is_finite(sky, forward, blur: float) -> None:
    found = sky(forward, blur=blur, galaxy=1.0)
    assert np.isfinite(found).all() and (found >= 0.0).all()


def test_the_band_wraps() -> None:
    """From the map's last column to its first the step is as from any column to the next."""
    root = galaxy_band.table().astype(float)
    steps = np.abs(np.diff(root, axis=1, append=root[:, :1])).mean(axis=(0, 2))
    assert steps[-1] <= steps[-40:].max() * 1.2
    assert root[[0, -1]].max() < 4.0  # and it fades to nothing where it ends
