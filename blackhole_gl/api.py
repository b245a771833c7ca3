"""What ``import blackhole_gl as bh`` offers: scenes in, arrays out. It needs no display, and none of it needs a word of OpenGL.

Every function may be called from any thread, and from processes however they were started; what several ask for at once is done one after the other. Sizes are
(width, height) in pixels, each 1 to 32768; arrays of pictures have their top row first. Numbers may be NumPy's.
"""

from __future__ import annotations

import os
import subprocess
import sys
import tempfile
from collections.abc import Mapping, Sequence
from pathlib import Path
from typing import Any, SupportsIndex

import numpy as np
from numpy.typing import ArrayLike

from . import layers
from .glsl.declared import Fate
from .measure import visibilities as interferometry
from .measure.light_curve import LightCurve
from .measure.visibilities import Visibilities
from .output import png
from .physics.screen_curves import ScreenCurve, critical_curve, isoradials
from .planning import Plan
from .planning import plan as make_plan
from .renderers import Rays, Renderer, gpus, of_picture
from .rendering import still_files
from .scene import Scene, SceneError, refuse_other
from .scene import presets as preset_files
from .scene.lengths import UNITS
from .scene.presets import PresetInfo

_IN_NOTEBOOKS = (640, 360)


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
        TypeError: it is no scene, but a preset's name, say.
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
    refuse_other(scene)
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
    """Writes `scene` to `path`, by its suffix, and returns the path: ``.png`` and ``.jpg`` the picture, ``.toml`` a preset, ``.exr``, ``.fits`` and ``.npz``
    linear radiance with layers of what each pixel's ray meets: fate, order, r, φ, g, delay. `load` and the viewer open all of them again.

    Args:
        lengths: unit of all lengths in a preset, ``r_s`` or ``M``; `load` reads both.
        linear: a ``.png`` of linear radiance, 16 bits a channel, of which 65535 stands for a radiance of 8.

    Raises:
        ValueError: another suffix or unit, or one whose library is not there; as in `render`.
        OSError: it cannot be written.
    """
    refuse_other(scene)
    path = Path(path)
    suffix = path.suffix.lower()
    if suffix == ".toml":
        if lengths not in UNITS:
            raise ValueError(f"lengths: got {lengths!r}; allowed is one of {', '.join(UNITS)}")
        return preset_files.save(scene, path, time=time or None, unit=lengths)
    if suffix in layers.SUFFIXES:
        layers.write(path, of_picture(_shared, layers.measured, scene, size, time, samples), scene, float(time))
    elif suffix in still_files.SUFFIXES:
        if linear and suffix != ".png":
            raise ValueError(f"linear: got {path.name}; allowed with it is .png, and {', '.join(layers.SUFFIXES)} are linear anyway")
        of_picture(_shared, still_files.save, scene, size, time, samples, path=path, linear=linear)
    else:
        raise ValueError(f"{path}: got the suffix {path.suffix!r}; allowed is {', '.join((*still_files.SUFFIXES, '.toml', *layers.SUFFIXES))}")
    return path


def show(scene: Scene, *, wait: bool = True) -> subprocess.Popen:
    """Opens the viewer on `scene`, in a process of its own.

    Args:
        wait: return when it is closed.

    Returns:
        That process.
    """
    refuse_other(scene)
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


def _sky_picture(scene: Scene, size: Sequence[SupportsIndex], time: float, samples: SupportsIndex | None) -> interferometry.SkyPicture:
    return of_picture(_shared, interferometry.sky_picture, scene, size, time, samples)


def _as_png(scene: Scene) -> bytes:
    return png.encode(render(scene, _IN_NOTEBOOKS), preset_files.picture_text(scene, 0.0, Path(os.curdir).absolute()))


Scene.as_png = _as_png
_shared = Renderer()

__all__ = [
    "Fate", "LightCurve", "Plan", "Rays", "Renderer", "Scene", "SceneError", "ScreenCurve", "Visibilities", "critical_curve", "gpus", "hits", "isoradials",
    "lightcurve", "load", "plan", "presets", "radiance", "render", "save", "save_sky", "show", "trace", "visibilities",
]  # fmt: skip
