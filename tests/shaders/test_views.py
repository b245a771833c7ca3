"""Diagnostic views: each is drawn for every kind of ray model, and shows what the hit map holds."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest

from blackhole_gl.render.frame import Renderer
from blackhole_gl.render.views import MAGENTA, RED, linear_light, view_of
from blackhole_gl.scene import Scene, fields, presets

SIZE = (48, 30)
VIEWS = [name for name in fields()["post.view"].options if name != "picture"]
MODELS = {"kerr": {"hole.spin": 0.9}, "schwarzschild": {"hole.spin": 0.0}, "flat": {"hole.spin": 0.0}}
HALF = 2e-3  # a half float's rounding, of light no brighter than 1, with room for what lies between two entries of a colour scale


def scene_with(view: str, model: str = "kerr", **values: object) -> Scene:
    return presets.load(["kerr"], {"post.view": view, "rays.model": model, **MODELS.get(model, {}), **values})


def drawn(renderer: Renderer, scene: Scene) -> np.ndarray:
    """Linear light of the view, (height, width, 3), lowest row first as hits are."""
    renderer.render(scene, 0.0, SIZE)
    return renderer.radiance()[::-1]


def on_scale(scene: Scene, values: np.ndarray) -> np.ndarray:
    """The colours, linear light, that `values` should have on the scale of the scene's view."""
    scale = view_of(scene).scale
    low, high, here = (np.log(v) if scale.is_log else v for v in (scale.low, scale.high, np.maximum(values, 1e-30)))
    place = np.clip((here - low) / (high - low), 0.0, 1.0)
    entries = linear_light(scale.colours(1025))
    return np.stack([np.interp(place, np.linspace(0.0, 1.0, 1025), entries[:, k]) for k in range(3)], axis=-1)


def is_colour(picture: np.ndarray, colour: tuple[float, float, float]) -> np.ndarray:
    return np.all(np.abs(picture - linear_light(np.array(colour))) < HALF, axis=-1)


@pytest.mark.parametrize("model", MODELS)
@pytest.mark.parametrize("view", VIEWS)
def test_every_view_is_drawn_and_finite(renderer: Renderer, view: str, model: str) -> None:
    picture = drawn(renderer, scene_with(view, model))
    assert np.isfinite(picture).all() and picture.max() > 0.0


def test_steps_are_those_of_the_hits(renderer: Renderer) -> None:
    scene = scene_with("steps")
    picture = drawn(renderer, scene)
    np.testing.assert_allclose(picture, on_scale(scene, renderer.hits().steps), atol=HALF)


def test_order_shows_nothing_without_a_disk(renderer: Renderer) -> None:
    picture = drawn(renderer, scene_with("order", **{"disk.enabled": False}))
    assert is_colour(picture, view_of(scene_with("order")).legend[3][1]).all()


def test_order_counts_the_crossings(renderer: Renderer) -> None:
    scene = scene_with("order")
    picture, crossing = drawn(renderer, scene), renderer.hits().crossing
    r = np.hypot(crossing[..., 0], crossing[..., 1])
    direct_only = (r[..., 0] > 4.0) & (r[..., 0] < 9.0) & (r[..., 1] == 0.0)
    assert direct_only.any()
    assert is_colour(picture, view_of(scene).legend[0][1])[direct_only].all()


def test_approaching_matter_is_blue_and_receding_red(renderer: Renderer) -> None:
    picture = drawn(renderer, scene_with("g_factor", **{"camera.inclination_deg": 85.0, "camera.distance": 40.0, "camera.fov_deg": 30.0}))
    red_less_blue = picture[..., 0] - picture[..., 2]
    middle = SIZE[0] // 2
    assert red_less_blue[:, : middle - 4].mean() < -0.01, "prograde matter comes towards the camera on the left"
    assert red_less_blue[:, middle + 4 :].mean() > 0.01


@pytest.mark.parametrize("disk", [True, False])
def test_the_most_accurate_method_does_not_differ_from_itself(renderer: Renderer, disk: bool) -> None:
    steps = presets.read("reference").values
    scene = scene_with("difference", **{**steps, "rays.step_control": "mino", "disk.enabled": disk})
    picture, fate = drawn(renderer, scene), renderer.hits().fate
    lowest, nothing = on_scale(scene, np.zeros(SIZE[::-1])), is_colour(picture, view_of(scene).legend[1][1])
    np.testing.assert_allclose(picture[~nothing], lowest[~nothing], atol=HALF)
    assert not nothing[fate == 1].any()


def test_coarse_steps_differ_and_wrong_fates_are_red(renderer: Renderer) -> None:
    fine = drawn(renderer, scene_with("difference", **{"rays.step_angle": 0.1}))
    coarse = drawn(renderer, scene_with("difference", **{"rays.step_angle": 0.8}))
    assert coarse[..., 1].mean() > 2.0 * fine[..., 1].mean(), "the scale grows brighter with the error"
    flat = drawn(renderer, scene_with("difference", "flat", **{"hole.spin": 0.9}))
    assert is_colour(flat, RED).any(), "flat light reaches the sky through the shadow"


def test_difference_traces_the_reference_once(renderer: Renderer) -> None:
    scene = scene_with("difference")
    renderer.render(scene, 0.0, SIZE)
    traces = renderer.reference_map.traces
    assert not renderer.render(scene, 7.0, SIZE).traced
    assert renderer.render(scene.with_values({"rays.step_angle": 0.3}), 7.0, SIZE).traced
    assert renderer.reference_map.traces == traces, "steps of the current method do not concern the reference"
    renderer.render(scene.with_values({"camera.distance": 21.0}), 7.0, SIZE)
    assert renderer.reference_map.traces == traces + 1


@pytest.mark.parametrize("model", ["kerr", "kerr_schild", "schwarzschild", "schwarzschild_binet", "kerr_like", "post_newtonian"])
def test_conserved_quantities_drift_by_rounding_alone_unless_steps_are_long(renderer: Renderer, model: str) -> None:
    """1e-5 is a hundred roundings of a float32; what rk4 loses at the longest steps is far above."""
    drift = {}
    for step in (0.05, 0.8):
        drawn(
            renderer, scene_with("conservation", model, **{"rays.integrator": "rk4", "rays.step_angle": step, "rays.step_length": step, "disk.enabled": False})
        )
        drift[step] = np.frombuffer(renderer.hit_map.textures[1].read(), np.float32).reshape(*SIZE[::-1], 4)[..., 3]
    assert drift[0.05].min() >= 0.0 and np.quantile(drift[0.05], 0.99) < 1e-5
    assert np.quantile(drift[0.8], 0.99) > 1e-4


def test_a_model_without_a_conserved_quantity_is_grey(renderer: Renderer) -> None:
    scene = scene_with("conservation", "flat")
    assert is_colour(drawn(renderer, scene), view_of(scene).legend[0][1]).all()


@pytest.mark.parametrize("view", ["unresolved", "steps", "conservation"])
def test_rays_without_a_fate_are_magenta(renderer: Renderer, view: str) -> None:
    adaptive = {"rays.integrator": "dopri5", "rays.step_control": "embedded", "rays.step_angle": 0.01, "rays.max_steps": 8}
    picture, fate = drawn(renderer, scene_with(view, **adaptive)), renderer.hits().fate
    assert (fate == 0).any(), "too few steps leave rays under way"
    np.testing.assert_array_equal(is_colour(picture, MAGENTA), fate == 0)


def test_shipped_scene_has_no_magenta(renderer: Renderer) -> None:
    assert not is_colour(drawn(renderer, scene_with("unresolved")), MAGENTA).any()


@pytest.mark.parametrize("view", ["steps", "difference"])
def test_a_still_in_tiles_shows_the_view(renderer: Renderer, view: str) -> None:
    scene, size = scene_with(view), (600, 8)
    renderer.render(scene, 0.0, size)
    frame = renderer.read_rgb8().astype(int)
    renderer.render_still(scene, 0.0, size)
    np.testing.assert_allclose(renderer.read_rgb8().astype(int), frame, atol=1)


def test_a_view_looks_the_same_whatever_the_image_settings(renderer: Renderer) -> None:
    plain = drawn(renderer, scene_with("g_factor"))
    pixels = renderer.read_rgb8()
    renderer.render(scene_with("g_factor", **{"post.exposure": 4.0, "post.gamma": 2.0, "post.tone_map": "agx", "post.bloom_intensity": 2.0}), 0.0, SIZE)
    np.testing.assert_array_equal(renderer.read_rgb8(), pixels)
    assert plain.max() <= 1.0


def test_scales_run_from_dark_to_light_and_fold_at_one() -> None:
    steps, g = view_of(scene_with("steps")).scale, view_of(scene_with("g_factor")).scale
    lightness = linear_light(steps.colours(64)) @ (0.2126, 0.7152, 0.0722)
    assert (np.diff(lightness) > 0.0).all()
    assert g.place(1.0) == pytest.approx(0.5)
    ends = g.colours(3)
    assert ends[0, 0] > 2.0 * ends[0, 2] and ends[2, 2] > 2.0 * ends[2, 0] and np.ptp(ends[1]) < 0.01


@pytest.mark.parametrize("view", VIEWS)
def test_ranges_stand_in_the_documents(view: str) -> None:
    """A saved picture has no numbers on it."""
    page = (Path(__file__).resolve().parents[2] / "docs" / "architecture.md").read_text(encoding="utf-8")
    (row,) = [line for line in page.splitlines() if line.startswith(f"| `{view}` |")]
    scale, stated = view_of(scene_with(view)).scale, row.split("|")[3]
    if scale is None:
        assert stated.strip() == "–"
    else:
        assert f"{scale.low:g}".replace("e-0", "e-") in stated
        assert ("rays.max_steps" if view == "steps" else f"{scale.high:g}") in stated
