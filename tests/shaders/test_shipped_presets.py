"""Every shipped preset draws: no ray without a fate, no pixel that is not finite; and a mirrored scene has mirrored hits."""

from __future__ import annotations

import numpy as np
import pytest

from blackhole_gl.measure.scenes import is_charted
from blackhole_gl.physics.observer import is_moving
from blackhole_gl.planning import Plan, plan
from blackhole_gl.rendering import diagnostics
from blackhole_gl.rendering.frame import Renderer
from blackhole_gl.rendering.inputs import FrameInputs
from blackhole_gl.resources import presets_dir
from blackhole_gl.scene import Scene, presets
from tests.sampled import sampled

SIZE = (320, 180)
SHIPPED = [info for info in presets.available() if info.path.is_relative_to(presets_dir())]
WHOLE = [info.name for info in SHIPPED if info.group in ("physics", "scene")]
LOOKS = [info.name for info in SHIPPED if info.group == "look"]
QUALITIES = [info.name for info in SHIPPED if info.group in ("quality", "steps")]
SMALL = (160, 90)
# One scene of each way to bend light: others of it differ in what stands there. Straight rays are compared with none.
ALIKE = ("objects_undistorted", "objects_roessler", "objects_potential", "objects_refraction", "crystal_ball", "galaxies_through_a_hole")
BENT = [name for name in WHOLE if name not in ALIKE and presets.load([name]).rays.lensing]
# Of those that are marched through matter, or bend light as another does, one each always.
SEVERAL = ("cloudy_slab", "explosion", "fish_eye", "gold_2", "gold_3", "gold_4", "gold_5", "jet", "knot_behind_a_hole", "neutron_star", "polish_doughnut")
QUICK = [name for name in BENT if name not in SEVERAL]


def assert_sound(renderer: Renderer, scene: Scene) -> None:
    renderer.render(scene, 3.5, SIZE)
    hits = renderer.hits()
    assert np.count_nonzero(hits.fate == 0) == 0, "unresolved rays"
    for name in ("direction", "lambda_", "crossing"):
        assert np.all(np.isfinite(getattr(hits, name))), name
    assert np.all(np.isfinite(renderer.radiance()))
    length = np.linalg.norm(hits.direction, axis=-1)
    np.testing.assert_allclose(length, np.where(hits.fate == 1, 1.0, 0.0), atol=1e-6)
    picture = renderer.read_rgb8()
    assert picture.shape == (SIZE[1], SIZE[0], 3)
    assert picture.max() > 100 and picture.min() < 30, "a picture has light and dark"


@pytest.mark.parametrize("name", WHOLE)
def test_physics_and_scenes(renderer: Renderer, name: str) -> None:
    assert_sound(renderer, presets.load([name]))


def test_the_first_picture_of_a_disk_has_no_colour(renderer: Renderer) -> None:
    """But for the dither, which is off here."""
    renderer.render(presets.load(["luminet_1979"], {"post.dither": False}), 0.0, SIZE)
    picture = renderer.read_rgb8().astype(int)
    assert np.all(picture.max(axis=-1) == picture.min(axis=-1))
    assert picture.max() > 200


@pytest.mark.parametrize("look", LOOKS)
def test_looks(renderer: Renderer, look: str) -> None:
    assert_sound(renderer, presets.load(["kerr_06", look]))


@pytest.mark.parametrize("model", ["kerr_0998_85", "schwarzschild"])
@pytest.mark.parametrize("quality", QUALITIES)
def test_qualities(renderer: Renderer, model: str, quality: str) -> None:
    assert_sound(renderer, presets.load([model, quality]))


@pytest.mark.parametrize("name", sampled(BENT, QUICK))
def test_no_preset_leaves_a_ray_unresolved_at_the_coarsest_steps(renderer: Renderer, name: str) -> None:
    assert np.count_nonzero(_fates(renderer, plan(presets.load([name, "blackholegpu_low"])), SIZE) == 0) == 0


@pytest.mark.parametrize("name", sampled(BENT, QUICK))
def test_no_quality_draws_a_wrong_fate_or_the_plan_says_so(renderer: Renderer, name: str) -> None:
    """Against the most accurate method, beyond a pixel of the critical curve; levels of quality have no excuse. A look that names a model which is not exact is
    that model's: its own finest steps are the truth."""
    wrong: dict[str, int] = {}
    known: dict[tuple, np.ndarray] = {}  # levels differ in the picture more than in the rays

    def fates(made: Plan) -> np.ndarray:
        control = made.step_control.parameters if made.step_control else ()
        rays = made.method, made.max_steps, made.step_length, made.step_angle, *map(made.scene.get, control)
        if rays not in known:
            known[rays] = _fates(renderer, made)
        return known[rays]

    for quality in QUALITIES:
        made = plan(presets.load([name, quality]))
        exact = fates(diagnostics.most_accurate(made) if made.model.traits.exact else plan(presets.load([name, "reference"])))
        around = np.lib.stride_tricks.sliding_window_view(exact, (3, 3))
        clear = around.min(axis=(2, 3)) == around.max(axis=(2, 3))
        wrong[quality] = np.count_nonzero(clear & (fates(made) != exact)[1:-1, 1:-1])
        assert wrong[quality] == 0 or made.warnings, quality
    assert not any(wrong[info.name] for info in SHIPPED if info.group == "quality")


def _fates(renderer: Renderer, made: Plan, size: tuple[int, int] = SMALL) -> np.ndarray:
    renderer.hit_map.trace(FrameInputs.whole(made, 0.0, size))
    return renderer.hits().fate


def test_steps_that_are_lengthened_and_err_are_told(renderer: Renderer) -> None:
    report = renderer.render(presets.load(["gargantua_s1", "blackholegpu_low"]), 0.0, SMALL)
    assert "3.87 times longer than asked" in report.warnings[0] and "false" in report.warnings[0]
    assert not renderer.render(presets.load(["gargantua_s1"]), 0.0, SMALL).warnings


# Things stand on one side of the plane y = 0, fields are no holes that spin, and a camera on an orbit moves out of that plane.
STILL = [name for name in WHOLE if is_charted(scene := presets.load([name])) and not is_moving(scene.camera)]
MIRRORED = [(name, "blackholegpu_medium") for name in STILL] + [("kerr_0998_85", quality) for quality in QUALITIES]


@pytest.mark.parametrize("name, quality", MIRRORED)
def test_negative_spin_mirrors_the_hits(renderer: Renderer, name: str, quality: str) -> None:
    """a → −a is the reflection y → −y of the world, with the camera in the plane y = 0 that it leaves alone."""
    scene = presets.load([name, quality], {"camera.azimuth_deg": 0.0})
    spin = scene.hole.spin
    renderer.render(scene, 0.0, SIZE)
    hits = renderer.hits()
    renderer.render(scene.with_values({"hole.spin": -spin, "camera.roll_deg": -scene.camera.roll_deg, "camera.yaw_deg": -scene.camera.yaw_deg}), 0.0, SIZE)
    mirrored = renderer.hits()
    flip = np.array([1.0, -1.0, 1.0])
    np.testing.assert_array_equal(mirrored.fate[:, ::-1], hits.fate)
    np.testing.assert_array_equal(mirrored.steps[:, ::-1], hits.steps)
    np.testing.assert_allclose(mirrored.direction[:, ::-1] * flip, hits.direction, atol=1e-6)
    np.testing.assert_allclose(mirrored.crossing[:, ::-1] * flip[:2], hits.crossing, rtol=1e-5, atol=1e-6)
    np.testing.assert_allclose(-mirrored.lambda_[:, ::-1], hits.lambda_, rtol=1e-6, atol=1e-6)
