"""The sky of one's own picture: each direction shows what is there, across the cube's edges and at the poles, and what a footprint holds is its mean."""

from __future__ import annotations

from collections.abc import Callable
from functools import lru_cache

import numpy as np
import pytest

from blackhole_gl.rendering import panorama_files
from blackhole_gl.rendering.frame import Renderer
from blackhole_gl.scene import presets
from tests.shaders.harness import Piece

SIZE = (48, 48)
SNIPPET = """#version 330 core
#defines
#blocks
#include "common/constants.glsl"
#slot sky
uniform vec3 forward, side, above;
uniform float pixel, energy;
uniform vec2 blur;
out vec4 o;
vec3 ray(vec2 place) {
    vec2 p = (place - 24.0) * pixel;
    return normalize(forward + p.x * side + p.y * above);
}
void main() {
    vec3 d = ray(gl_FragCoord.xy);
    o = vec4(sky_radiance(d, blur.x * (ray(gl_FragCoord.xy + vec2(1.0, 0.0)) - d), blur.y * (ray(gl_FragCoord.xy + vec2(0.0, 1.0)) - d), energy), 1.0);
}
"""
Light = Callable[[np.ndarray], np.ndarray]


@lru_cache
def levels(light: Light) -> tuple[np.ndarray, ...]:
    return panorama_files._levels(light, 448)


def drawn(ctx, folder, light: Light, forward, pixel: float, blur=(1.0, 1.0), energy: float = 1.0) -> tuple[np.ndarray, np.ndarray]:
    """(directions, picture), (48, 48, 3) each, of a sky whose light is a function of the direction."""
    (folder / "image.frag").write_text(SNIPPET)
    piece = Piece(ctx, folder / "image.frag", chosen={"sky": ["skies/image.glsl"]}).levels("sky_image_file", levels(light))
    f = np.asarray(forward, float) / np.linalg.norm(forward)
    side = np.cross([0.0, 0.0, 1.0] if abs(f[2]) < 0.9 else [1.0, 0.0, 0.0], f)
    side /= np.linalg.norm(side)
    above = np.cross(f, side)
    piece.set(forward=tuple(f), side=tuple(side), above=tuple(above), pixel=pixel, blur=blur, energy=energy)
    place = (np.arange(SIZE[0]) + 0.5 - 24.0) * pixel
    directions = f + place[None, :, None] * side + place[:, None, None] * above
    return directions / np.linalg.norm(directions, axis=-1, keepdims=True), piece.draw(SIZE)[..., :3].astype(float)


def smooth(direction: np.ndarray) -> np.ndarray:
    return (0.5 + 0.4 * direction).astype(np.float32)


@pytest.mark.parametrize("blur", [1.0, 8.0, 30.0])
@pytest.mark.parametrize("forward", [(1, 0.2, 0.1), (1, 1, 0.02), (1, 1, 1), (0, 0, 1), (0.02, 0, -1), (-1, 1, -1)])
def test_each_direction_shows_what_is_there(ctx, tmp_path, forward, blur: float) -> None:
    """Edges, corners and poles, for footprints up to a quarter of a rad. Half a per cent: half floats, and the mean of what bends; twice that at the widest."""
    directions, found = drawn(ctx, tmp_path, smooth, forward, 0.008, (blur, blur))
    assert np.abs(found - smooth(directions)).max() < (0.005 if blur < 30.0 else 0.01)


def stripes(direction: np.ndarray) -> np.ndarray:
    """Of longitude, 0.052 rad apart; the mean is ½."""
    light = 0.5 + 0.5 * np.sin(120.0 * np.arctan2(direction[..., 1], direction[..., 0]))
    return np.repeat(light[..., None], 3, axis=-1).astype(np.float32)


def test_a_long_footprint_blurs_along_its_length_alone(ctx, tmp_path) -> None:
    """Eight times as long as wide: the stripes that it lies along keep nine tenths of their contrast, those across it next to none."""
    contrast = {}
    for name, blur in (("round", (1.0, 1.0)), ("along", (1.0, 24.0)), ("across", (24.0, 1.0))):
        _, found = drawn(ctx, tmp_path, stripes, (1.0, 0.0, 0.0), 0.004, blur)
        contrast[name] = np.ptp(found[24, :, 0])
        assert found.mean() == pytest.approx(0.5, abs=0.05)
    assert contrast["round"] > 0.85 and contrast["along"] > 0.75 * contrast["round"] and contrast["across"] < 0.1


def grey(direction: np.ndarray) -> np.ndarray:
    return np.ones_like(direction, np.float32)


def test_light_goes_as_the_fourth_power_of_the_shift(ctx, tmp_path) -> None:
    """In luminance, which is 1 for black bodies of every temperature: of a grey sky it is exact, to 3 %, as colours are fitted."""
    weights = np.array([0.2126, 0.7152, 0.0722])
    plain, shifted = (drawn(ctx, tmp_path, grey, (1, 0, 0), 0.004, energy=e)[1][24, 24] for e in (1.0, 1.3))
    assert (shifted @ weights) / (plain @ weights) == pytest.approx(1.3**4, rel=0.03)
    assert shifted[2] / shifted[0] > plain[2] / plain[0]


@pytest.mark.parametrize("blur", [0.0, 1e-9, 1e2, 1e6])
def test_every_footprint_is_finite(ctx, tmp_path, blur: float) -> None:
    for forward in ((0, 0, 1), (1, 1, 1), (-1, 0, 0)):
        found = drawn(ctx, tmp_path, smooth, forward, 1e-3, (blur, blur))[1]
        assert np.isfinite(found).all() and 0.0 < found.min() and found.max() < 1.0


def test_the_program_hangs_a_file_round_its_scene(renderer: Renderer, tmp_path) -> None:
    """Straight light: the middle of the file is behind the hole, its east to the right; without a file the sky is dark."""
    path = tmp_path / "sky.npy"
    light = np.zeros((32, 64, 3), np.float32)
    light[:16, :, 1], light[:, 32:, 0], light[:, :, 2] = 0.5, 0.5, 0.1
    np.save(path, light)
    values = {"disk.enabled": False, "rays.lensing": False, "camera.inclination_deg": 90.0, "sky.model": "image", "sky.image.frequency_shift": False}
    scene = presets.load(["schwarzschild"], {**values, "camera.fov_deg": 60.0})
    renderer.render(scene.with_values({"sky.image.file": str(path)}), 0.0, (64, 64))
    found = renderer.radiance().astype(float)
    assert found[4, 60] == pytest.approx([0.5, 0.5, 0.1], abs=0.02) and found[4, 4] == pytest.approx([0.0, 0.5, 0.1], abs=0.02)
    assert found[60, 60] == pytest.approx([0.5, 0.0, 0.1], abs=0.02)
    renderer.render(scene, 0.0, (64, 64))
    assert renderer.radiance().max() == 0.0
