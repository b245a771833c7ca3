"""BlackHoleGPU's animated sky: specks of the size and number that its formula gives, turning and drifting at its rates, hours later too."""

from __future__ import annotations

import math

import numpy as np
import pytest

from blackhole_gl.rendering import drifting_field
from blackhole_gl.rendering.frame import Renderer
from blackhole_gl.scene import presets
from tests.shaders.harness import Piece

SIZE = (128, 128)
SNIPPET = """#version 330 core
#defines
#blocks
#slot sky
uniform vec3 forward;
uniform float pixel, blur;
out vec4 o;
vec3 ray(vec2 place) { return forward + vec3(0.0, (place - 64.0) * pixel); }
void main() {
    vec3 d = ray(gl_FragCoord.xy);
    o = vec4(sky_radiance(d, vec3(0.0, blur * pixel, 0.0), vec3(0.0, 0.0, blur * pixel), 1.0), 1.0);
}
"""
ASIDE = 1.01371, 0.00713, 0.00519
"""In no plane of the lattice, where the noise is not what it is elsewhere."""
SPECK = {"sky_drifting_field_scale": 80.0, "sky_drifting_field_threshold": 0.88, "sky_drifting_field_brightness": 1.0}


@pytest.fixture(scope="module")
def field(ctx, tmp_path_factory):
    """(time, pixel, footprint in pixels) → the blue light (128, 128) of a flat piece of the field, its rate of turning 0.02 and drift 1."""
    path = tmp_path_factory.mktemp("field") / "field.frag"
    path.write_text(SNIPPET)
    piece = Piece(ctx, path, chosen={"sky": ["skies/drifting_field.glsl"]}, **SPECK)

    def run(time: float, pixel: float = 2e-3, blur: float = 0.0, rate: float = 0.02, drift: float = 1.0, forward=ASIDE, threshold: float = 0.88):
        numbers = {"cell": drifting_field.cell(time, drift, 80.0), "shift": drifting_field.shift(time, drift, 80.0), "turn": drifting_field.turn(time, rate)}
        piece.set(**{f"drifting_field_{name}": tuple(float(n) for n in value) for name, value in numbers.items()})
        piece.set(pixel=pixel, blur=blur, forward=forward, sky_drifting_field_threshold=threshold)
        return piece.draw(SIZE)[..., 2].astype(float)

    return run


def test_as_many_specks_shine_as_the_noise_has_high_places(field) -> None:
    """0.8 % of the sky, which a float64 noise of the same kind has, with a mean of 9.4e-4. 25 %: some hundred specks, on planes through the lattice."""
    found = np.concatenate([field(0.0, 0.02, forward=(1.01371 + 1.0173 * k, 3.0139 * k, 0.00519)).ravel() for k in range(16)])
    assert found.max() <= 1.0 and found.min() == 0.0
    assert np.mean(found > 0.0) == pytest.approx(0.0082, rel=0.25) and found.mean() == pytest.approx(9.4e-4, rel=0.25)


def test_it_drifts_as_far_as_it_should(field) -> None:
    """After 10 time units it is the field from (0.05, 0.03, 0) farther on. Half a per cent of full light: 32-bit places."""
    farther = tuple(np.array(ASIDE) + 10.0 * drifting_field.VELOCITY)
    np.testing.assert_allclose(field(10.0, rate=0.0), field(0.0, rate=0.0, forward=farther), atol=5e-3)
    assert field(10.0, rate=0.0).max() > 0.1


def test_it_turns_about_the_axis_at_its_rate(field) -> None:
    """By 0.02 in one time unit: 10 pixels of 2 mrad."""
    before, turned = field(0.0, drift=0.0), field(1.0, drift=0.0)
    assert abs(max(range(-24, 25), key=lambda k: (before[:, 24 + k : 104 + k] * turned[:, 24:104]).sum()) - 10) <= 1


def test_hours_later_it_moves_as_smoothly(field) -> None:
    """After a million time units steps of a twentieth of one change the picture as they do at first: neither by nothing nor all at once."""
    changes = [np.abs(field(start + 0.05 * (k + 1)) - field(start + 0.05 * k)).sum() for start in (0.0, 1e6) for k in range(4)]
    assert max(changes) < 4.0 * min(changes) and min(changes) > 0.0


def test_whole_cells_and_what_is_left_make_up_the_way() -> None:
    for time in (0.0, 3.7, 1e5, -12.0):
        cell, shift = drifting_field.cell(time, 1.5, 80.0)[:3], drifting_field.shift(time, 1.5, 80.0)[:3]
        np.testing.assert_allclose(cell - cell.sum() / 6.0 + shift, 80.0 * 1.5 * time * drifting_field.VELOCITY, atol=1e-9)
        assert np.abs(shift).max() < 2.0 and np.array_equal(cell, np.round(cell))
    assert drifting_field.turn(1e6, 0.02) == pytest.approx([math.cos(2e4), math.sin(2e4)], abs=1e-9)


@pytest.mark.parametrize("threshold", [0.6, 0.8, 0.88])
def test_wide_footprints_see_the_mean(field, threshold: float) -> None:
    """15 %: the fitted mean, and some hundred specks."""
    single = np.mean([field(0.0, 0.02, forward=(1.01371 + 1.0173 * k, 3.0139 * k, 0.00519), threshold=threshold).mean() for k in range(12)])
    wide = field(0.0, 0.02, blur=50.0, threshold=threshold)
    assert np.ptp(wide) < 1e-6 and wide.mean() == pytest.approx(single, rel=0.15)
    assert np.isfinite(field(0.0, 0.02, blur=1e8)).all()


def test_time_changes_the_kept_picture_of_a_resting_camera(renderer: Renderer) -> None:
    """The sky of a scene that rests is kept; this one is drawn anew at every time."""
    values = {"disk.enabled": False, "rays.model": "schwarzschild", "camera.fov_deg": 4.0, "camera.yaw_deg": 40.0}
    scene = presets.load(["schwarzschild"], {**values, "sky.model": "drifting_field", "sky.drifting_field.brightness": 10.0})
    found = []
    for time in (0.0, 1.0, 2.0, 3.0, 0.0):
        renderer.render(scene, time, (96, 54))
        found.append(renderer.radiance())
    assert all(not np.array_equal(a, b) for a, b in zip(found, found[1:]))
    np.testing.assert_array_equal(found[0], found[-1])
