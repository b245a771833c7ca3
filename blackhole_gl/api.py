"""What ``import blackhole_gl as bh`` offers: scenes in, arrays out. It needs no display, and none of it needs a word of OpenGL.

Every function may be called from any thread, and from processes however they were started; what several ask for at once is done one after the other. Sizes are
(width, height) in pixels, each 1 to 32768; arrays of pictures have their top row first. Numbers may be NumPy's.
"""

from __future__ import annotations

import math
import operator
import os
import subprocess
import sys
import tempfile
from collections.abc import Mapping, Sequence
from concurrent.futures import ThreadPoolExecutor
from dataclasses import dataclass, fields
from pathlib import Path
from typing import Any, SupportsIndex

import numpy as np
from numpy.typing import ArrayLike

from . import layers, listed_rays
from .gl_thread import GlThread
from .glsl.declared import Fate
from .measure import light_curve
from .measure import visibilities as interferometry
from .measure.light_curve import LightCurve
from .measure.visibilities import Visibilities
from .output import png
from .physics.screen_curves import ScreenCurve, critical_curve, isoradials
from .planning import Plan
from .planning import plan as make_plan
from .rendering import context, still_files
from .rendering.annotation import annotated
from .rendering.frame import Renderer as _Renderer
from .scene import Scene, SceneError
from .scene import presets as preset_files
from .scene.lengths import UNITS
from .scene.presets import PresetInfo
from .shapes import Float, Int

_MOST_SIDE = 32768
_RAYS_AT_ONCE = 1 << 18  # that are listed: 80 bytes of textures each
_IN_NOTEBOOKS = (640, 360)


@dataclass(frozen=True)
class Rays:
    """What became of rays, arrays of the shape (…) that they were given in.

    Attributes:
        fate: int (…): a `Fate`: 0 unresolved, 1 escaped, 2 captured, 3 met something opaque.
        direction: (…, 3): the asymptotic unit vector in the world of an escaped ray; NaN of the others.
        crossing: (…, 3, 2): r in r_s and φ in radians of the first three crossings of the disk's plane, whether there is a disk or not; NaN without.
        g: (…, 3): E_infinity/E_emitter of matter on a circular orbit there, or falling in where the scene has it so; NaN without.
        intensity: (…, 3): bolometric, that the camera receives from the smooth disk there, over what its hottest matter sends out: (E_camera/E_emitter)^p
            (T/T_peak)^4; 0 beside the disk, NaN without a crossing.
        lam: (…): L_z/E in M of the photon that arrives; NaN where there is none.
        steps: int (…): steps that the ray took.
        delay: (…, 3): how long light is under way from each crossing to the camera, in r_s/c of who is far away; to a camera at infinity, less r + ln r of it
            in r_s. NaN without a crossing, and from ray models that do not tell: `kerr` and `schwarzschild_binet` do.
    """

    fate: Int[np.ndarray, "*rays"]
    direction: Float[np.ndarray, "*rays 3"]
    crossing: Float[np.ndarray, "*rays 3 2"]
    g: Float[np.ndarray, "*rays 3"]
    intensity: Float[np.ndarray, "*rays 3"]
    lam: Float[np.ndarray, "*rays"]
    steps: Int[np.ndarray, "*rays"]
    delay: Float[np.ndarray, "*rays 3"]


class Renderer:
    """Draws scenes by a GL context of its own; any number of them may be used in turn or side by side.

    The functions of this module use one that they share, which is enough for most: others are for other GPUs. Each is closed when it is no longer used, or
    by `close`, or as a context manager.

    Args:
        gpu: which of `gpus`, by number or by a part of its name in any case; the driver's first when None.
        backend: how to draw without a display: ``egl``, ``osmesa`` or ``auto``, the first of them that works.

    Raises:
        ValueError: there is no such GPU, or no such backend.
    """

    def __init__(self, gpu: SupportsIndex | str | None = None, *, backend: str = "auto"):
        if backend not in (*context.BACKENDS, "auto"):
            raise ValueError(f"backend: got {backend!r}; allowed is one of auto, {', '.join(context.BACKENDS)}")
        self._thread = GlThread(None if gpu is None else _device(gpu), backend)

    def render(self, scene: Scene, size: Sequence[SupportsIndex] = (1280, 720), time: float = 0.0, samples: SupportsIndex | None = None) -> np.ndarray:
        """As the function `render`."""
        return self._thread.call(_rendered, *_asked(scene, size, time, samples))

    def radiance(self, scene: Scene, size: Sequence[SupportsIndex] = (1280, 720), time: float = 0.0, samples: SupportsIndex | None = None) -> np.ndarray:
        """As the function `radiance`."""
        return self._thread.call(_Renderer.still_radiance, *_asked(scene, size, time, samples))

    def trace(
        self,
        scene: Scene,
        psi: ArrayLike | None = None,
        chi: ArrayLike | None = None,
        *,
        alpha: ArrayLike | None = None,
        beta: ArrayLike | None = None,
    ) -> Rays:
        """As the function `trace`."""
        first, second = _coordinates(scene, psi, chi, alpha, beta)
        return self._traced(scene, np.stack([first, second], axis=-1))

    def hits(self, scene: Scene, size: Sequence[SupportsIndex] = (1280, 720)) -> Rays:
        """As the function `hits`."""
        return self._traced(scene, listed_rays.pixel_rays(scene, _size(size)))

    def lightcurve(self, scene: Scene, times: ArrayLike | None = None, size: Sequence[SupportsIndex] = (320, 180)) -> LightCurve:
        """As the function `lightcurve`."""
        when = light_curve.times(scene, 96) if times is None else np.atleast_1d(np.asarray(times, float))
        if when.ndim != 1 or not np.isfinite(when).all():
            raise ValueError("times: allowed is a list of finite numbers, in r_s/c")
        return self._thread.call(light_curve.measure, scene, when, _size(size))

    def close(self) -> None:
        """Gives back all that it holds; it cannot be used any more."""
        self._thread.close()

    def __enter__(self) -> Renderer:
        return self

    def __exit__(self, *_: object) -> None:
        self.close()

    def _traced(self, scene: Scene, rays: Float[np.ndarray, "*rays 2"]) -> Rays:
        listed = rays.reshape(-1, 2)
        parts = [listed[start : start + _RAYS_AT_ONCE] for start in range(0, max(len(listed), 1), _RAYS_AT_ONCE)]
        found = [_as_rays(scene, self._thread.call(listed_rays.trace_by_shader, scene, part)) for part in parts]
        whole = {item.name: np.concatenate([getattr(part, item.name) for part in found]) for item in fields(Rays)}
        return Rays(**{name: values.reshape((*rays.shape[:-1], *values.shape[1:])) for name, values in whole.items()})


def load(presets: str | Path | Sequence[str | Path] = ("kerr",), values: Mapping[str, Any] | None = None, *, any_file: bool = False) -> Scene:
    """A scene from presets, each over the one before it, and single values over all: ``load("kerr", {"hole.spin": 0.5})``.

    Args:
        presets: names (see `presets`), ``.toml`` files, or pictures made by this program.
        values: dotted key → value; `Scene.fields` lists the keys, their ranges and units. A thing is made by its kind: ``{"things.moon.kind": "sphere"}``.
        any_file: let presets and pictures open files outside their own folders, too.

    Raises:
        SceneError: no such preset or key, or a value that is not allowed; the text says what is.
    """
    return preset_files.load([presets] if isinstance(presets, (str, Path)) else list(presets), dict(values or {}), any_file=any_file, source="")


def presets() -> list[PresetInfo]:
    """The presets that there are: name, title, description, group and path of each."""
    return preset_files.available()


def render(scene: Scene, size: Sequence[SupportsIndex] = (1280, 720), time: float = 0.0, samples: SupportsIndex | None = None) -> np.ndarray:
    """The picture of `scene`, uint8 (height, width, 3), sRGB: bit for bit what ``blackhole-gl render`` writes.

    Args:
        time: scene time in r_s/c.
        samples: rays a pixel along each axis, 1 to 16; as the scene's quality has it when None.

    Raises:
        SceneError, ValueError: the scene cannot be drawn, or an argument is out of range; the text says what is allowed.
        ContextError: there is no OpenGL here; the text says what to install.
    """
    return _shared.render(scene, size, time, samples)


def radiance(scene: Scene, size: Sequence[SupportsIndex] = (1280, 720), time: float = 0.0, samples: SupportsIndex | None = None) -> np.ndarray:
    """Linear scene-referred radiance of the same, float32 (height, width, 3), before exposure, bloom and tone map. Arguments and errors as in `render`."""
    return _shared.radiance(scene, size, time, samples)


def trace(
    scene: Scene, psi: ArrayLike | None = None, chi: ArrayLike | None = None, *, alpha: ArrayLike | None = None, beta: ArrayLike | None = None
) -> Rays:
    """Traces listed rays by the shader that pictures use, wherever the camera looks. Arrays of any shapes that broadcast.

    Args:
        psi: 0 to π, the angle from the direction to the hole's centre.
        chi: angle on the screen from right (+e_φ) towards up, in radians; 0 when None.
        alpha, beta: screen coordinates in M, right and up, instead, for a camera at infinity.

    Raises:
        ValueError: other arguments than this camera takes, out of range or not finite.
        SceneError, ContextError: as in `render`.
    """
    return _shared.trace(scene, psi, chi, alpha=alpha, beta=beta)


def hits(scene: Scene, size: Sequence[SupportsIndex] = (1280, 720)) -> Rays:
    """What the ray through the middle of each pixel of a picture meets, in arrays (height, width, …). Arguments and errors as in `render`."""
    return _shared.hits(scene, size)


def lightcurve(scene: Scene, times: ArrayLike | None = None, size: Sequence[SupportsIndex] = (320, 180)) -> LightCurve:
    """The light of the whole picture, without the sky, at scene times in r_s/c: those of one turn of the hot spot, or of what else moves, when None.

    With ``rays.light_travel`` each part of the picture is as late as its light arrives.

    Raises:
        ValueError, SceneError, ContextError: as in `render`; times that are not finite; a view, whose colours are no light.
    """
    return _shared.lightcurve(scene, times, size)


def plan(scene: Scene) -> Plan:
    """How the rays of `scene` are traced, and why: method, steps, reasons and warnings.

    Raises:
        SceneError: its ray model, integrator and step control do not fit together.
    """
    return make_plan(scene)


def visibilities(
    scene: Scene, u: ArrayLike, v: ArrayLike, size: Sequence[SupportsIndex] = (400, 400), time: float = 0.0, samples: SupportsIndex | None = None
) -> Visibilities:
    """What an interferometer measures of the scene's picture, at the mass and distance that it states (``source.mass_suns``, ``source.distance_pc``): shares of
    all of its light. Up is north, left is east; the spin axis has the position angle ``camera.roll_deg``.

    Args:
        u, v: baselines towards east and north in wavelengths, arrays that broadcast; (…, 3) for `Visibilities.closure_phases`.

    Raises:
        SceneError: nothing shines; as in `render`. ValueError: a baseline is not finite.
    """
    return interferometry.of(_sky_picture(scene, size, time, samples), u, v)


def save_sky(
    path: str | Path,
    scene: Scene,
    size: Sequence[SupportsIndex] = (400, 400),
    time: float = 0.0,
    samples: SupportsIndex | None = None,
    *,
    flux_jy: float = 1.0,
    frequency_hz: float = 230e9,
    place_deg: tuple[float, float] = (0.0, 0.0),
) -> Path:
    """Writes the scene's picture in Jy a pixel as FITS that ehtim and other programs for interferometers read, and returns the path.

    Args:
        flux_jy: of the whole picture.
        place_deg: right ascension and declination of its middle.

    Raises:
        ValueError: a number is out of range, or there is no astropy; as in `visibilities`.
        OSError: it cannot be written.
    """
    layers.write_sky(Path(path), _sky_picture(scene, size, time, samples), scene, float(time), flux_jy, frequency_hz, place_deg)
    return Path(path)


def save(
    path: str | Path,
    scene: Scene,
    size: Sequence[SupportsIndex] = (1280, 720),
    time: float = 0.0,
    samples: SupportsIndex | None = None,
    *,
    lengths: str = "r_s",
    linear: bool = False,
) -> Path:
    """Writes `scene` to `path`, by its suffix, and returns the path: ``.png`` the picture, ``.toml`` a preset, both of which `load` and the viewer open again;
    ``.exr``, ``.fits`` and ``.npz`` linear radiance with layers of what each pixel's ray meets: fate, order, r, φ, g, delay.

    Args:
        lengths: unit of all lengths in a preset, ``r_s`` or ``M``; `load` reads both.
        linear: a ``.png`` of linear radiance, 16 bits a channel, of which 65535 stands for a radiance of 8.

    Raises:
        ValueError: another suffix or unit, or one whose library is not there; as in `render`.
        OSError: it cannot be written.
    """
    path = Path(path)
    suffix = path.suffix.lower()
    if suffix == ".toml":
        if lengths not in UNITS:
            raise ValueError(f"lengths: got {lengths!r}; allowed is one of {', '.join(UNITS)}")
        return preset_files.save(scene, path, time=time or None, unit=lengths)
    if suffix in layers.SUFFIXES:
        layers.write(path, _shared._thread.call(layers.measured, *_asked(scene, size, time, samples)), scene, float(time))
    elif suffix == ".png":
        _shared._thread.call(still_files.save, path, *_asked(scene, size, time, samples), linear=linear)
    else:
        raise ValueError(f"{path}: got the suffix {path.suffix!r}; allowed is .png, .toml, {', '.join(layers.SUFFIXES)}")
    return path


def show(scene: Scene, *, wait: bool = True) -> subprocess.Popen:
    """Opens the viewer on `scene`, in a process of its own.

    Args:
        wait: return when it is closed.

    Returns:
        That process.
    """
    kept = tempfile.mkdtemp(prefix="blackhole-gl-")
    path = preset_files.save(scene, Path(kept) / "scene.toml", title="From Python")
    # The folder of the scene goes with the viewer, which reads it once.
    program = f"import shutil, sys; sys.path[:] = {sys.path!r}; sys.argv[1:] = ['view', '--any-file', {str(path)!r}]\n" + (
        f"from blackhole_gl.cli import main\ntry:\n    main()\nfinally:\n    shutil.rmtree({kept!r}, ignore_errors=True)"
    )
    viewer = subprocess.Popen([sys.executable, "-c", program])
    if wait:
        viewer.wait()
    return viewer


def gpus() -> tuple[str, ...]:
    """What this machine can draw on without a display: a name for each, in the order of their numbers.

    Raises:
        ContextError: there is none, or this process was forked from one that has drawn.
    """
    with ThreadPoolExecutor(1) as aside:  # contexts are made, which must not become current here
        return aside.submit(context.device_names).result()


def _device(gpu: SupportsIndex | str) -> int:
    """The number of the GPU called for.

    Raises:
        ValueError: there is none such.
    """
    names = gpus()
    if isinstance(gpu, str):
        found = [number for number, name in enumerate(names) if gpu.lower() in name.lower()]
    else:
        found = [operator.index(gpu)] if 0 <= operator.index(gpu) < len(names) else []
    if not found:
        listed = "; ".join(f"{number}: {name}" for number, name in enumerate(names))
        raise ValueError(f"gpu: got {gpu!r}; allowed is a number or a part of a name among {listed}")
    return found[0]


def _size(size: Sequence[SupportsIndex]) -> tuple[int, int]:
    try:
        width, height = (operator.index(side) for side in size)
    except (TypeError, ValueError):
        width = height = 0
    if not (1 <= width <= _MOST_SIDE and 1 <= height <= _MOST_SIDE):
        raise ValueError(f"size: got {size!r}; allowed is (width, height), whole numbers from 1 to {_MOST_SIDE}")
    return width, height


def _asked(scene: Scene, size: Sequence[SupportsIndex], time: float, samples: SupportsIndex | None) -> tuple[Scene, float, tuple[int, int], int]:
    """What a picture is made of, checked, in the order that `still_radiance` takes it."""
    rays = scene.rays.in_stills if samples is None else operator.index(samples)
    if not 1 <= rays <= 16:
        raise ValueError(f"samples: got {samples!r}; allowed is 1 to 16 rays a pixel along each axis")
    if not math.isfinite(time):
        raise ValueError(f"time: got {time!r}; allowed is a finite number, in r_s/c")
    return scene, float(time), _size(size), rays


def _coordinates(
    scene: Scene, psi: ArrayLike | None, chi: ArrayLike | None, alpha: ArrayLike | None, beta: ArrayLike | None
) -> tuple[np.ndarray, np.ndarray]:
    """The two coordinates of rays that the camera of `scene` takes, broadcast."""
    wanted = listed_rays.columns(scene)
    given = {"psi": psi, "chi": 0.0 if chi is None and psi is not None else chi, "alpha": alpha, "beta": beta}
    there = tuple(name for name, values in given.items() if values is not None)
    if there != wanted:
        raise ValueError(f"rays: got {', '.join(there) or 'nothing'}; this camera (camera.distance = {scene.camera.distance:g}) takes {' and '.join(wanted)}")
    first, second = np.broadcast_arrays(*(np.asarray(given[name], float) for name in wanted))
    if not (np.isfinite(first).all() and np.isfinite(second).all()):
        raise ValueError(f"rays: allowed are finite {' and '.join(wanted)}")
    if wanted == listed_rays.ANGLES and ((first < 0.0) | (first > math.nextafter(math.pi, 4.0))).any():
        raise ValueError("psi: allowed is 0 to π radians, from the direction to the hole's centre")
    return first, second


def _as_rays(scene: Scene, found: listed_rays.TracedRays) -> Rays:
    return Rays(
        fate=found.fate,
        direction=found.direction,
        crossing=np.stack([found.crossing_r, found.crossing_phi], axis=-1),
        g=found.crossing_g,
        intensity=listed_rays.intensities(scene, found),
        lam=found.lambda_,
        steps=found.steps,
        delay=found.crossing_delay,
    )


def _sky_picture(scene: Scene, size: Sequence[SupportsIndex], time: float, samples: SupportsIndex | None) -> interferometry.SkyPicture:
    return _shared._thread.call(interferometry.sky_picture, *_asked(scene, size, time, samples))


def _rendered(renderer: _Renderer, scene: Scene, time: float, size: tuple[int, int], samples: int) -> np.ndarray:
    renderer.render_still(scene, time, size, samples)
    return np.ascontiguousarray(annotated(renderer.read_rgb8(), scene, renderer.view_of(scene)))


def _as_png(scene: Scene) -> bytes:
    return png.encode(render(scene, _IN_NOTEBOOKS), preset_files.picture_text(scene, 0.0, Path(os.curdir).absolute()))


Scene.as_png = _as_png
_shared = Renderer()

__all__ = [
    "Fate", "LightCurve", "Plan", "Rays", "Renderer", "Scene", "SceneError", "ScreenCurve", "Visibilities", "critical_curve", "gpus", "hits", "isoradials",
    "lightcurve", "load", "plan", "presets", "radiance", "render", "save", "save_sky", "show", "trace", "visibilities",
]  # fmt: skip
