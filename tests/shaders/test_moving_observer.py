"""What a moving camera sees: rays against the float64 twins, the powers of its shift in pictures, refined pictures, and what they are labelled with."""

from __future__ import annotations

import math

import numpy as np
import pytest

from blackhole_gl import listed_rays
from blackhole_gl.glsl.declared import Fate
from blackhole_gl.physics import observer
from blackhole_gl.planning import choice
from blackhole_gl.reference.observers import at_rest
from blackhole_gl.rendering import labels
from blackhole_gl.rendering.frame import Renderer
from blackhole_gl.rendering.recording import pixel_direction
from blackhole_gl.scene import Scene, presets
from studies.displacement import beside_an_edge, displacement_px
from tests.shaders.test_labels import in_pixels, most_off

SIZE = (240, 150)
BOOST = {"camera.velocity_forward": 0.3, "camera.velocity_up": -0.2, "camera.velocity_right": 0.4}
PLANE = {"camera.inclination_deg": 90.0}


def _rays(count: int, seed: int = 5) -> np.ndarray:
    """ψ, χ of directions all over the sky, (count, 2)."""
    random = np.random.default_rng(seed)
    return np.column_stack([np.arccos(random.uniform(-1.0, 1.0, count)), random.uniform(0.0, 2.0 * np.pi, count)])


@pytest.mark.parametrize("beta", [0.5, 0.9])
def test_flat_space_aberration_and_shift_to_a_millionth(renderer: Renderer, beta: float) -> None:
    """cos θ' = (cos θ + β)/(1 + β cos θ), D = γ(1 + β cos θ); the former is solved for the direction that the shader finds."""
    scene = Scene().with_values({"rays.model": "flat", "camera.velocity_right": beta, "hole.spin": 0.0})
    rays = _rays(2000)
    found = listed_rays.trace_by_shader(renderer, scene, rays)
    moving, escaped = listed_rays.local_vectors(rays, scene)[:, 2], found.fate == 1
    cosine = (moving[escaped] - beta) / (1.0 - beta * moving[escaped])
    assert escaped.mean() > 0.9
    np.testing.assert_allclose(found.direction[escaped] @ observer.observe(scene).e_phi, cosine, atol=1e-6)
    np.testing.assert_allclose(1.0 / found.energy[escaped], (1.0 + beta * cosine) / math.sqrt(1.0 - beta * beta), rtol=1e-6)


@pytest.mark.parametrize(
    "model, values",
    [
        ("kerr", {"hole.spin": 0.9, "camera.observer": "rain", "camera.distance": 4.0, **BOOST}),
        ("kerr", {"hole.spin": 0.9, "camera.observer": "circular", "camera.distance": 4.0, **PLANE}),
        ("kerr_schild", {"hole.spin": 0.7, "camera.distance": 6.0, **BOOST}),
        ("schwarzschild", {"camera.observer": "fall", "camera.distance": 8.0, **BOOST}),
        ("schwarzschild_binet", {"camera.distance": 8.0, **BOOST}),
        ("schwarzschild_table", {"camera.observer": "circular", "camera.distance": 5.0}),
        ("weak_field", {"camera.observer": "rain", "camera.distance": 100.0}),
        ("kerr_like", {"hole.spin": 0.5, "camera.distance": 10.0, **BOOST}),
        ("post_newtonian", {"camera.distance": 20.0, **BOOST}),
        ("post_newtonian_drag", {"hole.spin": 0.5, "camera.distance": 20.0, **BOOST}),
        ("screen_lens", {"camera.distance": 50.0, **BOOST}),
    ],
)
def test_rays_of_a_moving_camera_are_the_twin_s(renderer: Renderer, model: str, values: dict) -> None:
    """5e-5 rad at 99 % as for cameras at rest, times what aberration spreads: directions part by D, at most 2 with these speeds."""
    scene = presets.load(["kerr", "reference"], {"hole.spin": 0.0, "rays.model": model, **values})
    rays = _rays(150)
    found, twin = listed_rays.trace_by_shader(renderer, scene, rays), listed_rays.trace_by_reference(scene, rays)
    both = (found.fate == 1) & (twin.fate == 1)
    assert np.mean(found.fate != twin.fate) < 0.01 and both.sum() > 100
    assert np.quantile(np.linalg.norm(found.direction - twin.direction, axis=1)[both], 0.98) < 1e-4
    np.testing.assert_allclose(found.lambda_[both], twin.lambda_[both], rtol=1e-4, atol=1e-4)
    if np.isfinite(twin.energy).all():
        np.testing.assert_allclose(found.energy, twin.energy, rtol=1e-10)


def _shifts(scene: Scene, size: tuple[int, int]) -> np.ndarray:
    """D of each pixel, (height, width), row 0 at the top, for a boosted static observer."""
    seen, rest = observer.observe(scene), observer.observe(scene.with_values(dict.fromkeys(BOOST, 0.0)))
    pixels = [[pixel_direction(scene, size, (x + 0.5, size[1] - y - 0.5)) for x in range(size[0])] for y in range(size[1])]
    local = np.array(pixels) @ seen.look.T
    there = at_rest(local.reshape(-1, 3), tuple(np.array([-1.0, -1.0, 1.0]) * [scene.get(key) for key in BOOST])).reshape(local.shape)
    return rest.energies(there) / seen.energies(local)


@pytest.mark.parametrize("thing", [False, True], ids=["disk and sky", "a ball and a slab"])
def test_beaming_is_the_fourth_power_of_the_shift(renderer: Renderer, thing: bool) -> None:
    """All light with and without beaming, colours the same: D⁴ in every pixel, to 1 %; half floats are good to 1e-3 of bright ones."""
    values = {"post.bloom": False, "rays.edges": 1, "camera.fov_deg": 90.0, **BOOST}
    values |= {"sky.procedural.star_brightness": 0.0, "sky.brightness": 10.0, "sky.procedural.galaxy_brightness": 10.0}
    if thing:
        values |= {"things.ball.kind": "sphere", "things.ball.x": 8.0, "things.ball.y": 3.0, "things.ball.radius": 2.0, "things.ball.lighting": "glowing"}
        values |= {"media.haze.kind": "slab"}
    scene = presets.load(["kerr"], values)
    found = []
    for beaming in (True, False):
        renderer.render(scene.with_values({"camera.beaming": beaming}), 0.0, SIZE)
        found.append(renderer.radiance().sum(axis=-1))
    power = _shifts(scene, SIZE) ** 4
    bright = (found[1] > 0.02) & (found[0] > 0.02) & (found[0] < 1e4)
    assert bright.mean() > 0.05 and power[bright].max() > 1.5 * power[bright].min()
    np.testing.assert_allclose(found[0][bright] / found[1][bright], power[bright], rtol=0.01)


def test_without_its_colour_the_motion_leaves_those_of_a_camera_at_rest(renderer: Renderer) -> None:
    """A glowing ball in flat space, red against blue: what moves towards it sees it bluer, unless that is switched off."""
    values = {"rays.lensing": False, "disk.enabled": False, "sky.enabled": False, "post.bloom": False, "camera.fov_deg": 20.0}
    values |= {"things.ball.kind": "sphere", "things.ball.radius": 3.0, "things.ball.surface": "black_body", "things.ball.temperature_k": 4000.0}

    def blueness(**more: object) -> float:
        scene = presets.load(["kerr"], {**values, **{f"camera.{key}": value for key, value in more.items()}})
        renderer.render(scene, 0.0, (48, 32))
        red, _, blue = renderer.radiance()[16, 24]
        return float(blue / red)

    still = blueness()
    assert blueness(velocity_forward=0.5) > 2.0 * still
    assert blueness(velocity_forward=0.5, doppler_colour=False) == pytest.approx(still, rel=5e-3)
    assert blueness(velocity_forward=-0.5) < 0.5 * still


@pytest.mark.parametrize("values", [BOOST, {"camera.observer": "circular", "camera.distance": 5.0, **PLANE}, {"camera.velocity_forward": -0.7}], ids=str)
def test_refined_pictures_of_moving_cameras_stay_within_the_tolerance(renderer: Renderer, monkeypatch: pytest.MonkeyPatch, values: dict) -> None:
    monkeypatch.setattr(choice, "refinement", lambda scene: None)  # whether it pays on some machine is the plan's matter
    scene, hits = presets.load(["kerr"], values), []
    for progressive in (False, True):
        renderer.hit_map.forget()
        assert renderer.render(scene, 0.0, (320, 180), progressive=progressive).traced
        hits.append(renderer.hits())
    exact, found = hits
    assert not renderer.hit_map.is_sharp, "nothing was interpolated"
    assert displacement_px(scene, found, exact).max() <= scene.rays.tolerance
    assert not np.any((found.fate != exact.fate) & ~beside_an_edge(exact.fate))


@pytest.mark.parametrize(
    "values",
    [
        {"camera.velocity_right": 0.6, "camera.yaw_deg": 25.0, "camera.fov_deg": 70.0},
        {"camera.velocity_forward": 0.4, "camera.velocity_up": 0.3, "camera.pitch_deg": 15.0},
        {"camera.observer": "circular", "camera.distance": 6.0, "camera.yaw_deg": 15.0, "camera.fov_deg": 70.0, **PLANE},
        {"camera.observer": "rain", "camera.distance": 4.0, "camera.fov_deg": 70.0},
    ],
    ids=str,
)
def test_the_critical_curve_is_the_edge_of_the_fates_for_moving_cameras(renderer: Renderer, values: dict) -> None:
    """As for cameras at rest (tests/shaders/test_labels.py): a fifth of a pixel. The hole's centre stands within it."""
    scene = presets.load(["kerr", "reference"], {"hole.spin": 0.9, "camera.distance": 12.0, "camera.fov_deg": 40.0, **values})
    renderer.render(scene, 0.0, SIZE)
    captured = renderer.hits().fate == Fate.CAPTURED
    found = labels.of(scene, SIZE[0] / SIZE[1])
    assert captured.sum() > 300
    assert most_off(in_pixels(found.curves[0].places), captured) < 0.2
    x, y = in_pixels(np.array([next(name.at for name in found.names if name.text == "centre of the hole")]))[0]
    assert captured[int(y), int(x)]


@pytest.mark.parametrize("sky", ["picture", "drifting_field"])
def test_skies_of_light_without_a_spectrum_are_shifted_where_they_are_to_be(renderer: Renderer, sky: str) -> None:
    """D⁴ at β = 0.5, nearly ahead; to 5 %: colours of black bodies are fitted to 3 %, and the view is 4° high."""
    values = {"rays.lensing": False, "disk.enabled": False, "sky.model": sky, "camera.velocity_forward": 0.5, "camera.fov_deg": 4.0, "camera.yaw_deg": 6.0}
    values |= {f"sky.picture.background_{colour}": 0.1 for colour in ("red", "green", "blue")} | {"sky.picture.width_deg": 0.1}
    values |= {"sky.drifting_field.threshold": 0.5}
    light = []
    for shifts in (False, True):
        renderer.render(presets.load(["kerr"], {**values, f"sky.{sky}.frequency_shift": shifts}), 0.0, (64, 64))
        light.append(float((renderer.radiance() @ np.array([0.2126, 0.7152, 0.0722])).sum()))
    shift = 0.75**0.5 / (1.0 - 0.5 * np.cos(np.radians(6.0)))  # by the angle that the observer sees
    assert light[0] > 0.0 and light[1] / light[0] == pytest.approx(shift**4, rel=0.05)
