"""Renderers for scripts: any number of them, each by a context of its own, from any thread; what their arguments may be."""

from __future__ import annotations

import math
import operator
from collections.abc import Callable, Sequence
from concurrent.futures import ThreadPoolExecutor
from dataclasses import dataclass, fields
from typing import Any, SupportsIndex

import numpy as np
from numpy.typing import ArrayLike

from . import listed_rays
from .gl_thread import GlThread
from .measure import light_curve
from .measure.light_curve import LightCurve
from .rendering import context
from .rendering.annotation import annotated
from .rendering.frame import Renderer as _Renderer
from .scene import Scene, refuse_other
from .shapes import Float, Int

_MOST_SIDE = 32768
_RAYS_AT_ONCE = 1 << 18  # that are listed: 80 bytes of textures each


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
        return of_picture(self, _rendered, scene, size, time, samples)

    def radiance(self, scene: Scene, size: Sequence[SupportsIndex] = (1280, 720), time: float = 0.0, samples: SupportsIndex | None = None) -> np.ndarray:
        """As the function `radiance`."""
        return of_picture(self, _Renderer.still_radiance, scene, size, time, samples)

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
        refuse_other(scene)
        return self._traced(scene, listed_rays.pixel_rays(scene, _size(size)))

    def lightcurve(self, scene: Scene, times: ArrayLike | None = None, size: Sequence[SupportsIndex] = (320, 180)) -> LightCurve:
        """As the function `lightcurve`."""
        refuse_other(scene)
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


def of_picture(
    renderer: Renderer,
    work: Callable[..., Any],
    scene: Scene,
    size: Sequence[SupportsIndex],
    time: float,
    samples: SupportsIndex | None,
    **more: Any,
) -> Any:
    """What `work` makes of a picture that is asked for: it is given the inner renderer, the scene, the time, the size and the rays a pixel along each axis,
    checked, and `more`.

    Raises:
        TypeError: `scene` is none. ValueError: an argument is out of range; and what `work` raises.
    """
    return renderer._thread.call(work, *_asked(scene, size, time, samples), **more)


def _asked(scene: Scene, size: Sequence[SupportsIndex], time: float, samples: SupportsIndex | None) -> tuple[Scene, float, tuple[int, int], int]:
    """What a picture is made of, checked, in the order that `still_radiance` takes it."""
    refuse_other(scene)
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
    refuse_other(scene)
    wanted = listed_rays.columns(scene)
    given = {"psi": psi, "chi": 0.0 if chi is None and psi is not None else chi, "alpha": alpha, "beta": beta}
    there = tuple(name for name, values in given.items() if values is not None)
    if there != wanted:
        raise ValueError(f"rays: got {', '.join(there) or 'nothing'}; this camera (camera.distance = {scene.camera.distance:g}) takes {' and '.join(wanted)}")
    arrays = [np.asarray(given[name], float) for name in wanted]
    try:
        first, second = np.broadcast_arrays(*arrays)
    except ValueError:
        shapes = " and ".join(f"{name} of shape {values.shape}" for name, values in zip(wanted, arrays))
        raise ValueError(f"rays: got {shapes}; allowed are shapes that broadcast") from None
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


def _rendered(renderer: _Renderer, scene: Scene, time: float, size: tuple[int, int], samples: int) -> np.ndarray:
    renderer.render_still(scene, time, size, samples)
    return np.ascontiguousarray(annotated(renderer.read_rgb8(), scene, renderer.view_of(scene)))
