"""A star's light is the same however coarse the picture is drawn: its stars are drawn as fine as it is shown."""

from __future__ import annotations

from collections.abc import Callable

import moderngl
import numpy as np
import pytest

from blackhole_gl.app.area import Area
from blackhole_gl.app.targets import Drawing, Targets
from blackhole_gl.rendering import star_cells
from blackhole_gl.rendering.frame import Renderer
from blackhole_gl.rendering.target import Target
from blackhole_gl.scene import Scene, presets

WIDTH, HEIGHT = AREA = 640, 360
PIXEL_DEG = 21.0 / HEIGHT  # the default view's pixel at 1280×720
BARE = {"camera.fov_deg": 21.0, "sky.procedural.galaxy_brightness": 0.0, "post.bloom": False, "post.dither": False}
"""No light but that of stars and disk, and no noise."""

Show = Callable[..., np.ndarray]


@pytest.fixture
def show(ctx: moderngl.Context, renderer: Renderer):
    """(scene, scale) → what the window shows of a picture drawn at that scale while the camera moves, linear light (height, width), row 0 at the bottom."""
    window = Target.of(ctx, [ctx.texture(AREA, 4, dtype="f4")])
    targets = Targets(ctx, renderer)

    def run(scene: Scene, scale: float, time: float = 3.0, *, pans: bool = False) -> np.ndarray:
        area = Area(0, 0, *AREA)
        targets.render_into(window.frame, area, Drawing(scene, time, area.scaled(scale), area.size, progressive=scale < 1.0 or pans, passes=False))
        code = np.frombuffer(window.texture.read(), np.float32).reshape(HEIGHT, WIDTH, 4)[..., :3].astype(float)
        return np.where(code <= 0.04045, code / 12.92, ((code + 0.055) / 1.055) ** 2.4).sum(axis=-1)

    yield run
    window.release()


def stars(light: np.ndarray, alone: int) -> list[tuple[slice, slice]]:
    """Windows of 13 × 13 pixels about the stars that have no other within `alone` pixels, the faintest first."""
    found = []
    for flat in np.argsort(light, axis=None)[::-1]:
        row, column = divmod(int(flat), WIDTH)
        if light[row, column] < 2e-3:
            break
        if not (alone <= row < HEIGHT - alone and alone <= column < WIDTH - alone):
            continue
        around = light[row - alone : row + alone + 1, column - alone : column + alone + 1].copy()
        middle = slice(alone - 3, alone + 4)
        is_peak = around[middle, middle].max() == light[row, column]
        around[middle, middle] = 0.0
        if is_peak and around.max() < 1e-3 * light[row, column]:
            found.append((slice(row - 6, row + 7), slice(column - 6, column + 7)))
    return sorted(found, key=lambda window: light[window].sum())


@pytest.mark.parametrize("curve", ["linear", "agx", "aces"])
@pytest.mark.parametrize("scale", [0.71, 0.5, 0.25])
def test_the_faintest_stars_shine_as_at_rest(show: Show, curve: str, scale: float) -> None:
    """By the linear curve it is the scene's light. 10 %; measured are 4 %: a coarser map, and at 0.71 rounded sides, by which stars leave their windows."""
    scene = presets.load(["kerr"], {**BARE, "disk.enabled": False, "camera.yaw_deg": 25.0, "post.tone_map": curve, "post.exposure": -1.0})
    rest, moving = show(scene, 1.0), show(scene, scale)
    seen = stars(rest, alone=8)
    faintest = seen[: len(seen) // 3]
    assert len(faintest) >= 20
    light = [(moving[window].sum(), rest[window].sum()) for window in faintest]
    moved, rested = np.sum(light, axis=0)
    assert moved == pytest.approx(rested, rel=0.1)
    if curve == "linear":
        assert all(a == pytest.approx(b, rel=0.1) for a, b in light), "none is lost for another"


@pytest.mark.parametrize("scale", [1.0, 0.71, 0.5])
def test_a_star_does_not_flicker_in_a_slow_pan(show: Show, scale: float) -> None:
    """Three pixels in frames of a tenth. 3 %: the kernel's own ripple on the pixel grid is 2 %. Measured is 1 %, but for a star half a haze."""
    values = {**BARE, "disk.enabled": False, "post.tone_map": "linear", "post.exposure": -3.0}
    scene = presets.load(["kerr"], {**values, "camera.yaw_deg": 25.0})
    panned = [show(scene.with_values({"camera.yaw_deg": 25.0 + 0.1 * (step - 15) * PIXEL_DEG}), scale, pans=True) for step in range(-1, 30)][1:]  # under way
    seen = stars(panned[15], alone=16)
    assert len(seen) >= 10
    for window in seen:
        light = np.array([picture[window].sum() for picture in panned])
        assert light.max() / light.mean() < 1.03 and light.min() / light.mean() > 0.97


def test_a_star_does_not_flicker_in_a_view_that_turns_slowly(show: Show) -> None:
    """Five pixels in frames of a tenth, while what is known of directions is coarse and when it becomes fine: 2 %, of each star's mean light. Measured is 1.4.
    Left out are the faintest, whose brightest pixel is a few levels of 8 bits: those change by 3."""
    scene = presets.load(["kerr"], {**BARE, "disk.enabled": False, "post.tone_map": "linear", "post.exposure": -3.0})
    turned = [show(scene.with_values({"camera.yaw_deg": 25.0 + 0.1 * (step - 25) * PIXEL_DEG}), 1.0, pans=True) for step in range(-1, 51)][1:]  # under way
    seen = stars(turned[25], alone=16)
    light = np.array([[picture[window].sum() for window in seen if turned[25][window].sum() > 0.03] for picture in turned])
    assert light.shape[1] >= 10 and (np.abs(light / light.mean(axis=0) - 1.0) < 0.02).all()


@pytest.mark.parametrize("scale, beside_deg", [(0.71, 0.02), (0.5, 0.02), (0.25, 0.02), (0.25, 0.1), (0.71, 0.3), (0.5, 0.3)])
def test_a_star_behind_the_hole_is_the_same_ring_or_arcs(show: Show, scale: float, beside_deg: float) -> None:
    """They were straight bars of 48 pixels at most, with a quarter to one and a third of the light, and half to four fifths of it in the wrong place.

    13 % of the light, and 35 % of it by blocks of 8 × 12 pixels: an image as long as the picture is high takes its slopes from a map of 160 × 90. Measured are
    12 and 31 % there, and 8 and 17 % at most with more pixels.
    """
    cells = star_cells.table().reshape(-1, 4)
    x, y, z = -cells[np.argmax(cells[:, 3]), :3].astype(float)
    camera = {"camera.azimuth_deg": np.degrees(np.arctan2(y, x)), "camera.inclination_deg": np.degrees(np.arccos(z)) + beside_deg, "camera.fov_deg": 48.0}
    scene = presets.load(["schwarzschild"], {**BARE, **camera, "disk.enabled": False, "post.tone_map": "linear", "post.exposure": -4.0})
    rest, moving = (show(scene, at).reshape(HEIGHT // 12, 12, -1, 8).sum(axis=(1, 3)) for at in (1.0, scale))
    assert moving.sum() == pytest.approx(rest.sum(), rel=0.13) and rest.max() > 1.0
    assert np.abs(moving - rest).sum() < 0.35 * rest.sum()


def test_the_disk_hides_the_stars_behind_it(show: Show) -> None:
    """A black disk: no more stars shine through or beside it in a coarse picture than at rest. 5 %: stars at its edge."""
    values = {"disk.emission_strength": 0.0, "disk.turbulence": False, "camera.inclination_deg": 30.0, "camera.fov_deg": 42.0}
    scene = presets.load(["kerr"], {**BARE, **values, "post.tone_map": "linear", "post.exposure": -1.0})

    def starlight(scene: Scene, scale: float) -> float:
        light = show(scene, scale)
        return light[light > 1e-3].sum()  # the haze is below what a coarse picture's 8 bits hold

    rest = starlight(scene, 1.0)
    assert starlight(scene, 0.5) == pytest.approx(rest, rel=0.05)
    assert rest < 0.8 * starlight(scene.with_values({"disk.enabled": False}), 1.0)


@pytest.mark.parametrize("scale", [0.71, 0.5, 0.25])
def test_measured_stars_that_are_drawn_apart_shine_as_at_rest(show: Show, scale: float) -> None:
    """Orion by the linear curve: those of the catalogue's stars that stand out and do not clip. To 3 % in the median, four fifths
    of them to 10 %: fainter ones beside them are haze in motion, and of close groups the two brightest are drawn."""
    orion = {"sky.model": "catalogue", "sky.catalogue.galaxy_brightness": 0.0, "sky.catalogue.yaw_deg": 96.0}
    view = {**BARE, "disk.enabled": False, "rays.lensing": False, "camera.inclination_deg": 90.0, "camera.yaw_deg": 8.0, "post.tone_map": "linear"}
    scene = presets.load(["kerr"], {**view, **orion, "post.exposure": -1.5})
    rest, moving = show(scene, 1.0), show(scene, scale)
    bright = [(row, column) for row, column in np.argwhere(rest > 0.3) if 9 <= row < HEIGHT - 9 and 9 <= column < WIDTH - 9]
    windows = [(slice(row - 4, row + 5), slice(column - 4, column + 5)) for row, column in bright]
    peaks = [window for window in windows if rest[window].max() == rest[window][4, 4] < 2.8]
    light = np.array([moving[window].sum() / rest[window].sum() for window in peaks])
    assert len(peaks) >= 40 and abs(np.median(light) - 1.0) < 0.03
    assert np.mean(np.abs(light - 1.0) < 0.1) > 0.8
