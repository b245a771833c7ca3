"""Media at a resolution of their own: what a moving camera and a moving pattern are shown, against the exact picture."""

from __future__ import annotations

import time

import numpy as np
import pytest

from blackhole_gl.glsl.declared import Fate
from blackhole_gl.planning import plan as make_plan
from blackhole_gl.rendering import coarse_targets, coarse_transfer
from blackhole_gl.rendering.frame import Renderer
from blackhole_gl.rendering.inputs import FrameInputs
from blackhole_gl.scene import Scene, presets

SIZE = (96, 54)
SLAB = {
    "hole.spin": 0.9, "rays.model": "kerr", "sky.enabled": False, "post.bloom": False, "rays.edges": 1, "media.slab.kind": "slab",
    "media.slab.inner_radius": 2.6, "media.slab.outer_radius": 10.0, "media.slab.octaves": 1, "media.slab.depth": 1.0,
}  # fmt: skip
FOG = {"media.fog.kind": "ball", "media.fog.radius": 5.0, "media.fog.depth": 0.4, "media.fog.brightness": 1.0}
BEFORE_DISK = {"disk.opacity": 0.6, "disk.turbulence": False, "rays.lensing": False, "rays.edges": 1}
WITHOUT_DISK = {"disk.enabled": False}
LENSED_DISK = {"rays.lensing": True, "camera.inclination_deg": 88.0}
PARALLEL = {"camera.distance": float("inf"), "camera.field_m": 50.0}


def pictures(renderer: Renderer, scene: Scene) -> tuple[np.ndarray, np.ndarray]:
    """Radiance under a camera that moves, and of the same picture at rest."""
    renderer.render(scene.with_values({"camera.inclination_deg": scene.camera.inclination_deg + 1.0}), 1.0, SIZE, progressive=True)
    renderer.render(scene, 1.0, SIZE, progressive=True)
    moving = renderer.radiance()
    renderer.render(scene, 1.0, SIZE)
    return moving, renderer.radiance()


@pytest.mark.parametrize("what", [SLAB | WITHOUT_DISK, FOG | BEFORE_DISK], ids=["slab", "fog and disk"])
def test_media_under_a_moving_camera_are_those_of_the_picture_at_rest(renderer: Renderer, what: dict) -> None:
    """Between rays three pixels apart light is linear: 95 % within 2 % of the peak, as coarse pixels see clouds and layers as means. The hole's edge is as
    sharp as it is at rest: nine in ten of the pixels beside it, too, which a halo would brighten or darken by a quarter."""
    moving, still = pictures(renderer, presets.load(["kerr"], what))
    off = np.abs(moving - still).max(axis=-1) / still.max()
    fate, _ = renderer.fates_and_steps()
    edge = np.zeros(fate.shape, bool)
    edge[1:-1, 1:-1] = (fate[1:-1, 1:-1] != fate[:-2, 1:-1]) | (fate[1:-1, 1:-1] != fate[1:-1, :-2])
    print("95 %", np.quantile(off, 0.95), "beside edges", np.quantile(off[::-1][edge], 0.9), np.count_nonzero(edge))
    assert still.max() > 0.05
    assert np.quantile(off, 0.95) < 0.02
    assert np.quantile(off[::-1][edge], 0.9) < 0.1


NEAR = {"camera.distance": 2.0, "camera.yaw_deg": 180.0, "camera.fov_deg": 90.0, "disk.enabled": False, "sky.enabled": False, "post.bloom": False}
PLACE = {"x": 6.0, "y": 6.0, "radius": 0.9}
HAZE = {"media.haze.kind": "ball", "media.haze.radius": 30.0, "media.haze.depth": 0.0005, "media.haze.colour": [0.0, 0.0, 1.0]}


@pytest.mark.parametrize("around", [{}, HAZE], ids=["in empty space", "in another"])
@pytest.mark.parametrize("progressive", [False, True], ids=["at rest", "moving"])
def test_no_ray_that_gains_speed_outwards_steps_over_a_medium(renderer: Renderer, progressive: bool, around: dict) -> None:
    """Seen from close to the hole: what a ball covers is what an opaque sphere in its place does. A step of Mino time as long as it is to the ball at the speed
    that a ray has at the hole led beyond it, and none of it was seen, in exact pictures either."""
    red = {"media.a.kind": "ball", "media.a.colour": [1.0, 0.0, 0.0]}
    ball = presets.load(["kerr"], NEAR | around | red | {f"media.a.{name}": value for name, value in PLACE.items()})
    sphere = presets.load(["kerr"], NEAR | {"things.a.kind": "sphere"} | {f"things.a.{name}": value for name, value in PLACE.items()})
    renderer.render(sphere, 1.0, SIZE)
    met = np.count_nonzero(renderer.fates_and_steps()[0] == Fate.MET)
    for aside in (1.0, 0.0):
        renderer.render(ball.with_values({"camera.azimuth_deg": ball.camera.azimuth_deg + aside}), 1.0, SIZE, progressive=progressive)
    seen = np.count_nonzero(renderer.radiance()[..., 0] > 0.0)
    print("met", met, "seen", seen)
    assert met > 10
    assert abs(seen - met) < 0.35 * met


def test_a_torus_from_beside_the_horizon_is_whole_under_a_moving_camera(renderer: Renderer) -> None:
    """Longer steps led over a part of its ring: 7.7 % of the pixels that shine were dark, and 2.7 % are, as the grid is coarse in so small a picture."""
    moving, still = pictures(renderer, presets.load(["hover"], {"media.torus.kind": "torus", "sky.enabled": False}))
    lit = still.max(axis=-1) > 0.1 * still.max()
    dark = moving.max(axis=-1)[lit] < 0.1 * still.max(axis=-1)[lit]
    print(np.count_nonzero(lit), "dark", dark.mean())
    assert dark.mean() < 0.04


@pytest.mark.parametrize("what", [FOG | BEFORE_DISK | LENSED_DISK, SLAB | WITHOUT_DISK], ids=["fog and disk", "slab"])
def test_parallel_rays_are_marched_apart_from_the_rest_as_well(renderer: Renderer, what: dict) -> None:
    """A hit map that tells where media begin leads to the same light, but for rounding beside edges. Under a moving camera as near ones."""
    scene = presets.load(["kerr"], {"rays.model": "kerr"} | what | PARALLEL)
    moving, still = pictures(renderer, scene)
    renderer.render(scene.with_values({"rays.refine": False}), 1.0, SIZE)
    known = renderer.radiance()
    off = np.abs(still - known).max(axis=-1) / known.max()
    print(np.quantile(off, 0.99), np.quantile(np.abs(moving - still).max(axis=-1) / still.max(), 0.95))
    assert known.max() > 0.05 and np.quantile(off, 0.99) < 1e-3
    assert np.quantile(np.abs(moving - still).max(axis=-1) / still.max(), 0.95) < 0.02


def test_a_ring_thinner_than_the_grid_is_no_row_of_dots(renderer: Renderer) -> None:
    """Of the torus, 480x270: 1e-3 of the pixels were off by more than 32 grey levels where light that bends from ray to ray was joined all the same."""
    scene, size = presets.load(["polish_doughnut"]), (480, 270)
    for turn in (0.5, 0.0):
        renderer.render(scene.with_values({"camera.inclination_deg": scene.camera.inclination_deg + turn}), 1.0, size, progressive=True)
    moving = renderer.read_rgb8().astype(int)
    renderer.render(scene, 1.0, size)
    off = np.abs(moving - renderer.read_rgb8()).max(axis=-1)
    print(np.mean(off > 32), np.mean(off > 8))
    assert np.mean(off > 32) < 3e-4


def test_rays_that_only_surfaces_part_are_joined_where_their_light_is_close(renderer: Renderer) -> None:
    """What they show is held to the picture at rest above. 1,224 pixels had their own ray where surfaces alone decided, 846 have."""
    scene = presets.load(["kerr"], SLAB | WITHOUT_DISK)
    for turn in (1.0, 2.0):
        renderer.render(scene.with_values({"camera.inclination_deg": scene.camera.inclination_deg + turn}), 1.0, SIZE, progressive=True)
    made = renderer.coarse_transfer._made
    assert made is not None
    assert 100 < made.own.count < 1000


def test_what_media_are_drawn_in_holds_all_of_them_once_and_nothing_stands_beside_it(renderer: Renderer) -> None:
    """Blending would draw a pixel of two bands twice, and the disk reads what an earlier picture left anywhere."""
    scene = presets.load(["kerr"], SLAB | BEFORE_DISK | {"media.slab.outer_radius": 5.0})
    for aside in (12.0, -12.0):
        renderer.render(scene.with_values({"camera.yaw_deg": aside}), 1.0, SIZE, progressive=True)
    made = renderer.coarse_transfer._made
    assert made is not None and made.shown is not None
    depth = np.frombuffer(made.depth.read(), np.float32).reshape(SIZE[::-1])
    covered = np.zeros(SIZE[::-1], int)
    for x, y, width, height in made.shown:
        covered[y : y + height, x : x + width] += 1
    assert np.all(covered[(depth < 0.375) | (depth > 0.625)] == 1) and np.all(covered <= 1)
    assert 0.2 < np.mean(covered == 0) < 0.9
    assert np.all(stretches_of(renderer)[:, covered == 0] == 0.0)


def test_a_moving_pattern_is_marched_in_turns_and_exactly_where_time_stands(renderer: Renderer) -> None:
    scene = presets.load(["kerr"], SLAB | WITHOUT_DISK)
    renderer.render(scene, 1.0, SIZE)
    exact, coarse = renderer.radiance(), renderer.coarse_transfer
    before = coarse.marches
    renderer.render(scene, 1.0, SIZE, glow_may_last=True)
    assert coarse.marches == before + 2, "the grid, and the rays beside it"
    off = np.abs(renderer.radiance() - exact).max(axis=-1) / exact.max()
    print("99 %", np.quantile(off, 0.99))
    assert 0.0 < np.quantile(off, 0.99) < 0.1
    for turn in (1, 2, 3, 4):
        renderer.render(scene, 1.0 + 0.1 * turn, SIZE, glow_may_last=True)
        assert coarse.marches == before + 2 + turn, "one of the two"
    renderer.render(scene, 9.0, SIZE, glow_may_last=True)
    assert coarse.marches == before + 8, "nothing lags behind by more than a little"
    renderer.render(scene, 1.0, SIZE)
    np.testing.assert_array_equal(renderer.radiance(), exact)


def stretches_of(renderer: Renderer) -> np.ndarray:
    """What media add and take on each stretch of each ray, (textures, height, width, 3)."""
    textures = renderer.coarse_transfer.samplers.values()
    return np.stack([np.frombuffer(texture.read(), np.float16).reshape(texture.height, texture.width, 4)[..., :3].astype(float) for texture in textures])


def test_samples_on_rays_that_stay_show_what_a_march_does(renderer: Renderer) -> None:
    """Before and behind a disk: 99.5 % within 1e-3 of the largest, as half floats have weights to 5e-4, and a ray a dozen pieces.
    Another moment is off by over five times that."""
    scene = presets.load(["kerr"], SLAB | BEFORE_DISK | {"rays.lensing": True, "rays.medium_step": 0.5})
    renderer.render(scene, 1.0, SIZE, glow_may_last=True)
    marched = stretches_of(renderer)
    for turn in range(8):
        renderer.render(scene, 5.0 + turn, SIZE, glow_may_last=True)
    another = stretches_of(renderer)
    made = renderer.coarse_transfer._made
    assert made is not None and made.is_told and made.samples.is_whole and made.own_samples.is_whole
    renderer.render(scene, 1.0, SIZE, glow_may_last=True)
    largest = np.maximum(marched.max(axis=(1, 2, 3), keepdims=True), 0.05)
    off, moved = (float(np.quantile(np.abs(found - marched) / largest, 0.995)) for found in (stretches_of(renderer), another))
    print("99.5 %", off, "of another moment", moved)
    assert np.all(largest[:4] > 0.1), "two stretches at least"
    assert off < 1e-3 and moved > 5.0 * off


def test_samples_are_told_before_a_stopped_camera_shows_them(renderer: Renderer) -> None:
    """A few rays a frame, while media are shown as in motion. The first sharp picture is then summed over samples, as that of a camera that never moved."""
    scene = presets.load(["kerr"], SLAB | WITHOUT_DISK | {"media.slab.depth": 1.02})
    for turn in range(8):
        renderer.render(scene, 5.0 + turn, SIZE, glow_may_last=True)
    renderer.render(scene, 2.0, SIZE, glow_may_last=True)
    never_moved = stretches_of(renderer)
    renderer.render(scene.with_values({"camera.inclination_deg": scene.camera.inclination_deg + 1.0}), 1.0, SIZE, progressive=True)
    for number in range(60):
        report = renderer.render(scene, 1.0 + 0.01 * number, SIZE, progressive=True, glow_may_last=True)
        if report.sharp:
            break
    assert report.sharp and number > 3
    renderer.render(scene, 2.0, SIZE, glow_may_last=True)
    made = renderer.coarse_transfer._made
    assert made is not None and made.samples.is_whole and made.own_samples.is_whole
    np.testing.assert_array_equal(stretches_of(renderer), never_moved)


def test_a_moving_cameras_frames_tell_what_they_cost(renderer: Renderer) -> None:
    """A window learns nothing from frames that were for a picture to come: it drew all as coarse as it may."""
    scene = presets.load(["kerr"], SLAB | WITHOUT_DISK)
    for turn in (1.0, 2.0):
        report = renderer.render(scene.with_values({"camera.inclination_deg": scene.camera.inclination_deg + turn}), turn, SIZE, progressive=True)
        assert not report.sharpened and not report.sharp
    for number in range(60):
        report = renderer.render(scene, 3.0 + 0.01 * number, SIZE, progressive=True, glow_may_last=True)
        assert report.traced or report.sharp or report.sharpened
        if report.sharp:
            break


def test_no_program_of_samples_is_missing_once_a_picture_at_rest_was_drawn(renderer: Renderer, monkeypatch: pytest.MonkeyPatch) -> None:
    """A window prepares a scene anew where one is: those of samples were missed in every picture at rest, which therefore never became sharp."""
    scene = presets.load(["kerr"], SLAB | WITHOUT_DISK)
    renderer.programs.release()
    renderer.render(scene, 1.0, SIZE, glow_may_last=True)
    monkeypatch.setattr(renderer.programs, "deadline", -np.inf)
    for turn in range(8):
        renderer.render(scene, 2.0 + turn, SIZE, glow_may_last=True)
    assert not renderer.coarse_transfer.tells and renderer.coarse_transfer._made is not None and renderer.coarse_transfer._made.samples.is_whole


@pytest.mark.parametrize("runs", [False, True])
def test_no_program_is_missing_after_a_stop_once_a_window_has_rehearsed(renderer: Renderer, monkeypatch: pytest.MonkeyPatch, runs: bool) -> None:
    """It rehearses a picture at rest in which time stands, and one in motion; media as in motion before hits at rest had a program that neither has."""
    scene = presets.load(["kerr"], SLAB | WITHOUT_DISK)
    renderer.programs.release()
    monkeypatch.setattr(renderer.programs, "deadline", time.perf_counter() + 1e3)
    renderer.render(scene, 1.0, SIZE)
    renderer.render(scene.with_values({"camera.inclination_deg": scene.camera.inclination_deg + 1.0}), 1.0, SIZE, progressive=True)
    monkeypatch.setattr(renderer.programs, "deadline", -np.inf)
    for number in range(60):
        if renderer.render(scene, 1.0 + 0.01 * number * runs, SIZE, progressive=True, glow_may_last=runs).sharp:
            break
    renderer.render(scene, 2.0, SIZE, glow_may_last=runs)


def test_where_samples_would_be_too_many_rays_are_marched_on(renderer: Renderer, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(coarse_targets, "MOST_KEPT", 0)
    scene = presets.load(["kerr"], SLAB | BEFORE_DISK | {"rays.lensing": True, "media.slab.depth": 1.01})
    renderer.render(scene, 1.0, SIZE, glow_may_last=True)
    marched = stretches_of(renderer)
    for _ in range(4):
        renderer.render(scene, 5.0, SIZE, glow_may_last=True)
    renderer.render(scene, 1.0, SIZE, glow_may_last=True)
    np.testing.assert_array_equal(stretches_of(renderer), marched)


def test_media_are_drawn_with_all_else_where_things_lie_among_them() -> None:
    def way(values: dict, moving: bool = True) -> coarse_transfer.CoarseMedia | None:
        return coarse_transfer.of(FrameInputs.whole(make_plan(presets.load(["kerr"], values)), 0.0, SIZE), moving=moving, passes=not moving)

    found = way(SLAB)
    assert found is not None and found.step > 1
    assert way(SLAB, moving=False) is not None
    stays = way(FOG, moving=False)
    assert stays is not None and stays.exact and stays.step == 1, "it does not change"
    assert way({}) is None
    assert way(SLAB | {"things.moon.kind": "sphere"}) is None
    assert way(SLAB | {"rays.refine": False}) is None
    assert way(SLAB | PARALLEL) is not None
    assert way(SLAB | PARALLEL | {"hole.spin": 0.0, "rays.model": "schwarzschild"}) is None, "which begins to march at its bound"
