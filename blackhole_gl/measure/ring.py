"""What astronomers read off the picture of a ring: diameter, width, asymmetry, and how its polarization turns.

By the definitions of the Event Horizon Telescope Collaboration, "First M87 Event Horizon Telescope Results. IV", ApJL 875 L4 (2019), section 9.1. Along each
ray from a centre the ring is where the light is brightest; the centre is that from which these radii spread least over their mean. Diameter: twice that mean.
Width: the mean full width at half maximum along those rays, above the mean light far out. Asymmetry and orientation: the first Fourier component of the light
round the centre over its mean, for each radius within the width, averaged. β₂ of the polarization is that of `polarization_maps`, about the same centre, of the
smooth disk's light alone.
"""

from __future__ import annotations

import cmath
import math
from dataclasses import dataclass
from functools import lru_cache

import numpy as np

from ..physics.angular_size import m_uas, picture_height_m
from ..planning import plan as make_plan
from ..rendering.beam import sigma_px
from ..rendering.frame import Renderer
from ..rendering.metering import LUMINANCE
from ..rendering.polarized_disk import why_not
from ..scene import Scene, SceneError
from ..shapes import Float
from . import polarization_maps

FLOOR_RADIUS = 2.4
"""Where light counts as none of the ring's, in radii of the ring: the 50 µas that were taken for M87*, whose ring is 42 µas across."""

_ANGLES = np.linspace(0.0, 2.0 * np.pi, 180, endpoint=False)
_RADIAL_STEP = 0.5  # pixels
_FIRST_STEP = 0.1  # of the search for the centre, in heights of the picture
_LAST_STEP = 0.01  # pixels
_POLARIZED_ROWS = 240  # of the maps that beta_2 is a mean over


@dataclass(frozen=True)
class Ring:
    """A ring in a picture; lengths in pixels.

    Attributes:
        centre: (right, down) of the middle of the first pixel.
        diameter, width: as above.
        spread: standard deviation of the ring's radius over its mean.
        asymmetry: 0 where it is equally bright all round, at most 1.
        orientation_deg: where it is brightest, from up to the left: east of north where north is up.
    """

    centre: tuple[float, float]
    diameter: float
    width: float
    spread: float
    asymmetry: float
    orientation_deg: float


@dataclass(frozen=True)
class Measured:
    """The ring of a scene.

    Attributes:
        sharp: of its light as it comes; None where there is no ring.
        blurred: of the same through the scene's beam, whether the picture is shown so or not.
        pixel_m, pixel_uas: sides of a pixel in M and in µas.
        sharp_beta_2, blurred_beta_2: of the polarization; None where there is no ring, or the polarization is not known.
    """

    sharp: Ring | None
    blurred: Ring | None
    pixel_m: float
    pixel_uas: float
    sharp_beta_2: complex | None = None
    blurred_beta_2: complex | None = None


def refuse(scene: Scene) -> None:
    """Says so where `scene` has no brightness to measure.

    Raises:
        SceneError: it asks for a view.
    """
    if scene.post.view != "picture":
        raise SceneError("post.view", f"got {scene.post.view!r}; allowed is 'picture' here, as a view's colours are no brightness")


def measure(renderer: Renderer, scene: Scene, time: float, size: tuple[int, int]) -> Measured:
    """The ring in the picture of `scene` at scene time `time`, `size` pixels large.

    Raises:
        As `refuse` and `Renderer.render`.
    """
    refuse(scene)
    renderer.render(scene, time, size)
    light = renderer.radiance().astype(float) @ LUMINANCE
    pixel_m = picture_height_m(scene.camera) / size[1]
    sharp, smooth = ring_of(light), ring_of(blurred(light, sigma_px(scene, size[1])))
    return Measured(sharp, smooth, pixel_m, pixel_m * m_uas(scene.source), *_betas(scene, size, sharp, smooth))


def _betas(scene: Scene, size: tuple[int, int], sharp: Ring | None, smooth: Ring | None) -> tuple[complex | None, complex | None]:
    """β₂ about the rings of a picture of `size`, without and with the beam."""
    if why_not(make_plan(scene)):
        return None, None
    share = min(1.0, _POLARIZED_ROWS / size[1])
    small = max(round(share * size[0]), 1), max(round(share * size[1]), 1)
    try:
        maps = polarization_maps.measure(scene, small)
    except SceneError:  # no light of the disk: what there is in the picture is something else's
        return None, None
    through = maps.through(lambda part: blurred(part, sigma_px(scene, small[1])))

    def of(found: polarization_maps.PolarizationMaps, ring: Ring | None) -> complex | None:
        if ring is None:
            return None
        return found.beta_2_about(((ring.centre[0] + 0.5) * small[0] / size[0], (ring.centre[1] + 0.5) * small[1] / size[1]))

    return of(maps, sharp), of(through, smooth)


def blurred(light: Float[np.ndarray, "h w"], sigma: float) -> Float[np.ndarray, "h w"]:
    """`light` through a round Gaussian of so many pixels; beyond the edge its outermost light goes on."""
    height, width = light.shape
    return _gaussian(height, sigma) @ light @ _gaussian(width, sigma).T


def ring_of(light: Float[np.ndarray, "h w"]) -> Ring | None:
    """The ring in a picture of brightness, its first row on top; None where it is as dark everywhere as at its brightest, or the ring reaches its edge."""
    if not light.max() > light.min():
        return None
    centre = _centre(light)
    if not _holds_brightest(light, centre):
        return None
    peaks = _peaks(light, centre)
    radius = float(peaks.mean())
    farthest = _farthest(light, centre)
    if radius < 1.0 or peaks.max() > farthest - 2.0 * _RADIAL_STEP:
        return None
    radii, profiles = _polar(light, centre, farthest)
    floor = float(_sampled(light, centre, np.array([min(FLOOR_RADIUS * radius, farthest)])).mean())
    width = float(np.mean([_full_width(radii, profile - floor) for profile in profiles]))
    within = (radii >= radius - 0.5 * width) & (radii <= radius + 0.5 * width)
    around = profiles[:, within]
    moments = (around * np.exp(1j * _ANGLES)[:, None]).sum(axis=0) / around.sum(axis=0)
    towards = math.degrees(np.angle(moments.mean())) - 90.0
    return Ring(centre, 2.0 * radius, width, float(peaks.std()) / radius, float(np.abs(moments).mean()), towards % 360.0)


def text(found: Measured, scene: Scene) -> str:
    """Lines for people, without and with the beam."""
    lines = [f"1 M = {m_uas(scene.source):.4g} µas ({scene.source.mass_suns:.4g} suns at {scene.source.distance_pc:.4g} pc); 1 px = {found.pixel_m:.4g} M"]
    kinds = ("as it comes", found.sharp, found.sharp_beta_2), (f"through a beam of {scene.post.beam_uas:g} µas", found.blurred, found.blurred_beta_2)
    for title, ring, beta in kinds:
        lines.append(f"{title}:")
        if ring is None:
            lines.append("  no ring within the picture")
            continue
        for name, pixels in (("diameter", ring.diameter), ("width", ring.width)):
            lines.append(f"  {name:12}{pixels:9.2f} px {pixels * found.pixel_m:9.3f} M {pixels * found.pixel_uas:9.2f} µas")
        lines.append(f"  {'spread':12}{ring.spread:9.4f}    of the radius, over its mean")
        lines.append(f"  {'asymmetry':12}{ring.asymmetry:9.4f}    brightest at {ring.orientation_deg:.0f}° from up to the left")
        if beta is not None:
            lines.append(f"  {'β₂':12}{abs(beta):9.4f}    phase {math.degrees(cmath.phase(beta)):.0f}°, 0° for polarization outwards, 180° for round")
    return "\n".join(lines) + "\n"


@lru_cache(maxsize=4)
def _gaussian(size: int, sigma: float) -> Float[np.ndarray, "n n"]:
    """What blurs a line of `size` pixels."""
    reach = math.ceil(6.0 * sigma)
    offsets = np.arange(-reach, reach + 1)
    weights = np.exp(-0.5 * (offsets / sigma) ** 2)
    matrix = np.zeros((size, size))
    here = np.arange(size)
    for offset, weight in zip(offsets, weights / weights.sum()):
        matrix[here, np.clip(here + offset, 0, size - 1)] += weight
    return matrix


def _centre(light: Float[np.ndarray, "h w"]) -> tuple[float, float]:
    """From where the ring's radius spreads least over its mean: a walk from the picture's middle, of ever shorter steps."""
    x, y = 0.5 * (light.shape[1] - 1), 0.5 * (light.shape[0] - 1)
    best, step = _spread(light, (x, y)), _FIRST_STEP * light.shape[0]
    while step > _LAST_STEP:
        beside = [(x + i * step, y + j * step) for i in (-1, 0, 1) for j in (-1, 0, 1) if (i, j) != (0, 0)]
        spreads = [_spread(light, place) for place in beside]
        least = int(np.argmin(spreads))
        if spreads[least] < best:
            best, (x, y) = spreads[least], beside[least]
        else:
            step *= 0.5
    return x, y


def _spread(light: Float[np.ndarray, "h w"], centre: tuple[float, float]) -> float:
    """Spread of the ring's radius over its mean; infinite where rays of one length leave the brightest pixel out, or radii are nothing."""
    if not _holds_brightest(light, centre):
        return math.inf
    peaks = _peaks(light, centre)
    mean = float(peaks.mean())
    return float(peaks.std()) / mean if mean > 1.0 else math.inf


def _holds_brightest(light: Float[np.ndarray, "h w"], centre: tuple[float, float]) -> bool:
    """Whether the brightest pixel lies on a circle about `centre` that the picture holds."""
    down, right = np.unravel_index(int(light.argmax()), light.shape)
    return math.hypot(float(right) - centre[0], float(down) - centre[1]) < _farthest(light, centre) - 2.0 * _RADIAL_STEP


def _peaks(light: Float[np.ndarray, "h w"], centre: tuple[float, float]) -> Float[np.ndarray, " a"]:
    """Radius of the brightest place along each ray, by a parabola through three samples."""
    radii, profiles = _polar(light, centre, _farthest(light, centre))
    most = np.clip(profiles.argmax(axis=1), 1, len(radii) - 2)
    before, at, after = (profiles[np.arange(len(_ANGLES)), most + k] for k in (-1, 0, 1))
    bend = before - 2.0 * at + after
    shift = np.where(bend < 0.0, 0.5 * (before - after) / np.where(bend < 0.0, bend, 1.0), 0.0)
    return radii[most] + _RADIAL_STEP * np.clip(shift, -1.0, 1.0)


def _polar(light: Float[np.ndarray, "h w"], centre: tuple[float, float], farthest: float) -> tuple[Float[np.ndarray, " r"], Float[np.ndarray, "a r"]]:
    radii = np.arange(0.0, farthest, _RADIAL_STEP)
    return radii, _sampled(light, centre, radii)


def _farthest(light: Float[np.ndarray, "h w"], centre: tuple[float, float]) -> float:
    """The largest radius about `centre` that the picture holds all round."""
    height, width = light.shape
    return min(centre[0], centre[1], width - 1.0 - centre[0], height - 1.0 - centre[1])


def _sampled(light: Float[np.ndarray, "h w"], centre: tuple[float, float], radii: Float[np.ndarray, " r"]) -> Float[np.ndarray, "a r"]:
    """`light` at `_ANGLES`, from right to up, and `radii`, read linearly between pixels."""
    x = centre[0] + np.outer(np.cos(_ANGLES), radii)
    y = centre[1] - np.outer(np.sin(_ANGLES), radii)
    left, top = np.clip(x.astype(int), 0, light.shape[1] - 2), np.clip(y.astype(int), 0, light.shape[0] - 2)
    u, v = x - left, y - top
    upper = light[top, left] * (1.0 - u) + light[top, left + 1] * u
    lower = light[top + 1, left] * (1.0 - u) + light[top + 1, left + 1] * u
    return upper * (1.0 - v) + lower * v


def _full_width(radii: Float[np.ndarray, " r"], profile: Float[np.ndarray, " r"]) -> float:
    """Full width at half maximum of the peak of `profile`; where it is not dark enough within, from the centre on."""
    most = int(profile.argmax())
    half = 0.5 * profile[most]
    inside, outside = np.flatnonzero(profile[:most] < half), np.flatnonzero(profile[most:] < half)
    inner = _crossing(radii, profile, int(inside[-1]), half) if inside.size else 0.0
    outer = _crossing(radii, profile, most + int(outside[0]) - 1, half) if outside.size else float(radii[-1])
    return outer - inner


def _crossing(radii: Float[np.ndarray, " r"], profile: Float[np.ndarray, " r"], before: int, level: float) -> float:
    """Where `profile` passes `level` between the samples `before` and the next."""
    low, high = profile[before], profile[before + 1]
    return float(radii[before] + (level - low) / (high - low) * (radii[before + 1] - radii[before]))
