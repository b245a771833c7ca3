"""Cases that no ray method can touch: time, switches, sizes, tiles. Each draws pictures and judges them."""

from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import dataclass

import numpy as np

from blackhole_gl.physics.shear import RENEWAL_PERIOD
from blackhole_gl.rendering.frame import Renderer
from blackhole_gl.rendering.stills import TILE
from blackhole_gl.scene import Scene, fields, presets
from studies.stability import FAILS, FINE, Judgement

TEN_HOURS = 36_000.0
"""Seconds; times the playback rate it is scene time."""

SMALL = (96, 54)

SIZES = ((1, 1), (1, 999), (999, 1), (3, 5), (2, 2))
HUGE = (4096, 4096)
EIGHT_K = (7680, 4320)


@dataclass(frozen=True)
class ViewerCase:
    """One way in which a viewer goes wrong whatever its rays do.

    Attributes:
        run: (renderer, whether to draw the largest pictures too) → judgement, its error as `unit` says.
    """

    key: str
    title: str
    why: str
    unit: str
    run: Callable[[Renderer, bool], Judgement]


def _scene(**changes: object) -> Scene:
    return presets.load(["kerr", "blackholegpu_medium"], {key.replace("__", "."): value for key, value in changes.items()})


def _light(renderer: Renderer, scene: Scene, time: float, size: tuple[int, int] = SMALL) -> np.ndarray:
    """Radiance (height, width, 3) in float64, top row first."""
    renderer.render(scene, time, size)
    return renderer.radiance().astype(float)


def _judged(error: float, bound: float, note: str) -> Judgement:
    """Fine up to `bound`; an error that is no number fails."""
    return Judgement(FINE, "", error) if error <= bound else Judgement(FAILS, note, error)


def _frame_rate(renderer: Renderer, full: bool) -> Judgement:
    scene = _scene()
    renderer.render(scene, 7.3, SMALL)
    first = renderer.read_rgb8()
    for time in np.linspace(0.0, 7.0, 12):
        renderer.render(scene, float(time), SMALL)
    renderer.render(scene, 7.3, SMALL)
    return _judged(float(np.abs(renderer.read_rgb8().astype(int) - first).max()), 0.0, "grey levels of difference")


def _ten_hours(renderer: Renderer, full: bool) -> Judgement:
    scene = _scene(sky__enabled=False, camera__inclination_deg=40.0)
    late = TEN_HOURS * scene.playback.rate
    # A whole period of the renewing patterns, so that where in its life each one is does not count.
    phases = RENEWAL_PERIOD * (np.arange(8) + 0.5) / 8
    start, end = (np.mean([_look(renderer, scene, shift + time) for time in phases], axis=0) for shift in (0.0, late))
    return _judged(float(np.abs(end / start - 1.0).max()), 0.05, "change of light, contrast or motion")


def _look(renderer: Renderer, scene: Scene, time: float) -> np.ndarray:
    """(light, winding, motion): sum of the radiance, of its differences from pixel to pixel, and of those to a frame 0.05 r_s/c later."""
    now, soon = (_light(renderer, scene, time + dt).sum(axis=-1) for dt in (0.0, 0.05))
    return np.array([now.sum(), np.abs(np.diff(now, axis=1)).sum() + np.abs(np.diff(now, axis=0)).sum(), np.abs(soon - now).sum()])


def _seam(renderer: Renderer, full: bool) -> Judgement:
    scene = _scene(sky__enabled=False, camera__inclination_deg=10.0, camera__fov_deg=60.0, rays__orders=1, camera__azimuth_deg=37.0)
    light = _light(renderer, scene, 20.0, (192, 192)).sum(axis=-1)[::-1]  # rows as the hit map has them
    point = renderer.hits().crossing[..., 0, :].astype(float)
    radius = np.hypot(point[..., 0], point[..., 1])
    on_disk = (radius > 4.0) & (radius < 9.0)
    jumps = []
    for axis in (0, 1):
        step = np.abs(np.diff(light, axis=axis))
        first, second = (np.take(point, range(k, point.shape[axis] - 1 + k), axis=axis) for k in (0, 1))
        kept = np.take(on_disk, range(point.shape[axis] - 1), axis=axis) & np.take(on_disk, range(1, point.shape[axis]), axis=axis)
        across = (first[..., 1] * second[..., 1] <= 0.0) & (first[..., 0] < 0.0)
        jumps.append((step[kept & across], step[kept & ~across]))
    at_seam, elsewhere = (np.concatenate([pair[k] for pair in jumps]).mean() for k in (0, 1))
    return _judged(float(at_seam / elsewhere), 1.6, "times the usual difference between neighbours at φ = ±π")


def _stars(renderer: Renderer, full: bool) -> Judgement:
    scene = _scene(disk__enabled=False, camera__fov_deg=30.0, rays__lensing=False, camera__azimuth_deg=120.0)
    pixel = 30.0 / 108.0
    light = [_light(renderer, scene.with_values({"camera.azimuth_deg": 120.0 + share * pixel}), 0.0, (192, 108)).sum() for share in np.linspace(0.0, 1.0, 6)]
    return _judged(float(np.ptp(light) / np.mean(light)), 0.03, "of the stars' light flickers in a turn of one pixel")


def _doppler(renderer: Renderer, full: bool) -> Judgement:
    worst = math.inf
    for spin, orbit, side in ((0.0, "prograde", -1), (0.9, "prograde", -1), (0.9, "retrograde", 1), (-0.9, "prograde", 1)):
        scene = _scene(hole__spin=spin, disk__orbit=orbit, sky__enabled=False)
        light = _light(renderer, scene, 0.0).sum(axis=(0, 2))
        left, right = light[: SMALL[0] // 2].sum(), light[SMALL[0] // 2 :].sum()
        worst = min(worst, (left / right) ** -side)
    return Judgement(FINE if worst > 1.5 else FAILS, "" if worst > 1.5 else "the receding side is the bright one", float(worst))


def _switches(renderer: Renderer, full: bool) -> Judgement:
    scene = _scene()
    renderer.render(scene, 3.0, SMALL)
    before = renderer.read_rgb8()
    switches = [key for key, item in fields().items() if item.kind == "switch"]
    choices = [(key, option) for key, item in fields().items() if item.kind == "choice" and not key.startswith("rays.") for option in item.options]
    for key, value in [(key, not scene.get(key)) for key in switches] + choices:
        try:
            light = _light(renderer, scene.with_values({key: value}), 3.0)
        except ValueError as error:  # refused in a sentence that says so, as an observer in no orbit
            if key not in str(error):
                raise
            continue
        if not np.all(np.isfinite(light)) or np.any(renderer.hits().fate == 0):
            return Judgement(FAILS, f"{key} = {value}: rays unresolved or radiance not finite")
        renderer.render(scene, 3.0, SMALL)
        if np.any(renderer.read_rgb8() != before):
            return Judgement(FAILS, f"{key} and back is another picture")
    return Judgement(FINE, "", float(len(switches) + len(choices)))


def _sizes(renderer: Renderer, full: bool) -> Judgement:
    sizes = [*SIZES, *([HUGE] if full else [])]
    for size in sizes:
        light = _light(renderer, _scene(), 1.0, size)
        if light.shape != (size[1], size[0], 3) or not np.all(np.isfinite(light)) or np.any(renderer.hits().fate == 0):
            return Judgement(FAILS, f"{size[0]}×{size[1]}: rays unresolved or radiance not finite")
        if renderer.read_rgb8().shape != (size[1], size[0], 3):
            return Judgement(FAILS, f"{size[0]}×{size[1]}: another size came out")
    return Judgement(FINE, "", float(max(width * height for width, height in sizes)))


def _tiles(renderer: Renderer, full: bool) -> Judgement:
    scene, size = _scene(), (TILE + 61, 40)
    renderer.render_still(scene, 2.0, size)
    tiled = renderer.read_rgb8().astype(int)
    renderer.render(scene, 2.0, size)
    difference = np.abs(renderer.read_rgb8().astype(int) - tiled)
    if full:
        renderer.render_still(scene, 2.0, EIGHT_K)
        if renderer.read_rgb8().shape != (EIGHT_K[1], EIGHT_K[0], 3) or renderer.read_rgb8().max() == 0:
            return Judgement(FAILS, "8K is black or of another size")
    return _judged(float(difference.max()), 1.0, "grey levels between tiled and whole")


VIEWER_CASES: tuple[ViewerCase, ...] = (
    ViewerCase(
        "frame-rate",
        "The picture of a time does not depend on the frames before it",
        "State carried from frame to frame, or the clock read in a pass. The camera's path has a test of its own in tests/app.",
        "grey levels",
        _frame_rate,
    ),
    ViewerCase(
        "ten-hours",
        "Light, winding and motion after ten hours at the default rate",
        "Keplerian shear winds patterns up; float32 phases lose the motion.",
        "relative change",
        _ten_hours,
    ),
    ViewerCase("seam", "No seam in the disk at φ = ±π", "Noise or lanes in an angle that jumps.", "× the usual difference", _seam),
    ViewerCase("stars", "Stars keep their light while the camera turns by a pixel", "Stars smaller than a pixel blink.", "relative change", _stars),
    ViewerCase(
        "doppler-side",
        "The approaching side of the disk is the bright one, for either spin and orbit",
        "A sign of φ, of the orbit or of the ray's direction.",
        "× brighter",
        _doppler,
    ),
    ViewerCase(
        "switches",
        "Every switch and choice on, off and back while running",
        "A pass that the plan left out is read all the same; a target keeps what it held.",
        "values tried",
        _switches,
    ),
    ViewerCase(
        "sizes",
        "Pictures of 1×1, 1×999, 999×1, 3×5 and 4096×4096 pixels",
        "Mip chains that end at 0, rows that are not aligned to 4 bytes.",
        "pixels in the largest",
        _sizes,
    ),
    ViewerCase(
        "tiles",
        "A still in tiles is the same picture; 7680×4320 comes out whole",
        "Footprints and noise that know their tile and not the picture.",
        "grey levels",
        _tiles,
    ),
)
