"""Where the picture lies in the window, and what it shows while programs are missing."""

import math
import time as clock
from concurrent.futures import Future
from types import SimpleNamespace

import numpy as np
import pytest

from blackhole_gl import planning
from blackhole_gl.app.area import Area
from blackhole_gl.app.picture import Picture
from blackhole_gl.app.preparation import Preparation
from blackhole_gl.rendering.programs import Unready
from blackhole_gl.rendering.supersampling import MOST_SAMPLES
from blackhole_gl.scene import Scene
from tests.app.fake_renderer import FakeRenderer

PLAIN = Scene()


def test_coarse_pictures_have_a_pixel_at_least():
    assert Area(0, 0, 1, 3).scaled(0.25) == (1, 1)
    assert Area(0, 0, 0, 3).is_empty


@pytest.mark.parametrize("scale", [2.0 ** (-step / 8.0) for step in range(17)])
def test_coarse_pictures_have_no_textures_that_drivers_compile_anew_for(scale):
    for width, height in [(1280, 720), (1021, 512), (900, 640), (3840, 2160)]:
        for side, pixels in zip(Area(0, 0, width, height).scaled(scale), (width, height)):
            quarter = math.ceil(side / 4)
            assert scale == 1.0 and side == pixels or not math.log2(quarter).is_integer()
            assert pixels * scale - 4.5 <= side <= pixels * scale + 0.5


def test_area_is_in_framebuffer_pixels_from_the_bottom():
    assert Area.of_screen(0, 20, 300, 100, 200, (1.0, 1.0)) == Area(0, 80, 300, 100)
    assert Area.of_screen(0, 20, 300, 100, 200, (2.0, 2.0)) == Area(0, 160, 600, 200)


def test_neighbouring_areas_leave_no_gap_at_odd_scales():
    left = Area.of_screen(0, 0, 333, 100, 100, (1.25, 1.25))
    right = Area.of_screen(333, 0, 100, 100, 100, (1.25, 1.25))
    assert left.x + left.width == right.x


def test_a_part_of_a_picture_lies_over_what_is_there(ctx):
    area, window = Area(2, 1, 8, 4), ctx.simple_framebuffer((12, 6))
    there, over = (Picture(ctx, FakeRenderer(ctx), Preparation(None)) for _ in range(2))
    for picture, azimuth in ((there, -180.0), (over, 180.0)):
        while not picture.is_current:
            picture.update(Scene().with_values({"camera.azimuth_deg": azimuth}), 0.0, area, moving=False, camera_moving=False)
    there.draw(window, area)
    over.draw_part(window, area, Area(7, 1, 3, 4))
    red = np.frombuffer(window.read(components=3, alignment=1), np.uint8).reshape(6, 12, 3)[..., 0]
    assert (red[1:5, 2:7] == 64).all() and (red[1:5, 7:10] == 191).all()
    outside = np.ones_like(red, bool)
    outside[1:5, 2:10] = False
    assert not red[outside].any(), "black beside the picture"
    over.draw_part(window, area, Area(10, 1, 0, 4))
    there.draw(window, area)
    red = np.frombuffer(window.read(components=3, alignment=1), np.uint8).reshape(6, 12, 3)[..., 0]
    assert (red[1:5, 2:10] == 64).all(), "nothing of the part stays set"


class Renderer(FakeRenderer):
    """Compiles a program for each integrator and look, unless its deadline has passed."""

    def __init__(self, gl):
        super().__init__(gl)
        self.compiled = set()

    def render(self, scene, time, size, target=None, **how):
        program = planning.plan(scene).scene.rays.integrator, scene.disk.enabled
        if program not in self.compiled:
            if self.programs.deadline < clock.perf_counter():
                raise Unready
            self.compiled.add(program)
        return super().render(scene, time, size, target, **how)

    @property
    def integrators(self):
        """Of the pictures drawn so far."""
        return [planning.plan(scene).scene.rays.integrator for scene, *_ in self.calls]


class Moving:
    """A picture under a camera that a test tilts; the plan takes another model and integrator above 30° and above 60°."""

    def __init__(self, ctx, monkeypatch):
        monkeypatch.setattr(planning, "plan", lambda scene: SimpleNamespace(scene=self._resolved(scene)))
        self.work, self._time = [], 0.0
        self.renderer = Renderer(ctx)
        self.picture = Picture(ctx, self.renderer, Preparation(self._submit))
        self.scene = Scene().with_values({"camera.inclination_deg": 20.0})
        while not self.picture.is_current:
            self.draw()

    def _resolved(self, scene):
        if scene.rays.integrator != "auto":
            return scene
        model, integrator = (("kerr", "rk4"), ("schwarzschild_binet", "nystrom5"), ("kerr", "nystrom4"))[int(scene.camera.inclination_deg // 30.0)]
        return scene.with_values({"rays.model": model, "rays.integrator": integrator})

    def _submit(self, scene, size):
        self.work.append((planning.plan(scene).scene.rays.integrator, Future()))
        return self.work[-1][1]

    def draw(self, **values):
        """Whether a picture was drawn of the scene with `values`, keys with an underscore for the dot."""
        self.scene = self.scene.with_values({key.replace("_", ".", 1): value for key, value in values.items()})
        self._time += 0.1  # the disk turns
        return self.picture.update(self.scene, self._time, Area(0, 0, 64, 36), moving=True, camera_moving=True)


@pytest.fixture
def moving(ctx, monkeypatch):
    return Moving(ctx, monkeypatch)


def test_a_moving_picture_goes_on_while_another_method_is_prepared(moving):
    assert not moving.draw(camera_inclination_deg=40.0), "seen to be missing"
    assert all(moving.draw(camera_inclination_deg=40.0 + tilt) for tilt in range(5))
    assert moving.renderer.integrators[-5:] == ["rk4"] * 5 and moving.renderer.calls[-1][0].camera.inclination_deg == 44.0
    assert moving.picture.bridges and not moving.picture.is_current
    moving.work[0][1].set_result(None)
    assert moving.draw(camera_inclination_deg=45.0) and moving.draw(camera_inclination_deg=46.0)
    assert moving.renderer.integrators[-2:] == ["nystrom5"] * 2
    assert moving.picture.is_current and [integrator for integrator, _ in moving.work] == ["nystrom5"]


def test_a_picture_that_rests_becomes_that_of_the_plan(moving):
    moving.draw(camera_inclination_deg=40.0)
    moving.draw()
    moving.work[0][1].set_result(None)
    moving.draw()
    moving.draw()
    assert moving.picture.is_current and moving.renderer.integrators[-1] == "nystrom5"
    assert moving.renderer.calls[-1][0] == moving.scene


def test_a_third_method_is_prepared_after_the_second(moving):
    """The window does not compile it in a frame of its own, though what it waited for is done."""
    moving.draw(camera_inclination_deg=40.0)
    moving.draw(camera_inclination_deg=70.0)
    moving.work[0][1].set_result(None)
    assert moving.draw() and moving.renderer.integrators[-1] == "nystrom5"
    assert not moving.draw() and [integrator for integrator, _ in moving.work] == ["nystrom5", "nystrom4"]
    assert moving.draw() and moving.renderer.integrators[-1] == "nystrom5"
    moving.work[1][1].set_result(None)
    assert moving.draw() and moving.renderer.integrators[-1] == "nystrom4"


def test_methods_change_to_and_fro_at_once_when_both_have_been_drawn_with(moving):
    moving.draw(camera_inclination_deg=40.0)
    moving.work[0][1].set_result(None)
    assert all([moving.draw(camera_inclination_deg=inclination) for inclination in (40.0, 20.0, 40.0, 20.0)])
    assert moving.renderer.integrators[-4:] == ["nystrom5", "rk4", "nystrom5", "rk4"] and len(moving.work) == 1


@pytest.mark.parametrize(
    "values",
    [
        {"disk_enabled": False},
        {"disk_enabled": False, "camera_inclination_deg": 40.0},
        {"rays_tolerance": 0.1, "camera_inclination_deg": 40.0},
        {"hole_spin": 0.5, "camera_inclination_deg": 40.0},
        {"camera_distance": 0.4, "camera_inclination_deg": 40.0},
    ],
)
def test_another_scene_is_not_drawn_by_an_earlier_method(moving, values):
    drawn = len(moving.renderer.calls)
    assert not any(moving.draw(**values) for _ in range(3))
    assert len(moving.renderer.calls) == drawn and len(moving.work) == 1
    moving.work[0][1].set_result(None)
    while not moving.picture.is_current:
        moving.draw()
    assert moving.renderer.calls[-1][0] == moving.scene


@pytest.fixture
def resting(ctx):
    """A picture that nothing happens to, drawn by a renderer of flat colours."""
    picture = Picture(ctx, FakeRenderer(ctx), Preparation(lambda scene, size: None))

    def draw(scene=PLAIN, time=0.0):
        return picture.update(scene, time, Area(0, 0, 64, 36), moving=False, camera_moving=False)

    while not picture.is_current:
        draw()
    return picture, draw


def test_a_resting_picture_takes_more_rays_a_pixel_and_then_no_more(resting):
    picture, draw = resting
    drawn = 0
    while not picture.is_final:
        assert draw()
        drawn += 1
        assert picture.samples == drawn
    assert drawn == MOST_SAMPLES
    calls = len(picture.renderer.calls)
    assert not draw() and len(picture.renderer.calls) == calls


def test_what_moves_again_begins_with_one_ray_a_pixel(resting):
    picture, draw = resting
    draw(), draw(), draw()
    assert picture.samples == 3
    assert draw(time=1.0) and picture.samples == 1 and not picture.is_final
    draw(time=1.0), draw(time=1.0)
    assert picture.samples == 2


@pytest.mark.parametrize("view, samples", [("unresolved", 1), ("steps", MOST_SAMPLES)])
def test_a_view_of_single_rays_has_one_a_pixel(resting, view, samples):
    picture, draw = resting
    view = Scene().with_values({"post.view": view})
    while not picture.is_final:
        draw(view)
    assert picture.samples == samples


def test_where_one_more_ray_takes_long_the_window_answers_first(resting, monkeypatch):
    """Half a second in which no key is heard is too long for a smoother edge."""
    picture, draw = resting
    plain = picture.renderer.render_finer
    monkeypatch.setattr(picture.renderer, "render_finer", lambda *given, **named: (clock.sleep(0.6), plain(*given, **named))[1])
    draw()
    assert not picture.is_final, "once may be chance"
    draw()
    assert picture.is_final and picture.samples == 2


def test_what_failed_is_not_drawn_finer(resting):
    picture, draw = resting
    draw()
    picture.renderer.fail = RuntimeError("out of order")
    with pytest.raises(RuntimeError):
        draw(time=1.0)
    assert not draw(time=1.0), "nor tried again"


class Shown:
    """A window of 96 × 54 pixels with a picture at its lower left that a test turns; what it shows is told by the colours of a renderer of flat ones."""

    AREA = Area(0, 0, 64, 36)

    def __init__(self, ctx, renderer, submit=lambda scene, size: Future()):
        self.picture = Picture(ctx, renderer, Preparation(submit))
        self.window = ctx.simple_framebuffer((96, 54))
        self._time = 0.0
        while not self.picture.is_current:
            self.draw(0.0, moving=False)

    def draw(self, azimuth, *, moving=True, disk=True):
        """A frame of the window; a moving picture's disk has turned. Returns whether a picture was rendered."""
        self._time += 0.1 if moving else 0.0
        self.window.clear(0.0, 1.0, 0.0)
        scene = Scene().with_values({"camera.azimuth_deg": azimuth, "playback.target_fps": 0.0, "disk.enabled": disk})
        try:
            return self.picture.update(scene, self._time, self.AREA, moving=moving, camera_moving=False, window=self.window)
        finally:
            self.picture.draw(self.window, self.AREA)

    def seen(self):
        """The azimuth that the picture's middle and its corner tell, to a degree; beside it all is black."""
        pixels = np.frombuffer(self.window.read(components=3), np.uint8).reshape(54, 96, 3)
        assert not pixels[:, 64:].any() and not pixels[36:].any()
        assert np.array_equal(pixels[18, 32], pixels[35, 63])
        return 720.0 * (pixels[18, 32, 0] / 255.0 - 0.5)


@pytest.fixture
def shown(ctx):
    return Shown(ctx, FakeRenderer(ctx))


def close(azimuth):
    return pytest.approx(azimuth, abs=2.0)  # half a grey level is 1.4 degrees


def test_a_moving_picture_goes_into_the_window_at_once_and_is_kept_when_it_rests(shown):
    for azimuth in (20.0, 40.0, 60.0):
        assert shown.draw(azimuth) and shown.seen() == close(azimuth)
    drawn = len(shown.picture.renderer.calls)
    assert shown.draw(60.0, moving=False) and shown.seen() == close(60.0)
    assert shown.picture.renderer.calls[-1] == shown.picture.renderer.calls[-2], "the same, into the texture"
    shown.draw(60.0, moving=False)
    assert len(shown.picture.renderer.calls) == drawn + 1 and shown.seen() == close(60.0)
    assert 720.0 * (shown.picture.read_rgb8()[0, 0, 0] / 255.0 - 0.5) == close(60.0)


def test_a_glow_may_last_only_while_time_alone_runs(shown):
    """Neither in a picture under a moving camera, nor in one that stays."""
    shown.draw(20.0), shown.draw(20.0)
    assert shown.picture.renderer.glow_may_last
    shown.draw(20.0, moving=False)
    assert not shown.picture.renderer.glow_may_last, "kept as it is without"
    shown.picture.update(PLAIN, 9.0, Shown.AREA, moving=True, camera_moving=True, window=shown.window)
    assert not shown.picture.renderer.glow_may_last


def test_the_last_good_picture_stays_where_only_the_window_had_it(shown):
    shown.draw(20.0), shown.draw(40.0)
    render, failures = shown.picture.renderer.render, []

    def fails_once(*given, **named):
        if not failures:
            failures.append(given)
            raise RuntimeError("out of order")
        return render(*given, **named)

    shown.picture.renderer.render = fails_once
    with pytest.raises(RuntimeError, match="out of order"):
        shown.draw(60.0)
    assert shown.seen() == close(40.0)
    assert shown.draw(80.0) and shown.seen() == close(80.0)


def test_a_renderer_that_can_do_nothing_any_more_tells_of_the_first_failure(shown):
    shown.draw(20.0), shown.draw(40.0)
    shown.picture.renderer.fail = RuntimeError("out of order")
    with pytest.raises(RuntimeError, match="out of order"):
        shown.draw(60.0)
    shown.seen()  # some earlier picture


def test_a_picture_is_drawn_on_until_its_exposure_has_settled(shown):
    renderer = shown.picture.renderer
    renderer.settled = False
    assert shown.draw(20.0, moving=False) and shown.draw(20.0, moving=False) and not shown.picture.is_final
    renderer.settled = True
    assert shown.draw(20.0, moving=False) and renderer.finer == 0
    shown.draw(20.0, moving=False)
    assert renderer.finer == 1, "and then finer"


def test_the_last_picture_stays_while_programs_are_missing(shown):
    shown.draw(20.0), shown.draw(40.0)
    render = shown.picture.renderer.render

    def missing(scene, *given, **named):
        if scene.camera.azimuth_deg == 60.0:
            raise Unready
        return render(scene, *given, **named)

    shown.picture.renderer.render = missing
    for _ in range(3):
        assert not shown.draw(60.0) and shown.seen() == close(40.0)
        assert shown.picture.shown.camera.azimuth_deg == 40.0, "what is written over it is about that one"


def test_the_coarse_pictures_that_begin_another_scene_are_never_seen(ctx):
    done = Future()
    done.set_result(None)
    shown = Shown(ctx, Renderer(ctx), lambda scene, size: done)
    shown.draw(20.0), shown.draw(40.0)
    sizes, seen = shown.picture.renderer.calls, []
    before = len(sizes)
    while not seen or not shown.picture.is_current:
        rendered = shown.draw(60.0, disk=False)
        assert rendered == shown.picture.is_current and shown.picture.scale == 1.0
        assert shown.seen() == close(60.0 if shown.picture.is_current else 40.0)
        seen.append(rendered)
    assert seen == [False, False, False, False, True], "missed, rehearsed three times, drawn"
    assert [size for *_, size in sizes[before:]] == [Shown.AREA.size, *[(16, 9)] * 3, Shown.AREA.size], "kept, and the rest"
    assert shown.picture.renderer.turnable[-4:-1] == [False] * 3, "they would leave light by direction that is as coarse"


def test_a_coarse_picture_is_shown_where_there_is_none_yet(ctx):
    """With the fewest programs: those that draw stars apart come with the next."""
    picture = Picture(ctx, FakeRenderer(ctx), Preparation(None))

    def update():
        return picture.update(PLAIN, 0.0, Shown.AREA, moving=False, camera_moving=False)

    assert update()
    assert picture.renderer.calls[0][2] == (16, 9) and picture.read_rgb8().shape == (9, 16, 3) and not picture.is_current
    assert picture.renderer.stars == []
    assert not update() and len(picture.renderer.stars) == 1


def test_a_coarse_picture_is_enlarged_and_its_stars_drawn_over_it(ctx):
    renderer = FakeRenderer(ctx)
    shown = Shown(ctx, renderer)
    scene = Scene().with_values({"camera.azimuth_deg": 50.0, "playback.target_fps": 120.0})
    renderer.us_per_pixel = 100.0
    for step in range(30):
        shown.window.clear(0.0, 1.0, 0.0)
        shown.picture.update(scene, 10.0 + step, Shown.AREA, moving=True, camera_moving=True, window=shown.window)
        shown.picture.draw(shown.window, Shown.AREA)
        assert shown.seen() == close(50.0)
    assert shown.picture.scale < 1.0
    assert renderer.stars[-1] == (renderer.calls[-1][2], Shown.AREA.viewport)
