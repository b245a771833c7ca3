"""Spheres in pictures: what moves is traced anew and nothing else, and their light."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest
from PIL import Image

from blackhole_gl.glsl.declared import Fate
from blackhole_gl.physics import motion, moving_matter
from blackhole_gl.physics.observer import observe
from blackhole_gl.planning import plan
from blackhole_gl.rendering.frame import Renderer
from blackhole_gl.rendering.inputs import FrameInputs
from blackhole_gl.scene import Scene, SceneError, met, presets


def _scene(*names: str, **values: object) -> Scene:
    moon = {f"things.moon.{name}": value for name, value in values.items()}
    return presets.load([*names] or ["kerr"], {"things.moon.kind": "sphere", **moon})


def test_time_traces_anew_what_moves_and_nothing_that_rests_or_turns(renderer: Renderer) -> None:
    size = (36, 20)
    for values, again in (({}, False), ({"turn_rate": 1.0}, False), ({"path": "geodesic"}, True)):
        scene = _scene(**values)
        renderer.render(scene, 0.0, size)
        compiled = renderer.programs.compiled
        assert renderer.render(scene, 3.0, size).traced == again, values
        assert not renderer.render(scene, 3.0, size).traced
        assert renderer.programs.compiled == compiled


def test_an_orbiting_sphere_is_met_where_it_is_at_the_time(renderer: Renderer) -> None:
    """Every meeting lies on the sphere about the place that the closed form gives."""
    scene = _scene(path="circle", orbit_radius=9.0, orbit_rate=0.1, radius=2.0)
    scene = scene.with_values(
        {"camera.inclination_deg": 30.0, "camera.distance": 40.0, "rays.model": "kerr", "rays.integrator": "rk4", "rays.step_angle": 0.05}
    )
    for time in (0.0, 20.0, 45.0):
        renderer.render(scene, time, (160, 90))
        hits = renderer.hits()
        met = hits.fate == Fate.MET
        centre = 9.0 * np.array([np.cos(0.1 * time), np.sin(0.1 * time), 0.0])
        apart = np.linalg.norm(hits.met_place[met, 0] - centre, axis=-1)
        assert met.sum() > 50 and np.max(np.abs(apart - 2.0)) < 1e-4, "single precision at 9 r_s, and the root's own error"


def test_where_a_ray_ends_on_a_sphere_before_it_crosses_no_seam_is_seen(renderer: Renderer) -> None:
    """A ball that the disk's plane cuts, beyond the disk's edge: its upper half ends rays before they cross, its lower half after. All of it is alike."""
    flat = {"lighting": "glowing", "frequency_shift": False, "path": "circle", "orbit_rate": 0.0, "orbit_radius": 13.0, "orbit_phase_deg": 20.0}
    scene = _scene(**flat).with_values({"rays.edges": 1, "camera.distance": 22.0})
    renderer.render(scene, 0.0, (320, 180))
    hits = renderer.hits()
    met = hits.fate == Fate.MET
    before = hits.met[..., 0, 2]
    assert np.sum(met & (before == 0)) > 300 and np.sum(met & (before == 1)) > 300
    np.testing.assert_allclose(renderer.radiance()[::-1][met] / (0.85, 0.8, 0.7), 1.0, atol=1e-3)


QUIET = {"rays.lensing": False, "hole.spin": 0.0, "disk.enabled": False, "sky.enabled": False, "post.bloom": False, "rays.edges": 1, "camera.azimuth_deg": 0.0}


def _lit(place: np.ndarray, centre: np.ndarray, towards: np.ndarray, lamps: list[tuple[np.ndarray, np.ndarray, float]], **finish: float) -> np.ndarray:
    """Blinn and Phong's light of a ball about `centre` at its surface points `place` (N, 3), seen along the unit vectors `towards`, in float64."""
    normal = (place - centre) / np.linalg.norm(place - centre, axis=-1)[:, None]
    colour = np.array([0.85, 0.8, 0.7])
    light = np.repeat(finish["ambient"] * colour[None], len(place), axis=0)
    for where, glow, unit in lamps:
        way = where - place
        far = np.linalg.norm(way, axis=-1)
        to_lamp = way / far[:, None]
        facing = np.maximum(np.sum(normal * to_lamp, axis=-1), 0.0)
        half = to_lamp + towards
        half /= np.linalg.norm(half, axis=-1)[:, None]
        highlight = np.where(facing > 0.0, finish["specular"] * np.maximum(np.sum(normal * half, axis=-1), 0.0) ** finish["shininess"], 0.0)
        thinned = (unit / far) ** 2 if unit else np.ones_like(far)
        light += ((1.0 - finish["ambient"]) * facing[:, None] * colour + highlight[:, None]) * thinned[:, None] * glow
    return light


def test_lamps_light_a_ball_as_blinn_and_phong_say(renderer: Renderer) -> None:
    """Two lamps, one of which thins out, in flat space without a shift; radiance is kept in half floats, good to 1e-3 of it."""
    finish = {"ambient": 0.1, "specular": 0.4, "shininess": 25.0}
    scene = _scene("kerr", x=3.0, y=1.0, z=4.0, radius=2.0, frequency_shift=False, **finish).with_values({**QUIET, "camera.inclination_deg": 60.0})
    sun, moon = np.array([9.0, -6.0, 8.0]), np.array([8.0, 9.0, 2.0])
    for name, place, more in (("sun", sun, {"brightness": 1.5}), ("other", moon, {"brightness": 0.5, "thins_out": False, "colour": (0.2, 1.0, 0.4)})):
        given = {"kind": "lamp", "radius": 0.0, **dict(zip("xyz", place)), **more}
        scene = scene.with_values({f"things.{name}.{key}": value for key, value in given.items()})
    renderer.render(scene, 0.0, (240, 160))
    hits = renderer.hits()
    met = hits.met[..., 0, 0] >= 0
    place = hits.met_place[met, 0].astype(float)
    assert len(place) > 1000
    camera = 20.0 * np.array([np.sin(np.radians(60.0)), 0.0, np.cos(np.radians(60.0))])
    towards = camera - place
    towards /= np.linalg.norm(towards, axis=-1)[:, None]
    lamps = [(sun, 1.5 * np.array([1.0, 0.95, 0.9]), 10.0), (moon, 0.5 * np.array([0.2, 1.0, 0.4]), 0.0)]
    expected = _lit(place, np.array([3.0, 1.0, 4.0]), towards, lamps, **finish)
    assert expected.max() > 1.0, "there is a highlight"
    np.testing.assert_allclose(renderer.radiance()[::-1][met], expected, rtol=3e-3, atol=1e-3)


@pytest.mark.parametrize("radius", [0.0, 0.2])
def test_rays_and_pixels_look_for_lamps_that_have_a_size_alone(renderer: Renderer, radius: float) -> None:
    """Every branch runs for every pixel: a kind of which nothing can be met took a tenth of the shading and of the rays."""
    lamp = {"things.lamp.kind": "lamp", "things.lamp.radius": radius, "things.lamp.z": 9.0}
    scene = presets.load(["kerr"], {"things.ball.kind": "sphere", **lamp})
    draws = [renderer.programs.get(path, FrameInputs.whole(plan(scene), 0.0, (60, 34))) for path in ("trace.frag", "shade_matter.frag")]
    assert all(draw.takes("thing_sphere_table") for draw in draws)
    assert all(draw.takes("thing_lamp_table") == (radius > 0.0) for draw in draws)
    alone = presets.load(["kerr"], lamp)
    assert met.seen_kinds(alone, "thing") == met.kinds(alone, "thing"), "a program has one kind at least"
    if not radius:
        renderer.hit_map.trace(FrameInputs.whole(plan(alone), 0.0, (160, 90)), progressive=True)
        assert renderer.hit_map.own_rays().mean() < 0.5, "where nothing has a size nothing is near, not what happens to lie in the table of balls"


def test_squares_too_small_for_a_pixel_are_their_mean(renderer: Renderer) -> None:
    """What cannot be shown neither blinks nor makes patterns: all pixels but those at the rim have the mean of the two colours."""
    looks = {"surface": "checker", "colour": (1.0, 1.0, 1.0), "other_colour": (0.0, 0.0, 0.0), "lighting": "glowing", "frequency_shift": False}
    scene = _scene("kerr", x=0.0, z=6.0, radius=3.0, squares_around=720, squares_along=360, **looks).with_values(QUIET)
    renderer.render(scene, 0.0, (96, 64))
    met = renderer.hits().met[..., 0, 0] >= 0
    inner = met & np.roll(met, 1, 0) & np.roll(met, -1, 0) & np.roll(met, 1, 1) & np.roll(met, -1, 1)
    assert inner.sum() > 200
    np.testing.assert_allclose(renderer.radiance()[::-1][inner], 0.5, atol=0.08)


def test_squares_lie_where_longitude_and_latitude_say_without_a_seam(renderer: Renderer) -> None:
    """By the place of each meeting, in axes turned with the ball; pixels on the squares' edges are left out."""
    looks = {"surface": "checker", "colour": (1.0, 1.0, 1.0), "other_colour": (0.0, 0.0, 0.0), "lighting": "glowing", "frequency_shift": False}
    scene = _scene("kerr", x=0.0, z=6.0, radius=3.0, turn_deg=180.0, **looks).with_values(QUIET)
    renderer.render(scene, 0.0, (240, 160))
    hits = renderer.hits()
    met = hits.met[..., 0, 0] >= 0
    arm = hits.met_place[met, 0].astype(float) - (0.0, 0.0, 6.0)
    around = np.arctan2(-arm[:, 1], -arm[:, 0]) / (2.0 * np.pi) * 16
    along = (0.5 + np.arcsin(arm[:, 2] / 3.0) / np.pi) * 8
    clear = (np.abs(around - np.rint(around)) > 0.15) & (np.abs(along - np.rint(along)) > 0.15) & (np.hypot(arm[:, 0], arm[:, 1]) > 1.5) & (arm[:, 0] > 1.5)
    assert clear.sum() > 800 and np.any(np.abs(around[clear]) > 7.5), "the seam is in view"
    expected = ((np.floor(around) + np.floor(along)) % 2 == 0)[clear]
    np.testing.assert_allclose(renderer.radiance()[::-1][met][clear, 0], expected, atol=0.02)


def test_a_black_body_on_an_orbit_has_the_shifted_colour(renderer: Renderer) -> None:
    """Brightness by g⁴, the luminance of its colour being 1; g by the float64 form from each ray's own momentum."""
    scene = _scene("kerr", surface="black_body", path="geodesic", orbit_radius=6.0, orbit_phase_deg=270.0, radius=0.8, temperature_k=6000.0)
    scene = scene.with_values({"disk.enabled": False, "sky.enabled": False, "post.bloom": False, "rays.edges": 1, "camera.azimuth_deg": 0.0})
    renderer.render(scene, 0.0, (240, 160))
    hits, made = renderer.hits(), plan(scene)
    met = hits.met[..., 0, 0] >= 0
    place, rates = hits.met_place[met, 0].astype(float), hits.met_rates[met, 0].astype(float)
    velocity = motion.rows(scene, "thing", made.space_time, 0.0)[0, 1, :3]
    r, spin = 2.0 * np.linalg.norm(place, axis=-1), made.space_time.spin
    n = 2.0 * place / r[:, None]
    sine = np.hypot(n[:, 0], n[:, 1])
    e_phi = np.stack([-n[:, 1], n[:, 0], 0.0 * r], axis=-1) / sine[:, None]
    k_theta, k_phi = (-np.sum(rates[:, :3] * axis, axis=-1) for axis in (np.cross(e_phi, n), e_phi))
    k = np.stack([rates[:, 3] / (1.0 - 2.0 / r + (spin / r) ** 2), k_theta, sine * k_phi], axis=-1)
    g = moving_matter.emitted_shift(place, np.broadcast_to(velocity, place.shape), k, spin) / observe(scene).tetrad[0, 0]
    luminance = renderer.radiance()[::-1][met].astype(float) @ (0.2126, 0.7152, 0.0722)
    assert len(place) > 200 and g.max() > 1.1, "it comes towards the camera"
    assert np.quantile(np.abs(luminance**0.25 / g - 1.0), 0.99) < 1e-3, "half floats; the colours' luminance is 1 to 1e-3"


def test_what_a_surface_looks_like_traces_nothing_anew(renderer: Renderer) -> None:
    scene = _scene("kerr", surface="checker")
    renderer.render(scene, 0.0, (36, 20))
    compiled = renderer.programs.compiled
    for name, value in (("colour", (0.1, 0.2, 0.3)), ("surface", "black_body"), ("lighting", "glowing"), ("squares_around", 40), ("ambient", 0.5)):
        scene = scene.with_values({f"things.moon.{name}": value})
        assert not renderer.render(scene, 0.0, (36, 20)).traced, name
    assert renderer.render(scene.with_values({"things.moon.radius": 2.0}), 0.0, (36, 20)).traced
    assert renderer.programs.compiled == compiled


def _painted(file: Path, light: np.ndarray) -> str:
    """Writes `light`, linear (rows from the north, columns from 180° W, 3), as a picture."""
    code = np.where(light <= 0.0031308, 12.92 * light, 1.055 * np.maximum(light, 1e-9) ** (1.0 / 2.4) - 0.055)
    Image.fromarray(np.rint(255.0 * code).astype(np.uint8)).save(file)
    return str(file)


def _glowing(file: str, **values: object) -> Scene:
    looks = {"surface": "image", "image": file, "lighting": "glowing", "frequency_shift": False}
    return _scene("kerr", **{"x": 0.0, "z": 6.0, "radius": 3.0, **looks, **values}).with_values(QUIET)


def test_a_picture_lies_round_a_ball_by_longitude_and_latitude_without_a_seam(renderer: Renderer, tmp_path: Path) -> None:
    """Turned with the ball so that the picture's edge is in view; 8-bit codes and the pixel's own width leave 0.02."""
    longitude = (np.arange(512) + 0.5) / 512 * 2.0 * np.pi - np.pi
    latitude = np.pi / 2 - (np.arange(256) + 0.5) / 256 * np.pi
    light = np.stack([*np.broadcast_arrays(0.5 + 0.5 * np.cos(longitude)[None], 0.5 + 0.5 * np.sin(longitude)[None], (0.5 + latitude / np.pi)[:, None])], -1)
    scene = _glowing(_painted(tmp_path / "globe.png", light), turn_deg=180.0)
    renderer.render(scene, 0.0, (240, 160))
    hits = renderer.hits()
    met = hits.met[..., 0, 0] >= 0
    arm = hits.met_place[met, 0].astype(float) - (0.0, 0.0, 6.0)
    inner = (arm[:, 0] > 1.0) & (np.hypot(arm[:, 0], arm[:, 1]) > 0.5)
    around = np.arctan2(-arm[:, 1], -arm[:, 0])
    expected = np.stack([0.5 + 0.5 * np.cos(around), 0.5 + 0.5 * np.sin(around), 0.5 + np.arcsin(arm[:, 2] / 3.0) / np.pi], axis=-1)
    assert np.sum(inner & (np.abs(around) > 3.1)) > 20, "the seam is in view"
    assert np.max(np.abs(renderer.radiance()[::-1][met] - expected)[inner]) < 0.02


def test_a_picture_finer_than_the_pixels_does_not_blink(renderer: Renderer, tmp_path: Path) -> None:
    """Grains of one texel, black or white, on a small ball that turns: every pixel keeps near the mean, and changes little from frame to frame."""
    grains = np.repeat(np.random.default_rng(2).integers(0, 2, (512, 1024, 1)), 3, axis=2).astype(float)
    scene = _glowing(_painted(tmp_path / "grains.png", grains), radius=1.0, turn_rate=0.01)
    seen = []
    for time in (0.0, 1.0, 2.0):
        renderer.render(scene, time, (120, 80))
        seen.append(renderer.radiance()[::-1])
    met = renderer.hits().met[..., 0, 0] >= 0
    assert met.sum() > 30
    assert all(abs(np.mean(picture[met]) - 0.5) < 0.05 and np.std(picture[met]) < 0.12 for picture in seen)
    assert np.max(np.abs(seen[1] - seen[0])[met]) < 0.15


def test_a_picture_that_is_not_there_is_said_and_no_picture_is_one_colour(renderer: Renderer, tmp_path: Path) -> None:
    with pytest.raises(SceneError, match=r"things.moon.image: the picture .*missing.png cannot be used"):
        renderer.render(_glowing(str(tmp_path / "missing.png")), 0.0, (36, 20))
    renderer.render(_glowing(""), 0.0, (72, 40))
    met = renderer.hits().met[..., 0, 0] >= 0
    np.testing.assert_allclose(renderer.radiance()[::-1][met], np.broadcast_to((0.85, 0.8, 0.7), (met.sum(), 3)), atol=1e-3)
