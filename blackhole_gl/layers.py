"""Pictures for compositing and for research: linear radiance, and what the ray through each pixel's middle meets, as OpenEXR, FITS or a NumPy archive."""

from __future__ import annotations

import io
import math
from dataclasses import dataclass, fields
from pathlib import Path
from typing import Any

import numpy as np

from . import listed_rays
from .measure.visibilities import SkyPicture
from .output.carried import SCENE
from .output.files import write_whole
from .physics import angular_size, observer, projection
from .planning import plan
from .rendering import instances
from .rendering.frame import Renderer
from .scene import Scene, presets
from .shapes import Float, Int

SUFFIXES = (".exr", ".fits", ".npz")
_RAYS_AT_ONCE = 1 << 18
_CHANNELS = {"depth": "Z"}  # that OpenEXR has a name for


class LayersError(ValueError):
    """Layers that cannot be written; the text says what is missing or allowed."""


@dataclass(frozen=True)
class Layers:
    """Arrays of a picture, its top row first; of the disk's light the first crossing that the disk shows, NaN where it shows none.

    Attributes:
        radiance: linear, before exposure and tone map, float32 (height, width, 3).
        fate: of the ray, a `Fate`.
        order: of the crossing: 0 direct, 1 first ring, 2 second ring; −1 without.
        r, phi: of the crossing, in r_s and radians.
        g: E_infinity/E_emitter of the matter there.
        delay: of its light on the way to the camera, in r_s/c (`listed_rays.TracedRays.crossing_delay`); NaN also for ray models that do not tell.
        depth: how far off that is which is seen first, a thing or that crossing, in r_s: straight from the camera, or for one at infinity along its
            rays from the plane through the hole; NaN where neither is.
    """

    radiance: Float[np.ndarray, "height width 3"]
    fate: Int[np.ndarray, "height width"]
    order: Int[np.ndarray, "height width"]
    r: Float[np.ndarray, "height width"]
    phi: Float[np.ndarray, "height width"]
    g: Float[np.ndarray, "height width"]
    delay: Float[np.ndarray, "height width"]
    depth: Float[np.ndarray, "height width"]


def measured(renderer: Renderer, scene: Scene, time: float, size: tuple[int, int], samples: int = 1) -> Layers:
    """The layers of `scene` at scene time `time` (r_s/c); `samples` rays a pixel along each axis are averaged in the radiance alone.

    Raises:
        SceneError, ValueError: the scene cannot be drawn.
    """
    light = renderer.still_radiance(scene, time, size, samples)
    listed = listed_rays.pixel_rays(scene, size).reshape(-1, 2)
    found = [listed_rays.trace_by_shader(renderer, scene, listed[first : first + _RAYS_AT_ONCE]) for first in range(0, len(listed), _RAYS_AT_ONCE)]
    names = ("fate", "crossing_r", "crossing_phi", "crossing_g", "crossing_delay", "crossing_theta")
    fate, r, phi, g, delay, theta = (np.concatenate([getattr(part, name) for part in found]) for name in names)
    made = plan(scene)
    with np.errstate(invalid="ignore"):
        shows = (r >= made.disk_edge) & (r <= made.disk_outer) & scene.disk.enabled
    shows &= np.arange(r.shape[1]) < made.orders
    order = np.where(shows.any(axis=1), np.argmax(shows, axis=1), -1)
    taken = (np.take_along_axis(values, np.maximum(order, 0)[:, None], 1)[:, 0] for values in (r, phi, g, delay, theta))
    r, phi, g, delay, theta = (np.where(order < 0, np.nan, values) for values in taken)
    place = r[:, None] * np.stack([np.sin(theta) * np.cos(phi), np.sin(theta) * np.sin(phi), np.cos(theta)], axis=-1)
    depth = _depth(scene, _before_things(renderer, scene, listed, order, place))
    shape = size[1], size[0]
    whole, real = (fate, order), (r, phi, g, delay, depth)
    return Layers(light, *(values.astype(np.int32).reshape(shape) for values in whole), *(values.astype(np.float32).reshape(shape) for values in real))


def _before_things(
    renderer: Renderer, scene: Scene, rays: Float[np.ndarray, "N 2"], order: Int[np.ndarray, " N"], place: Float[np.ndarray, "N 3"]
) -> Float[np.ndarray, "N 3"]:
    """`place` of the crossing of that `order` on each ray, or where a thing is met that no such crossing hides."""
    if not scene.things:
        return place
    kinds = [number for number, kind in enumerate(instances.used(scene)) if kind.slot == "thing"]
    seen = place.copy()
    for first in range(0, len(rays), _RAYS_AT_ONCE):
        part = slice(first, first + _RAYS_AT_ONCE)
        hits = renderer.trace_listed(scene, listed_rays.local_vectors(rays[part], scene))[0]
        if hits.met is None or hits.met_place is None:
            continue
        for k in reversed(range(hits.met.shape[1])):  # the first on the ray last, as it hides the others
            met = np.isin(hits.met[:, k, 0], kinds) & ((order[part] < 0) | (hits.met[:, k, 2] <= order[part]))
            seen[part][met] = hits.met_place[met, k]
    return seen


def _depth(scene: Scene, place: Float[np.ndarray, "N 3"]) -> Float[np.ndarray, " N"]:
    """How far from the camera of `scene` a `place` in r_s is, (N,), as `Layers.depth` has it."""
    towards, distance = observer.observe(scene).n, scene.camera.distance
    return -place @ towards if math.isinf(distance) else np.linalg.norm(distance * towards - place, axis=-1)


def write(path: Path, layers: Layers, scene: Scene, time: float) -> None:
    """Writes `layers` to `path`, whole or not at all, by its suffix, one of `SUFFIXES`, with the scene inside.

    Raises:
        LayersError: the library that the format needs is not there.
        OSError: it cannot be written.
    """
    text = presets.picture_text(scene, time, path.absolute().parent)
    write_whole(path, {".exr": _exr, ".fits": _fits, ".npz": _npz}[path.suffix.lower()](layers, scene, text))


def write_sky(
    path: Path, picture: SkyPicture, scene: Scene, time: float, flux_jy: float = 1.0, frequency_hz: float = 230e9, place_deg: tuple[float, float] = (0.0, 0.0)
) -> None:
    """Writes `picture` in Jy a pixel as FITS that ehtim, DIFMAP and CASA read: north up, east to the left, about the right ascension and declination
    `place_deg`, with the scene inside.

    Raises:
        LayersError: there is no astropy; ValueError: a number out of range; OSError: it cannot be written.
    """
    for name, value, low, high in (("flux", flux_jy, 0.0, 1e6), ("frequency", frequency_hz, 1e6, 1e18), ("right ascension", place_deg[0], 0.0, 360.0)):
        _refuse_out_of_range(name, value, low, high)
    _refuse_out_of_range("declination", place_deg[1], -90.0, 90.0)
    fits = _library("astropy.io.fits", "astropy", "fits")
    made = fits.PrimaryHDU(flux_jy * picture.light[::-1])
    made.header.update(_at_middle(picture.light.shape, "SIN", math.degrees(picture.pixel), place_deg))
    made.header.update(
        OBJECT="BLACKHOLE", BUNIT="JY/PIXEL", STOKES="I", FREQ=frequency_hz, MJD=0.0, OBSRA=place_deg[0], OBSDEC=place_deg[1], RADESYS="ICRS"
    )
    write_whole(path, _packed([made, _scene_hdu(fits, presets.picture_text(scene, time, path.absolute().parent))], fits))


def _refuse_out_of_range(name: str, value: float, low: float, high: float) -> None:
    if not low <= value <= high:
        raise ValueError(f"{name}: got {value:g}; allowed is {low:g} to {high:g}")


def _exr(layers: Layers, scene: Scene, text: str) -> bytes:
    """Red, green, blue as compositors expect them, and a layer for each of the others; floats throughout, without loss."""
    openexr = _library("OpenEXR", "openexr", "exr")
    import tempfile  # the library writes to files alone

    channels: dict[str, Any] = {"RGB": np.ascontiguousarray(layers.radiance)}
    channels |= {_CHANNELS.get(name, f"{name}.V"): values.astype(np.float32) for name, values in _beside(layers).items()}
    header = {"compression": openexr.ZIP_COMPRESSION, "type": openexr.scanlineimage, SCENE: text}
    with tempfile.TemporaryDirectory() as folder:
        file = Path(folder) / "layers.exr"
        with openexr.File(header, channels) as made:
            made.write(str(file))
        return file.read_bytes()


def _fits(layers: Layers, scene: Scene, text: str) -> bytes:
    """Radiance as a cube of three planes and an image extension for each other layer, bottom row first as FITS has it; degrees on the sky where the scene
    stands for a real object or is seen through a beam, else M."""
    fits = _library("astropy.io.fits", "astropy", "fits")
    hdus = [fits.PrimaryHDU(np.moveaxis(layers.radiance[::-1], -1, 0).copy())]
    hdus += [fits.ImageHDU(values[::-1].copy(), name=name.upper()) for name, values in _beside(layers).items()]
    for hdu in hdus:
        hdu.header.update(_world(scene, layers.radiance.shape[0], layers.radiance.shape[1]))
    hdus[0].header["BUNIT"] = ("", "linear radiance, arbitrary units; planes are red, green, blue")
    return _packed([*hdus, _scene_hdu(fits, text)], fits)


def _scene_hdu(fits: Any, text: str) -> Any:
    return fits.ImageHDU(np.frombuffer(text.encode(), np.uint8), name="SCENE")  # UTF-8, which no card of a header may be


def _packed(hdus: list[Any], fits: Any) -> bytes:
    stream = io.BytesIO()
    fits.HDUList(hdus).writeto(stream)
    return stream.getvalue()


def _npz(layers: Layers, scene: Scene, text: str) -> bytes:
    stream = io.BytesIO()
    kept: dict[str, Any] = {"radiance": layers.radiance, **_beside(layers), "scene": np.array(text)}
    np.savez_compressed(stream, **kept)
    return stream.getvalue()


def _beside(layers: Layers) -> dict[str, np.ndarray]:
    """All but the radiance, by name."""
    return {item.name: getattr(layers, item.name) for item in fields(Layers) if item.name != "radiance"}


def _world(scene: Scene, height: int, width: int) -> dict[str, Any]:
    """Where pixels are about the picture's middle: on the sky where `scene` tells angles there, else in M; of no plane picture nothing."""
    if not projection.is_perspective(scene.camera):
        return {}
    if angular_size.is_told(scene):
        step = math.degrees(angular_size.picture_height_uas(scene.camera, scene.source) * angular_size.MICROARCSECOND) / height
        return _at_middle((height, width), "TAN", step, (0.0, 0.0))
    step = angular_size.picture_height_m(scene.camera) / height
    about = _at_middle((height, width), "TAN", step, (0.0, 0.0))
    return {**about, "CTYPE1": "ALPHA", "CTYPE2": "BETA", "CUNIT1": "", "CUNIT2": "", "CDELT1": step}


def _at_middle(shape: tuple[int, ...], plane: str, step: float, place_deg: tuple[float, float]) -> dict[str, Any]:
    """A header's coordinates on the sky, pixels of `step` degrees about `place_deg` in the middle: north up, and east to the left, as astronomers draw it."""
    height, width = shape
    return {
        "CRPIX1": 0.5 * (width + 1), "CRPIX2": 0.5 * (height + 1), "CRVAL1": place_deg[0], "CRVAL2": place_deg[1], "CDELT1": -step, "CDELT2": step,
        "CTYPE1": f"RA---{plane}", "CTYPE2": f"DEC--{plane}", "CUNIT1": "deg", "CUNIT2": "deg",
    }  # fmt: skip


def _library(module: str, package: str, extra: str) -> Any:
    import importlib

    try:
        return importlib.import_module(module)
    except ImportError:
        raise LayersError(f"a .{extra} file needs the package {package}: pip install 'blackhole-gl[{extra}]'; .npz needs none") from None
