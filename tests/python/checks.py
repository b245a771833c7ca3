"""What must hold of ``import blackhole_gl``, run in a process of its own: each function here is a test, and makes as many GL contexts as it likes.

Prints, as JSON, the name of each with the text of what went wrong, or null.
"""

from __future__ import annotations

import io
import json
import math
import multiprocessing
import os
import subprocess
import sys
import tempfile
import threading
import traceback
from pathlib import Path

import numpy as np
from PIL import Image

import blackhole_gl as bh
from blackhole_gl import gl_thread, renderers
from blackhole_gl.notebook import Sliders

SIZE = (72, 40)
ROOT = Path(__file__).resolve().parents[2]


def a_picture_is_that_of_the_command_line_bit_for_bit() -> None:
    for values in ({"hole.spin": 0.5}, {"post.labels": True, "rays.in_stills": 2}):
        options = [part for key, value in values.items() for part in ("--set", f"{key}={str(value).lower()}")]
        with tempfile.TemporaryDirectory() as folder:
            out = Path(folder) / "x.png"
            command = [sys.executable, "-m", "blackhole_gl", "render", "kerr", *options, "--size", "160x90", "--time", "3", "-o", str(out)]
            subprocess.run(command, check=True, capture_output=True)
            written = np.asarray(Image.open(out))
        assert np.array_equal(bh.render(bh.load("kerr", values), (160, 90), time=3), written)


def two_renderers_used_in_turn_a_hundred_times_draw_what_each_should() -> None:
    scenes = bh.load("kerr"), bh.load("schwarzschild")
    truth = [bh.render(scene, SIZE) for scene in scenes]
    with bh.Renderer() as first, bh.Renderer() as second:
        for turn in range(100):
            assert np.array_equal(first.render(scenes[turn % 2], SIZE), truth[turn % 2])
            assert np.array_equal(second.render(scenes[turn % 2], SIZE), truth[turn % 2])
    assert np.array_equal(bh.render(scenes[0], SIZE), truth[0]), "the other's end is not this one's"


def what_is_no_scene_is_told_so_by_every_function() -> None:
    asked = [
        bh.render, bh.radiance, lambda scene: bh.trace(scene, psi=[0.1]), bh.hits, bh.lightcurve, bh.plan, bh.show, lambda scene: bh.save("a.png", scene),
        lambda scene: bh.save("a.toml", scene), lambda scene: bh.visibilities(scene, [1e9], [0.0]), bh.critical_curve,
        lambda scene: bh.isoradials(scene, [3.0]),
    ]  # fmt: skip
    for ask in asked:
        for value in ("kerr", None):
            try:
                ask(value)
            except TypeError as error:
                assert str(error).startswith("scene: got ") and "allowed is a Scene, as load('kerr') makes one" in str(error), error
            else:
                raise AssertionError(f"{ask} took {value!r}")


def curves_without_points_are_refused() -> None:
    for ask in (lambda: bh.critical_curve(bh.load("kerr"), 0), lambda: bh.isoradials(bh.load("kerr"), [3.0], samples=0)):
        try:
            ask()
        except ValueError as error:
            assert "samples: got 0; allowed is 1 point or more" in str(error)
        else:
            raise AssertionError("no points were drawn")


def threads_get_their_own_pictures() -> None:
    scenes = [bh.load("kerr", {"hole.spin": spin}) for spin in (0.0, 0.3, 0.6, 0.9)]
    truth = [bh.render(scene, SIZE) for scene in scenes]
    found: dict[int, list[bool]] = {}

    def draw(number: int) -> None:
        found[number] = [np.array_equal(bh.render(scenes[number], SIZE), truth[number]) for _ in range(5)]

    threads = [threading.Thread(target=draw, args=(number,)) for number in range(4)]
    for thread in threads:
        thread.start()
    for thread in threads:
        thread.join()
    assert found == {number: [True] * 5 for number in range(4)}


def a_process_forked_after_the_first_picture_draws_the_same() -> None:
    scene = bh.load("kerr")
    truth = bh.render(scene, SIZE)
    with multiprocessing.get_context("fork").Pool(1) as pool:  # whose processes may have no children of multiprocessing's kind
        assert np.array_equal(pool.apply(bh.render, (scene, SIZE)), truth)
        told = pool.apply(_error_of, (scene,))
    assert "size: got (0, 1)" in told, "errors come back as what they are"


def _error_of(scene: bh.Scene) -> str:
    try:
        bh.render(scene, (0, 1))
    except ValueError as error:
        return str(error)
    return ""


def numbers_may_be_numpys() -> None:
    values = {"hole.spin": np.float32(0.5), "rays.orders": np.int64(2), "disk.enabled": np.bool_(True), "camera.distance": np.array(12.0)}
    scene = bh.load("kerr", values)
    assert (scene.hole.spin, scene.rays.orders, scene.disk.enabled, scene.camera.distance) == (0.5, 2, True, 12.0)
    assert isinstance(scene.rays.orders, int) and isinstance(scene.disk.enabled, bool)
    picture = bh.render(scene, np.array(SIZE), np.float64(1.0), np.int32(1))
    assert np.array_equal(picture, bh.render(scene, SIZE, 1.0, 1))


def what_cannot_be_is_told_and_the_next_is_drawn() -> None:
    scene = bh.load("kerr")
    wrong = (
        (lambda: bh.render(scene, (40000, 10)), "size: got (40000, 10); allowed is (width, height), whole numbers from 1 to 32768"),
        (lambda: bh.render(scene, (10.5, 10)), "size: got (10.5, 10)"),
        (lambda: bh.render(scene, SIZE, math.nan), "time: got nan"),
        (lambda: bh.render(scene, SIZE, samples=17), "samples: got 17; allowed is 1 to 16"),
        (lambda: bh.trace(scene, alpha=1.0, beta=0.0), "takes psi and chi"),
        (lambda: bh.trace(scene, 4.0), "psi: allowed is 0 to π"),
        (lambda: bh.trace(scene, math.nan), "allowed are finite"),
        (lambda: bh.trace(scene, [0.1, 0.2], [0.0, 1.0, 2.0]), "got psi of shape (2,) and chi of shape (3,); allowed are shapes that broadcast"),
        (lambda: bh.load("kerr", {"hole.spim": 0.5}), "hole.spin"),
        (lambda: bh.load("kerr", {5: 0.5}), "got the key 5; allowed are keys in words, as hole.spin"),
        (lambda: bh.Renderer(gpu=99), "gpu: got 99; allowed is a number or a part of a name among 0: "),
        (lambda: bh.Renderer(gpu="no such card"), "gpu: got 'no such card'"),
        (lambda: bh.Renderer(backend="vulkan"), "allowed is one of auto, egl, osmesa"),
        (lambda: bh.save("x.gif", scene), "allowed is .png, .jpg, .jpeg, .toml, .exr, .fits, .npz"),
        (lambda: bh.save("x.jpeg", scene, linear=True), "linear: got x.jpeg; allowed with it is .png"),
        (lambda: bh.isoradials(scene, [0.5]), "allowed is between the horizon at"),
        (lambda: bh.critical_curve(bh.load("objects_undistorted")), "rays.model: got"),
    )
    for call, words in wrong:
        try:
            call()
        except ValueError as error:
            assert words in str(error), str(error)
        else:
            raise AssertionError(f"nothing was said: {words}")
    assert bh.render(scene, SIZE).any()


def a_renderer_that_failed_half_way_is_made_anew() -> None:
    thread = gl_thread.GlThread()
    truth = thread.call(renderers._rendered, bh.load("kerr"), 0.0, SIZE, 1)
    try:
        thread.call(_fail)
    except RuntimeError as error:
        assert str(error) == "half way"
    assert np.array_equal(thread.call(renderers._rendered, bh.load("kerr"), 0.0, SIZE, 1), truth)
    thread.close()


def _fail(renderer: object) -> None:
    renderer.ctx.release()  # nothing can be drawn with it any more
    raise RuntimeError("half way")


def a_closed_renderer_says_so() -> None:
    renderer = bh.Renderer()
    renderer.render(bh.load("kerr"), SIZE)
    renderer.close()
    renderer.close()
    try:
        renderer.render(bh.load("kerr"), SIZE)
    except RuntimeError as error:
        assert str(error) == "this renderer was closed"
    else:
        raise AssertionError("it drew")


def memory_stays_flat() -> None:
    scenes = [bh.load("kerr", {"hole.spin": spin}) for spin in np.linspace(0.1, 0.9, 10)]

    def draw(number: int) -> float:
        for count in range(number):
            bh.render(scenes[count % 10], SIZE)
        return int(Path("/proc/self/statm").read_text().split()[1]) * os.sysconf("SC_PAGESIZE") / 2**20

    begun = draw(50)
    # A picture and its parts have 0.1 MB: a hundredth of them kept would be 0.2 MB in so many, all of them 20 MB.
    assert draw(200) - begun < 4.0


def hits_are_those_of_rays_through_the_pixels() -> None:
    """Also with a camera that looks aside and is rolled."""
    for values in ({}, {"camera.yaw_deg": 4.0, "camera.pitch_deg": -3.0, "camera.roll_deg": 30.0}, {"camera.distance": math.inf, "camera.roll_deg": 30.0}):
        scene = bh.load("kerr", values)
        hits = bh.hits(scene, SIZE)
        assert hits.fate.shape == (40, 72) and hits.crossing.shape == (40, 72, 3, 2)
        edge = bh.critical_curve(scene, 64)
        x, y = edge.in_pixels(scene, SIZE)
        middle = np.array([x.mean(), y.mean()])
        for stretch, fate in ((0.8, bh.Fate.CAPTURED), (1.25, bh.Fate.ESCAPED)):
            places = (middle + stretch * (np.stack([x, y], -1) - middle)).astype(int)
            there = np.all((places >= 0) & (places < SIZE), axis=-1)
            assert there.any() and np.all(hits.fate[places[there, 1], places[there, 0]] == fate), (values, stretch)


def rays_come_back_in_the_shape_they_had() -> None:
    found = bh.trace(bh.load("kerr"), np.linspace(0.0, 0.6, 5)[:, None], [0.0, 1.0, 2.0])
    assert found.fate.shape == (5, 3) and found.direction.shape == (5, 3, 3) and found.g.shape == (5, 3, 3)
    assert np.all(found.fate[0] == bh.Fate.CAPTURED) and np.allclose(np.linalg.norm(found.direction[-1], axis=-1), 1.0)
    assert bh.trace(bh.load("kerr"), 0.5).fate.shape == ()
    assert bh.trace(bh.load("kerr"), np.zeros((0, 2))).g.shape == (0, 2, 3)


def isoradials_are_where_rays_cross_the_disk() -> None:
    for distance in (10.0, math.inf):
        scene = bh.load("kerr", {"camera.distance": distance})
        for curve in bh.isoradials(scene, [3.0, 6.0], [0, 1], samples=24):
            psi = np.arctan(np.hypot(curve.alpha, curve.beta) / (2.0 * distance))
            rays = bh.trace(scene, psi, curve.angle) if math.isfinite(distance) else bh.trace(scene, alpha=curve.alpha, beta=curve.beta)
            # The ring of order 1 is so thin that a ray's error, 1e-5 rad, is 1e-3 of a radius there.
            assert np.allclose(rays.crossing[:, curve.order, 0], curve.radius, rtol=1e-4 if curve.order == 0 else 2e-3)


def radiance_is_linear_and_before_the_tone_map() -> None:
    full = bh.load("kerr").get("disk.emission_strength")
    none, half, whole = (bh.radiance(bh.load("kerr", {"disk.emission_strength": share * full}), SIZE) for share in (0.0, 0.5, 1.0))
    assert whole.dtype == np.float32 and whole.shape == (40, 72, 3)
    assert abs((whole - half).sum() / (half - none).sum() - 1.0) < 1e-3  # half floats
    assert np.array_equal(bh.radiance(bh.load("kerr", {"post.exposure": 2.0}), SIZE), whole)


def a_scene_shows_itself_in_a_notebook() -> None:
    picture = Image.open(io.BytesIO(bh.load("kerr")._repr_png_()))
    assert picture.size == (640, 360)


def sliders_draw_their_scene_anew() -> None:
    """As a browser moves them: by their values."""
    made = Sliders(bh.load("kerr"), ["hole.spin", "camera.distance", "disk.enabled", "disk.orbit", "rays.orders", "disk.inner_radius"], SIZE)
    picture, spin, distance, disk, orbit, orders, inner, told = made.widget.children
    assert [control.value for control in (spin, distance, disk, orbit, orders)] == [0.9, 20.0, True, "prograde", 3]
    for control, value in ((spin, 0.25), (distance, 40.0), (disk, False), (disk, True), (orbit, "retrograde"), (orders, 1)):
        control.value = value
        assert np.array_equal(np.asarray(Image.open(io.BytesIO(picture.value))), bh.render(made.scene, SIZE))
    assert made.scene == bh.load("kerr", {"hole.spin": 0.25, "camera.distance": 40.0, "disk.orbit": "retrograde", "rays.orders": 1})
    kept = picture.value
    inner.value = 15.0
    assert "disk.inner_radius: got 15; allowed is at most 10" in told.value and made.scene.disk.inner_radius == 0.0 and picture.value == kept
    inner.value = 5.0
    assert told.value == "" and made.scene.disk.inner_radius == 5.0
    assert "application/vnd.jupyter.widget-view+json" in made._repr_mimebundle_()
    for key in ("sky.picture.file", "no.such"):
        try:
            Sliders(bh.load("kerr"), [key], SIZE)
        except ValueError as error:
            assert key in str(error)
        else:
            raise AssertionError(key)


def what_is_saved_opens_again() -> None:
    with tempfile.TemporaryDirectory() as folder:
        scene = bh.load("kerr", {"hole.spin": 0.25})
        for name in ("x.png", "x.toml"):
            assert bh.load(bh.save(Path(folder) / name, scene, SIZE)) == scene


def the_viewer_opens_on_a_scene() -> None:
    """Without a display it draws that scene and says so."""
    hidden = {name: os.environ.pop(name) for name in ("DISPLAY", "WAYLAND_DISPLAY") if name in os.environ}
    before = Path.cwd()
    try:
        with tempfile.TemporaryDirectory() as folder:
            os.chdir(folder)
            assert bh.show(bh.load("kerr", {"hole.spin": 0.125})).returncode == 0
            assert bh.load("blackhole.png").hole.spin == 0.125
            os.chdir(before)
    finally:
        os.chdir(before)
        os.environ.update(hidden)


CHECKS = {name: made for name, made in list(globals().items()) if callable(made) and getattr(made, "__module__", "") == __name__ and name[0] != "_"}


def _outcome(check) -> str | None:
    try:
        check()
    except BaseException:
        return traceback.format_exc()
    return None


if __name__ == "__main__":
    sys.stdout.flush()
    results, said = {}, os.dup(1)
    os.dup2(2, 1)  # what checks print is not the answer
    for name, check in CHECKS.items():
        results[name] = _outcome(check)
    os.write(said, json.dumps(results).encode())
