"""Diagnostic views: each is drawn for every kind of ray model, and shows what the hit map holds."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest

from blackhole_gl.physics import disk_profile, relativity
from blackhole_gl.planning import plan
from blackhole_gl.rendering import supersampling
from blackhole_gl.rendering.frame import Renderer
from blackhole_gl.rendering.views import MAGENTA, RED, Scale, ends_of, linear_light, view_of
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


def on_scale(scene: Scene, values: np.ndarray, scale: Scale | None = None) -> np.ndarray:
    """The colours, linear light, that `values` should have on `scale`, or on that of the scene's view where it is always the same."""
    scale = scale or view_of(scene).scale
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
    np.testing.assert_allclose(picture, on_scale(scene, renderer.hits().steps, renderer.view_of(scene).scale), atol=HALF)


def test_steps_spend_their_scale_on_what_is_there(renderer: Renderer) -> None:
    """Of 8192 steps allowed few rays take a hundred."""
    scene = scene_with("steps")
    picture, steps = drawn(renderer, scene), renderer.hits().steps
    lightness, scale = picture @ (0.2126, 0.7152, 0.0722), renderer.view_of(scene).scale
    assert scale.low <= steps.min() and np.quantile(steps, 0.999) <= scale.high < 2.6 * np.quantile(steps, 0.999), "to the next round number"
    assert lightness.max() > 8.0 * lightness.min(), "yellow beside violet"
    assert scale.ticks[0] == scale.low and scale.ticks[-1] == scale.high


def test_a_scale_of_steps_stands_still_while_the_camera_moves(renderer: Renderer) -> None:
    scenes = [scene_with("steps", **{"camera.distance": distance}) for distance in (8.0, 20.0, 60.0, 3.0, 20.0)]
    ends = []
    for scene in scenes:
        renderer.render(scene, 0.0, SIZE, progressive=True)
        ends.append((renderer.view_of(scene).scale.low, renderer.view_of(scene).scale.high))
    assert all(after[0] <= before[0] and after[1] >= before[1] for before, after in zip(ends, ends[1:])), "it only grows"
    renderer.render(scenes[0], 0.0, SIZE)
    steps = renderer.hits().steps
    scale = renderer.view_of(scenes[0]).scale
    assert (scale.low, scale.high) == ends_of(steps), "at rest it is that of the picture"


@pytest.mark.parametrize(
    "values, ends", [([], (1.0, 10.0)), ([1, 1], (1.0, 2.0)), ([0, 0], (1.0, 2.0)), ([23, 190], (20.0, 200.0)), ([20, 200], (20.0, 200.0))]
)
def test_ends_of_a_scale_are_round(values: list[int], ends: tuple[float, float]) -> None:
    assert ends_of(np.array(values)) == ends


@pytest.mark.parametrize("off", [(), ("disk.redshift",), ("disk.doppler_colour",), ("disk.redshift", "disk.doppler_colour")])
def test_temperatures_are_those_of_the_disk_shifted_by_g(renderer: Renderer, off: tuple[str, ...]) -> None:
    """T of Page & Thorne and g of circular orbits in float64. 3e-3: the profile's table is linear between 512 radii."""
    scene = scene_with("temperature", **dict.fromkeys(off, False))
    picture, hits, made = drawn(renderer, scene), renderer.hits(), plan(scene)
    r = np.hypot(hits.crossing[..., 0], hits.crossing[..., 1]).astype(float)
    inside = (r >= made.disk_inner) & (r <= made.disk_outer)
    none = ~inside.any(axis=-1)
    first = np.take_along_axis(r, inside.argmax(axis=-1)[..., None], axis=-1)[..., 0]
    shown = np.where(none, made.disk_outer, first)
    spin = scene.hole.spin
    towards = 1.0 / (1.0 - 0.5 * relativity.orbital_frequency(shown, spin) * hits.lambda_)
    gravity = 1.0 / relativity.orbital_u_t(shown, spin) / relativity.static_lapse(scene.camera.distance, np.radians(scene.camera.inclination_deg), spin)
    kelvin = scene.disk.temperature_k * disk_profile.temperature(
        "page_thorne", shown, spin=spin, orbit="prograde", r_in=made.disk_inner, r_out=made.disk_outer
    )
    kelvin *= (1.0 if "disk.redshift" in off else gravity) * (1.0 if "disk.doppler_colour" in off else towards)
    assert is_colour(picture, view_of(scene).legend[0][1])[none].all()
    np.testing.assert_allclose(picture[~none], on_scale(scene, kelvin)[~none], atol=3e-3)
    scale = view_of(scene).scale
    assert scale.unit == "K" and (off or scale.low < np.quantile(kelvin[~none], 0.02) and kelvin[~none].max() < scale.high), "without gravity it is art"


@pytest.mark.parametrize("view", ["order", "g_factor", "steps", "temperature"])
def test_edges_of_false_colours_are_smooth_at_rest(renderer: Renderer, view: str) -> None:
    """Nearer to what 36 rays a pixel give: a pixel on an edge is of both colours."""
    scene = scene_with(view)
    renderer.render_still(scene, 0.0, SIZE, samples=6)
    still = renderer.read_rgb8().astype(int)
    renderer.render(scene, 0.0, SIZE)
    jagged = np.abs(renderer.read_rgb8() - still).mean()
    while renderer.render_finer(scene, 0.0, SIZE) < supersampling.MOST_SAMPLES:
        pass
    assert np.abs(renderer.read_rgb8() - still).mean() < 0.2 * jagged


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
    frame = renderer.read_rgb8()
    renderer.render_still(scene, 0.0, size)
    np.testing.assert_array_equal(renderer.read_rgb8(), frame)


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
    page = (Path(__file__).resolve().parents[2] / "docs" / "architecture.md").read_text(encoding="utf-8")
    (row,) = [line for line in page.splitlines() if line.startswith(f"| `{view}` |")]
    scale, stated = view_of(scene_with(view)).scale, row.split("|")[3]
    if scale is None:
        assert stated.strip() == "–"
    else:
        ends = {"steps": ("what there is",) * 2, "temperature": ("quarter", "1.6")}.get(view, (f"{scale.low:g}".replace("e-0", "e-"), f"{scale.high:g}"))
        assert ends[0] in stated and ends[1] in stated
