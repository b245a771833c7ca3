"""A flight round the hole, drawn with hit maps that are interpolated and with every pixel exact: what interpolation costs the picture."""

from __future__ import annotations

import math
from collections.abc import Iterator
from dataclasses import dataclass, fields, replace

import numpy as np

from blackhole_gl.rendering.frame import Renderer
from blackhole_gl.rendering.hit_texels import HitArrays
from blackhole_gl.scene import Scene
from studies.displacement import beside_an_edge, displacement_px
from studies.flip import flip

SECONDS = 10.0
FPS = 30

NEAREST = 1.6
"""r_s: where the flight turns."""

_WIDEST = 110.0  # degrees of view there: of less, the shadow leaves nothing
_FIRST_PHASE = 96.0  # degrees: above the disk, and frames of a flight of 30 fps lie right on the equator and on the pole


@dataclass(frozen=True)
class FlightFrame:
    """What one frame's refinement did.

    Attributes:
        time: seconds from the start.
        distance, inclination_deg, azimuth_deg, fov_deg: the camera.
        largest_px, px_99: displacement in pixels from the exact hits: the largest, and what 99 % of the pixels keep within.
        fates_off_edge: pixels of a wrong fate that lie further than one pixel from a true edge.
        fates_wrong: pixels of a wrong fate.
        flip_mean, flip_largest: of the picture against the exact one.
        own_rays: as in `Pair`.
    """

    time: float
    distance: float
    inclination_deg: float
    azimuth_deg: float
    fov_deg: float
    largest_px: float
    px_99: float
    fates_off_edge: int
    fates_wrong: int
    flip_mean: float
    flip_largest: float
    own_rays: float


COLUMNS = tuple(item.name for item in fields(FlightFrame))


def camera_at(scene: Scene, share: float) -> Scene:
    """`scene` with its camera where the flight is after `share` (0…1) of its way.

    Once in from the scene's distance to `NEAREST` and out, once round the axis; meanwhile four times through the equator, to 30° below it, and twice
    over the pole. Everything but the azimuth follows sines, so that nothing jerks.
    """
    near = math.sin(math.pi * share) ** 2
    far, view = scene.camera.distance, scene.camera.fov_deg
    camera = replace(
        scene.camera,
        distance=far ** (1.0 - near) * NEAREST**near,
        fov_deg=view ** (1.0 - near) * _WIDEST**near,
        inclination_deg=round(60.0 - 60.0 * math.cos(math.radians(720.0 * share + _FIRST_PHASE)), 9),  # in the plane is at 90, not a hair below
        azimuth_deg=360.0 * share,
    )
    return replace(scene, camera=camera)


def fly(renderer: Renderer, scene: Scene, size: tuple[int, int], count: int) -> Iterator[FlightFrame]:
    """`count` frames of the flight, evenly over its ten seconds, as they are measured.

    Args:
        scene: with a camera at a finite distance, whose rays the plan refines.
    """
    for index in range(count):
        yield measure(renderer, camera_at(scene, index / count), SECONDS * index / count, size)


@dataclass(frozen=True)
class Pair:
    """One frame in both ways.

    Attributes:
        refined, exact: the pictures, (height, width, 3) uint8, top row first.
        refined_hits, exact_hits: where their light comes from.
        own_rays: share of the refined one's pixels that had a ray of their own; the coarse grid has one more for every sixteen pixels.
    """

    refined: np.ndarray
    exact: np.ndarray
    refined_hits: HitArrays
    exact_hits: HitArrays
    own_rays: float


def drawn(renderer: Renderer, scene: Scene, time: float, size: tuple[int, int]) -> Pair:
    """`scene` at scene time `time`, refined and exact, with one ray in the pixels at edges and as exposed: a moving picture has fewer there, and is metered
    now and then.

    Raises:
        ValueError: its rays are not refined.
    """
    scene = scene.with_values({"rays.edges": 1, "post.exposure_mode": "fixed"})
    renderer.hit_map.forget()
    if renderer.render(scene, time, size, progressive=True).sharp:
        raise ValueError("every pixel has a ray of its own: there is no refinement to measure")
    refined, refined_hits, own_rays = renderer.read_rgb8(), renderer.hits(), float(renderer.hit_map.own_rays().mean())
    renderer.hit_map.forget()
    renderer.render(scene, time, size)
    return Pair(refined, renderer.read_rgb8(), refined_hits, renderer.hits(), own_rays)


def measure(renderer: Renderer, scene: Scene, seconds: float, size: tuple[int, int]) -> FlightFrame:
    """`scene` refined against `scene` exact, `seconds` after the start. Raises as `drawn`."""
    pair = drawn(renderer, scene, scene.playback.rate * seconds, size)
    camera = scene.camera
    moved = displacement_px(scene, pair.refined_hits, pair.exact_hits)
    wrong = pair.refined_hits.fate != pair.exact_hits.fate
    difference = flip(pair.exact, pair.refined)
    return FlightFrame(
        time=seconds,
        distance=camera.distance,
        inclination_deg=camera.inclination_deg,
        azimuth_deg=camera.azimuth_deg,
        fov_deg=camera.fov_deg,
        largest_px=float(moved.max()),
        px_99=float(np.quantile(moved, 0.99)),
        fates_off_edge=int(np.sum(wrong & ~beside_an_edge(pair.exact_hits.fate))),
        fates_wrong=int(np.sum(wrong)),
        flip_mean=float(difference.mean()),
        flip_largest=float(difference.max()),
        own_rays=pair.own_rays,
    )

