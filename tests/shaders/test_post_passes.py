"""Post: tone curves, bloom, dither, and pictures of every size."""

from __future__ import annotations

import moderngl
import numpy as np
import pytest

from blackhole_gl import planning
from blackhole_gl.rendering.frame import Renderer
from blackhole_gl.rendering.inputs import FrameInputs
from blackhole_gl.rendering.post import GLOW_LASTS, PostPass, bloom_sizes
from blackhole_gl.rendering.programs import Programs
from blackhole_gl.scene import Scene

CURVES = ("linear", "reinhard", "aces", "agx")
QUIET = {"post.dither": False, "post.bloom": False}


@pytest.fixture(scope="module")
def renderer(ctx):
    made = Renderer(ctx)
    yield made
    made.release()


@pytest.fixture(scope="module")
def developed(ctx, renderer):
    """(radiance (h, w, 3), scene values) → picture as floats (h, w, 3) in a float target."""

    def run(radiance: np.ndarray, **values) -> np.ndarray:
        height, width, _ = radiance.shape
        scene = Scene().with_values({**QUIET, **{key.replace("__", ".", 1): value for key, value in values.items()}})
        data = np.concatenate([radiance, np.ones((height, width, 1))], -1).astype(np.float16)
        source = ctx.texture((width, height), 4, data.tobytes(), dtype="f2")
        target = ctx.framebuffer([ctx.texture((width, height), 4, dtype="f4")])
        post = PostPass(ctx, renderer.programs)
        post.draw(FrameInputs.whole(planning.plan(scene), 0.0, (width, height)), source, target, (0, 0, width, height))
        found = np.frombuffer(target.color_attachments[0].read(), np.float32).reshape(height, width, 4)[..., :3].copy()
        post.release()
        return found

    return run


def ramp(stops: float = 14.0) -> np.ndarray:
    """Greys from 2^-stops to 2^stops in one row, and 0 first."""
    return np.repeat(np.concatenate([[0.0], np.geomspace(2.0**-stops, 2.0**stops, 511)])[None, :, None], 3, axis=2)


@pytest.mark.parametrize("curve", CURVES)
def test_tone_curves_rise_from_black_to_white(developed, curve: str) -> None:
    """Monotone up to the rounding of float32 powers, 2e-6; black is black and 14 stops over is white."""
    grey = developed(ramp(), post__tone_map=curve)[0, :, 1]
    assert np.isfinite(grey).all() and grey.min() >= 0.0 and grey.max() <= 1.0
    assert np.diff(grey).min() >= -2e-6
    assert grey[0] <= 1e-3 and grey[-1] >= 0.99


@pytest.mark.parametrize("curve", CURVES)
@pytest.mark.parametrize("colour", [(1.0, 0.0, 0.0), (0.0, 0.0, 1.0), (1.0, 0.4, 0.05)])
def test_saturated_colours_stay_on_the_screen(developed, curve: str, colour) -> None:
    found = developed(ramp() * np.array(colour), post__tone_map=curve)
    assert np.isfinite(found).all() and found.min() >= 0.0 and found.max() <= 1.0


def test_agx_keeps_middle_grey(developed) -> None:
    """The sRGB code of 0.18 is 0.461; the curve is built to keep it within one grey level."""
    grey = developed(np.full((1, 1, 3), 0.18), post__tone_map="agx")
    assert grey[0, 0, 1] == pytest.approx(0.461, abs=1 / 255)


def test_linear_is_the_srgb_transfer(developed) -> None:
    """IEC 61966-2-1 in float64. 1e-3: radiance is stored in half floats, of 11 bits."""
    light = np.linspace(0.0, 1.0, 256)
    expected = np.where(light <= 0.0031308, 12.92 * light, 1.055 * light ** (1 / 2.4) - 0.055)
    found = developed(np.repeat(light[None, :, None], 3, axis=2), post__tone_map="linear")[0, :, 0]
    np.testing.assert_allclose(found, expected, atol=1e-3)




def test_the_tone_table_is_the_curve(developed) -> None:
    """Against the formulas in float64. 0.1 grey levels: entries are 2^-10 of the light apart (0.05 levels at white, by the nearest), half floats 2^-11.

    So at most about one pixel in ten comes out a grey level off, and none by two.
    """
    light = np.geomspace(2.0**-12, 2.0**6, 4096).astype(np.float16).astype(float)
    exposed = light * 2.0**0.7
    shown = np.clip(exposed * (2.51 * exposed + 0.03) / (exposed * (2.43 * exposed + 0.59) + 0.14), 0.0, 1.0) ** (1 / 1.3)
    expected = np.where(shown <= 0.0031308, 12.92 * shown, 1.055 * shown ** (1 / 2.4) - 0.055)
    found = developed(np.repeat(light[None, :, None], 3, axis=2), post__tone_map="aces", post__gamma=1.3, post__exposure=0.7)[0, :, 1]
    np.testing.assert_allclose(255.0 * found, 255.0 * expected, atol=0.1)


def test_the_tone_table_follows_every_number(ctx, renderer) -> None:
    """One pass, a number after the other: nothing of the table before is left."""

    def picture(**values) -> np.ndarray:
        renderer.render(Scene().with_values({**QUIET, **values}), 0.0, (36, 20))
        return renderer.read_rgb8().astype(int)

    plain = picture()
    for change in ({"post.exposure": 1.0}, {"post.gamma": 1.5}, {"post.tone_map": "linear"}, {"post.tone_map": "agx"}):
        assert np.abs(picture(**change) - plain).max() > 8, change
    np.testing.assert_array_equal(picture(), plain)


def test_a_picture_larger_than_its_radiance_is_filtered(ctx, renderer) -> None:
    """A step of light, shown twice as large, has pixels between its sides."""
    scene = Scene().with_values(QUIET)
    data = np.zeros((8, 8, 4), np.float16)
    data[:, 4:] = 0.2
    source = ctx.texture((8, 8), 4, data.tobytes(), dtype="f2")
    target = ctx.framebuffer([ctx.texture((16, 16), 4)])
    post = PostPass(ctx, renderer.programs)
    post.draw(FrameInputs.whole(planning.plan(scene), 0.0, (8, 8)), source, target, (0, 0, 16, 16))
    row = np.frombuffer(target.read(components=3), np.uint8).reshape(16, 16, 3)[8, :, 0]
    assert len(set(row.tolist())) == 4 and (np.diff(row.astype(int)) >= 0).all()
    for item in (post, source, target):
        item.release()


def test_each_stop_doubles_the_light(developed) -> None:
    light = np.full((1, 4, 3), 0.05)
    np.testing.assert_allclose(developed(light * 4.0, post__tone_map="linear"), developed(light, post__tone_map="linear", post__exposure=2.0), atol=1e-3)


def test_gamma_lifts_or_sinks_the_middle_and_keeps_the_ends(developed) -> None:
    light = np.repeat(np.array([0.0, 0.25, 1.0])[None, :, None], 3, axis=2)
    plain, lifted = (developed(light, post__tone_map="linear", post__gamma=g)[0, :, 0] for g in (1.0, 2.0))
    assert lifted[1] > plain[1] + 0.1
    np.testing.assert_allclose(lifted[[0, 2]], plain[[0, 2]], atol=1e-3)


def test_dither_is_small_fair_and_the_same_each_time(developed) -> None:
    """At most one grey level; its mean over 16,384 pixels within 1/50 of a level; black and white stay clean."""
    grey = np.full((128, 128, 3), 0.02)
    plain = developed(grey, post__tone_map="linear")
    first, second = (developed(grey, post__tone_map="linear", post__dither=True) for _ in range(2))
    np.testing.assert_array_equal(first, second)
    noise = (first - plain) * 255.0
    assert np.abs(noise).max() <= 1.0 + 1e-4
    assert abs(noise.mean()) < 0.02 and noise.std() > 0.3
    for level in (0.0, 1.0):
        clean = developed(np.full((16, 16, 3), level), post__tone_map="linear", post__dither=True)
        np.testing.assert_allclose(clean, level, atol=1e-6)


def glow(ctx, renderer, radiance: np.ndarray, **values) -> np.ndarray:
    """The accumulated glow of `radiance`, before its intensity."""
    height, width, _ = radiance.shape
    scene = Scene().with_values({key.replace("__", ".", 1): value for key, value in values.items()})
    data = np.concatenate([radiance, np.ones((height, width, 1))], -1).astype(np.float16)
    source = ctx.texture((width, height), 4, data.tobytes(), dtype="f2")
    source.repeat_x = source.repeat_y = False
    post = PostPass(ctx, renderer.programs)
    texture = post._bloom(FrameInputs.whole(planning.plan(scene), 0.0, source.size), source)
    found = np.frombuffer(texture.read(), np.float16).reshape(texture.height, texture.width, 4)[..., :3].astype(float)
    post.release()
    return found


@pytest.mark.parametrize("spread", [0.1, 1.0, 3.0])
def test_bloom_keeps_the_light(ctx, renderer, spread: float) -> None:
    """A bright spot far from the border: the glow's mean is the spot's. 2 %: half floats, and a wide glow's clamped border."""
    radiance = np.zeros((256, 256, 3))
    radiance[120:136, 120:136] = 50.0
    found = glow(ctx, renderer, radiance, post__bloom_threshold=0.0, post__bloom_spread=spread)
    assert found.mean() == pytest.approx(radiance.mean(), rel=0.02 if spread < 3.0 else 0.1)


def test_bloom_of_a_star_does_not_depend_on_where_it_falls(ctx, renderer) -> None:
    sums = []
    for x in range(128, 136):
        radiance = np.zeros((256, 256, 3))
        radiance[130, x] = 100.0
        sums.append(glow(ctx, renderer, radiance, post__bloom_threshold=0.0).sum())
    assert max(sums) / min(sums) < 1.02  # half floats


def test_nothing_below_the_threshold_glows(ctx, renderer) -> None:
    assert glow(ctx, renderer, np.full((64, 64, 3), 0.3), post__bloom_threshold=0.68).max() == 0.0
    kept = glow(ctx, renderer, np.full((64, 64, 3), 3.0), post__bloom_threshold=1.0)
    np.testing.assert_allclose(kept, 2.0, rtol=2e-3)  # L − threshold, in half floats


def test_wider_spread_glows_farther(ctx, renderer) -> None:
    radiance = np.zeros((256, 256, 3))
    radiance[128, 128] = 1000.0
    near, far = (glow(ctx, renderer, radiance, post__bloom_threshold=0.0, post__bloom_spread=s) for s in (0.3, 2.0))
    assert far[32, 60, 0] > 1.5 * near[32, 60, 0] and far[32, 32, 0] < near[32, 32, 0]


@pytest.mark.parametrize("size", [(1, 1), (3, 5), (1, 300), (257, 2), (64, 64)])
def test_levels_are_never_empty(size: tuple[int, int]) -> None:
    levels = list(bloom_sizes(size))
    assert levels and all(min(level) >= 1 for level in levels)


@pytest.mark.parametrize("size", [(1, 1), (64, 36), (256, 256), (1000, 562)])
def test_no_level_but_the_first_has_a_side_that_drivers_compile_anew_for(ctx, renderer, size: tuple[int, int]) -> None:
    post = PostPass(ctx, renderer.programs)
    post._make_levels(next(bloom_sizes(size)))
    assert [level.size for level in post._down] == list(bloom_sizes(size))
    for level in (*post._down[1:], *post._up[:-1]):
        assert all(side & (side - 1) for side in level.texture.size)
        assert all(0 <= there - used <= 2 for there, used in zip(level.texture.size, level.size))
    post.release()


@pytest.mark.parametrize("size", [(1, 1), (3, 5), (17, 1), (33, 47)])
@pytest.mark.parametrize("bloom", [True, False])
def test_small_and_odd_pictures(renderer, size: tuple[int, int], bloom: bool) -> None:
    renderer.render(Scene().with_values({"post.bloom": bloom}), 0.0, size)
    assert renderer.read_rgb8().shape == (size[1], size[0], 3)
    assert np.isfinite(renderer.radiance()).all()


def test_bloom_off_compiles_no_bloom(ctx) -> None:
    """A scene never pays for what it does not show."""
    asked = []

    class Recorded(Programs):
        def get(self, path, *args, **kwargs) -> moderngl.VertexArray:
            asked.append(path)
            return super().get(path, *args, **kwargs)

    made = Renderer(ctx)
    made._post = PostPass(ctx, Recorded(ctx))
    made.render(Scene().with_values({"post.bloom": False}), 0.0, (8, 8))
    assert set(asked) == {"post/tone_table.frag", "post/tone_map.frag"}
    made.release()


class Glows:
    """Frames of one renderer in the order that a test asks for, small and with a strong glow."""

    def __init__(self, renderer):
        self._renderer, self._bloom, self.made = renderer, renderer._post._bloom, 0
        renderer._post._bloom = self._counted
        self.picture(0.0, may_last=False)

    def _counted(self, *given):
        self.made += 1
        return self._bloom(*given)

    def picture(self, time: float, *, may_last: bool, size=(96, 54), **values) -> np.ndarray:
        """`self.made` is then 1 if its glow is its own, else 0."""
        self.made = 0
        scene = Scene().with_values({"post.dither": False, **{key.replace("__", ".", 1): value for key, value in values.items()}})
        self._renderer.render(scene, time, size, glow_may_last=may_last)
        return self._renderer.read_rgb8().astype(int)


@pytest.fixture
def glows(renderer, monkeypatch):
    monkeypatch.setattr(renderer._post, "_bloom", renderer._post._bloom)  # put back afterwards
    return Glows(renderer)


@pytest.mark.parametrize(("step", "pattern"), [(0.13, [1, 0]), (0.1, [1, 0, 0]), (0.01, [1, 0, 0])], ids=["30 a second", "40 a second", "slow"])
def test_a_glow_lasts_for_a_frame_or_two_more_and_is_not_seen_to(glows, step, pattern) -> None:
    """At the rate of 4: three of 255 levels at most, where the disk's brightest streaks pass, and a fiftieth in the mean: a glow is weak, and wider than a
    streak."""
    made, running = [], []
    for frame in range(4 * len(pattern)):
        running.append(glows.picture(3.0 + step * frame, may_last=True))
        made.append(glows.made)
    assert made == 4 * pattern
    error = [np.abs(found - glows.picture(3.0 + step * frame, may_last=False)) for frame, found in enumerate(running)]
    assert all(not found.any() for found in error[:: len(pattern)])
    assert max(found.max() for found in error) <= 3 and max(found.mean() for found in error) < 0.02
    assert any(found.any() for found in error), "or nothing was spared"


@pytest.mark.parametrize(
    "change",
    [{"time": 3.0 + 2.0 * GLOW_LASTS}, {"size": (97, 54)}, {"camera__inclination_deg": 60.0}, {"post__bloom_spread": 0.2}, {"may_last": False}],
)
def test_no_other_picture_has_the_last_ones_glow(glows, change) -> None:
    glows.picture(3.0, may_last=True)
    found = glows.picture(**{"time": 3.01, "may_last": True, **change})
    assert glows.made == 1
    np.testing.assert_array_equal(found, glows.picture(**{"time": 3.01, **change, "may_last": False}))


def test_a_glow_does_not_outlast_a_picture_between(glows) -> None:
    glows.picture(3.0, may_last=True)
    glows.picture(3.01, may_last=False)
    glows.picture(3.02, may_last=True)
    assert glows.made == 1


def test_a_picture_can_stand_anywhere_in_its_target(ctx, renderer) -> None:
    """The window draws into the middle of a larger target: the same pixels, and nothing beside them."""
    renderer.render(Scene(), 0.0, (24, 16))
    alone = renderer.read_rgb8()[::-1]
    target = ctx.framebuffer([ctx.texture((40, 30), 4)])
    target.clear()
    renderer.render(Scene(), 0.0, (24, 16), target, (9, 7, 24, 16))
    whole = np.frombuffer(target.read(components=3), np.uint8).reshape(30, 40, 3)
    np.testing.assert_array_equal(whole[7:23, 9:33], alone)
    outside = whole.copy()
    outside[7:23, 9:33] = 0
    assert outside.max() == 0
