"""Labels lie where the picture has what they name."""

from __future__ import annotations

import subprocess
import sys
import tracemalloc

import numpy as np
import pytest
from PIL import Image

from blackhole_gl.glsl.declared import Fate
from blackhole_gl.rendering import labels, sheet
from blackhole_gl.rendering.annotation import annotated
from blackhole_gl.rendering.frame import Renderer
from blackhole_gl.rendering.sheet import pieces
from blackhole_gl.rendering.views import view_of
from blackhole_gl.scene import Scene, presets

SIZE = (240, 150)
LOOKS = ({}, {"camera.yaw_deg": 6.0, "camera.pitch_deg": -4.0, "camera.roll_deg": 35.0})


def in_pixels(places: np.ndarray, size: tuple[int, int] = SIZE) -> np.ndarray:
    """Places (N, 2) of labels in pixels from the bottom left."""
    return np.column_stack([size[1] * places[:, 0], size[1] * (1.0 - places[:, 1])])


def inside(polygon: np.ndarray, size: tuple[int, int] = SIZE) -> np.ndarray:
    """Which pixels' middles lie in a closed polygon (N, 2), bool (height, width)."""
    x, y = np.meshgrid(np.arange(size[0]) + 0.5, np.arange(size[1]) + 0.5)
    found = np.zeros(x.shape, bool)
    for (x0, y0), (x1, y1) in zip(polygon, polygon[1:]):
        between = (y0 > y) != (y1 > y)
        with np.errstate(divide="ignore", invalid="ignore"):
            found ^= between & (x < x0 + (y - y0) * (x1 - x0) / (y1 - y0))
    return found


def distances(points: np.ndarray, polygon: np.ndarray) -> np.ndarray:
    """Of points (M, 2) from a polygon's sides, (M,)."""
    start, way = polygon[:-1], np.diff(polygon, axis=0)
    along = ((points[:, None] - start) * way).sum(-1) / np.maximum((way**2).sum(-1), 1e-30)
    nearest = start + np.clip(along, 0.0, 1.0)[..., None] * way
    return np.linalg.norm(points[:, None] - nearest, axis=-1).min(axis=1)


def most_off(curve: np.ndarray, mask: np.ndarray) -> float:
    """Distance in pixels of the farthest pixel's middle on the wrong side of a closed curve, 0 where there is none."""
    wrong = np.argwhere(inside(curve) != mask)[:, ::-1] + 0.5
    return float(distances(wrong, curve).max(initial=0.0))


@pytest.mark.parametrize("look", LOOKS, ids=["ahead", "aside"])
@pytest.mark.parametrize("inclination", [0.0, 17.0, 60.0, 90.0, 130.0])
@pytest.mark.parametrize("spin", [0.0, 0.9, 0.998, -0.998])
def test_the_critical_curve_is_the_edge_of_the_fates(renderer: Renderer, spin: float, inclination: float, look: dict) -> None:
    """Within half a pixel; a fifth leaves room for no more than the curve's own corners and float32."""
    values = {"hole.spin": spin, "camera.inclination_deg": inclination, "camera.distance": 12.0, "camera.fov_deg": 40.0, **look}
    scene = presets.load(["kerr", "reference"], values)
    renderer.render(scene, 0.0, SIZE)
    captured = renderer.hits().fate == Fate.CAPTURED
    curve = in_pixels(labels.of(scene, SIZE[0] / SIZE[1]).curves[0].places)
    assert captured.sum() > 500
    assert most_off(curve, captured) < 0.2


@pytest.mark.parametrize(
    "values",
    [
        {"camera.distance": float("inf"), "camera.roll_deg": 20.0},
        {"camera.distance": 2.5, "camera.fov_deg": 110.0},
        {"rays.model": "schwarzschild", "hole.spin": 0.0},
    ],
)
def test_it_is_so_from_afar_and_from_near_and_for_other_exact_models(renderer: Renderer, values: dict) -> None:
    scene = presets.load(["kerr", "reference"], values)
    renderer.render(scene, 0.0, SIZE)
    curve = in_pixels(labels.of(scene, SIZE[0] / SIZE[1]).curves[0].places)
    assert most_off(curve, renderer.hits().fate == Fate.CAPTURED) < 0.2


@pytest.mark.parametrize("look", LOOKS, ids=["ahead", "aside"])
def test_outlines_of_circles_are_those_of_the_crossings(renderer: Renderer, look: dict) -> None:
    """Innermost stable orbit and rings: inside its outline a pixel's crossing of that order, if it has one, lies nearer to the hole."""
    scene = presets.load(["kerr", "reference"], {"camera.inclination_deg": 60.0, "camera.fov_deg": 25.0, **look})
    renderer.render(scene, 0.0, SIZE)
    crossing = renderer.hits().crossing
    curves = labels.of(scene, SIZE[0] / SIZE[1]).curves
    radius = 1.160
    for order, curve in enumerate(curves[1:]):
        r = np.hypot(crossing[..., order, 0], crossing[..., order, 1])
        outside = r > 1.0 * radius
        polygon = in_pixels(curve.places)
        far = distances(np.argwhere(outside | (r > 0.0))[:, ::-1] + 0.5, polygon) > 0.5
        picked = np.argwhere(outside | (r > 0.0))[far]
        within = inside(polygon)[picked[:, 0], picked[:, 1]]
        np.testing.assert_array_equal(within, ~outside[picked[:, 0], picked[:, 1]])
        assert within.any() or order


def test_sides_tell_g_and_stand_on_the_side_that_comes_near() -> None:
    names = {name.text.split(",")[0]: name for name in labels.of(presets.load(["kerr"]), 1.6).names}
    assert names["approaching side"].at[0] < 0.8 < names["receding side"].at[0], "prograde matter comes towards the camera on the left"
    other = {name.text.split(",")[0]: name for name in labels.of(presets.load(["kerr"], {"disk.orbit": "retrograde", "camera.distance": 30.0}), 1.6).names}
    assert other["approaching side"].at[0] > 0.8 > other["receding side"].at[0]


def test_what_is_not_there_has_no_name() -> None:
    bare = labels.of(presets.load(["kerr"], {"disk.enabled": False}), 1.6)
    assert [name.text.split()[0] for name in bare.names] == ["shadow,", "innermost", "centre"]
    away = labels.of(presets.load(["kerr"], {"camera.yaw_deg": 170.0}), 1.6)
    assert not away.names and not any(len(pieces(curve.places)) for curve in away.curves)
    near = labels.of(presets.load(["kerr"], {"camera.distance": 1.1}), 1.6)
    assert len(near.curves) == 1, "from inside the innermost stable orbit its image is no closed curve"


@pytest.mark.parametrize(
    "values",
    [{"rays.model": "weak_field", "hole.spin": 0.0}, {"rays.lensing": False}, {"rays.model": "schwarzschild", "hole.spin": 0.0, "hole.gravity_strength": 2.0}],
)
def test_without_closed_forms_it_says_so(values: dict) -> None:
    found = labels.of(presets.load(["kerr"], values), 1.6)
    assert found.note.startswith("No labels") and not found.curves and not found.names


def test_names_stand_clear_of_one_another() -> None:
    for scene in (presets.load([name]) for name in ("kerr", "kerr_0998_85", "schwarzschild")):
        names = labels.of(scene, 1.6).names
        assert len(names) == 7
        for side in (False, True):
            heights = np.sort([name.place[1] for name in names if name.is_on_the_left == side])
            assert (np.diff(heights) >= 0.0499).all()


def test_a_slider_of_colours_or_a_turn_about_the_axis_works_nothing_out() -> None:
    scene = presets.load(["kerr"])
    assert labels.of(scene.with_values({"camera.azimuth_deg": 120.0}), 1.6) is labels.of(scene, 1.6)
    assert labels.of(scene.with_values({"post.exposure": 2.0, "disk.temperature_k": 9000.0}), 1.6) is labels.of(scene, 1.6)


def test_labels_of_a_camera_that_moves_are_those_of_where_it_is() -> None:
    """A tenth of a pixel of a picture 1080 high; they take a seventh of the time."""
    scene = presets.load(["kerr"])
    followed = labels.of(scene, 1.6)
    for turned in (1.0, 2.0, 3.5, 5.0, 4.0):
        moved = scene.with_values({"camera.inclination_deg": 80.0 - 2.0 * turned, "camera.distance": 20.0 * 1.02**turned, "camera.yaw_deg": turned})
        followed, exact = labels.after(followed, moved, 1.6), labels.of(moved, 1.6)
        assert [name.text for name in followed.names] == [name.text for name in exact.names]
        for one, other in zip(followed.curves, exact.curves, strict=True):
            np.testing.assert_allclose(one.places, other.places, atol=1e-4)


def test_labels_follow_from_whatever_there_was_before() -> None:
    scene = presets.load(["kerr"])
    exact = labels.of(scene, 1.6)
    before = [{"disk.enabled": False}, {"camera.distance": 1.1}, {"rays.lensing": False}, {"camera.distance": float("inf")}, {"hole.spin": 0.0}]
    for values in before:
        found = labels.after(labels.of(scene.with_values(values), 1.6), scene, 1.6)
        assert [name.text for name in found.names] == [name.text for name in exact.names]
        for one, other in zip(found.curves, exact.curves, strict=True):
            np.testing.assert_allclose(one.places, other.places, atol=1e-4)


# --- saved pictures ---


def test_a_saved_picture_is_left_alone_unless_asked() -> None:
    pixels = np.full((150, 240, 3), 90, np.uint8)
    assert annotated(pixels, Scene(), None) is pixels
    steps = Scene().with_values({"post.view": "steps", "post.legend": False})
    assert annotated(pixels, steps, view_of(steps)) is pixels


def test_labels_are_laid_over_a_few_rows_at_a_time(monkeypatch: pytest.MonkeyPatch) -> None:
    """As over all of them at once, which took 800 MB at this size and 30 GB at 8K."""
    scene, pixels = presets.load(["kerr"], {"post.labels": True}), np.full((720, 1280, 3), 90, np.uint8)
    tracemalloc.start()
    try:
        found = annotated(pixels, scene, None)
        held = tracemalloc.get_traced_memory()[1]
    finally:
        tracemalloc.stop()
    assert held < 60e6
    monkeypatch.setattr(sheet, "_ROWS", 1000)
    assert np.array_equal(annotated(pixels, scene, None), found)
    assert 0.02 < (found != 90).mean() < 0.2 and (pixels == 90).all()


def test_a_legend_has_the_colours_of_its_view() -> None:
    scene = Scene().with_values({"post.view": "unresolved"})
    view = view_of(scene)
    found = annotated(np.full((400, 640, 3), 90, np.uint8), scene, view)
    for meaning, colour in view.legend:
        distance = np.abs(found.astype(int) - np.round(255.0 * np.array(colour))).max(axis=-1)
        assert (distance <= 1).sum() > 20, meaning
    assert (found[:200, :300] == 90).all(), "in a corner, and there alone"


def test_a_dark_swatch_has_a_rim() -> None:
    """On a dark backdrop the colour of "none" alone is not seen."""
    scene = Scene().with_values({"post.view": "order"})
    found = annotated(np.zeros((400, 640, 3), np.uint8), scene, view_of(scene)).astype(int)
    dark = np.round(255.0 * np.array(view_of(scene).legend[3][1]))
    rows, columns = np.nonzero(np.abs(found - dark).max(axis=-1) <= 1)
    left = found[rows[len(rows) // 2], columns.min() - 2 : columns.min()]
    assert left.max() > 120


def test_the_command_draws_them(tmp_path) -> None:
    common = ["render", "--preset", "kerr", "--size", "240x150", "--set", "post.dither=false"]
    pictures = {}
    for name, more in {"plain": [], "labels": ["post.labels=true"], "steps": ["post.view=steps"], "bare": ["post.view=steps", "post.legend=false"]}.items():
        out = tmp_path / f"{name}.png"
        settings = [word for value in more for word in ("--set", value)]
        # A process of its own: another GL context in this one would be current afterwards, and the other tests' renderer would draw into it.
        done = subprocess.run([sys.executable, "-m", "blackhole_gl", *common, *settings, "--out", str(out)], capture_output=True, text=True, timeout=100)
        assert done.returncode == 0, done.stderr
        pictures[name] = np.asarray(Image.open(out)).astype(int)
    changed = np.abs(pictures["labels"] - pictures["plain"]).max(axis=-1) > 20
    assert 0.002 < changed.mean() < 0.25, "thin lines and a few words"
    beside = np.abs(pictures["steps"] - pictures["bare"]).max(axis=-1) > 20
    assert beside[75:, 60:].any() and not beside[:60].any()
    assert presets.load([tmp_path / "labels.png"]).post.labels


def test_a_tilted_disk_has_no_outlines_but_the_shadow_has_its_own() -> None:
    level, tilted = (labels.of(presets.load(["kerr"], {"disk.tilt_deg": tilt}), 16 / 9) for tilt in (0.0, 30.0))
    assert len(tilted.curves) == 1 < len(level.curves)
    np.testing.assert_array_equal(tilted.curves[0].places, level.curves[0].places)
    assert [name.text for name in tilted.names] == ["shadow, inside the critical curve", "centre of the hole"]
