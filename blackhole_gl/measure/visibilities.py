"""What an interferometer measures of a picture: visibilities on given baselines, closure phases of triangles, and the picture as radio astronomers' programs
read it.

V(u, v) = ∬ I(l, m) exp(−2πi (u l + v m)) dl dm over the whole light, with l to the east and m to the north (Thompson, Moran & Swenson 2017, eq. 3.7): a sum
over pixels, exact for every baseline, on no grid. Up is north and left is east, so that the spin axis has the position angle ``camera.roll_deg``. The scene's
beam plays no part, for it is what is made of such measurements. The package ehtim takes the other sign in the exponent.
"""

from __future__ import annotations

import csv
import io
from dataclasses import dataclass

import numpy as np
from numpy.typing import ArrayLike

from ..number_lists import NumberList
from ..physics import angular_size, projection
from ..rendering.frame import Renderer
from ..rendering.metering import LUMINANCE
from ..scene import Scene, SceneError
from ..shapes import Complex, Float

BASELINES, TRIANGLES = ("u", "v"), ("u1", "v1", "u2", "v2")
"""Columns of lists, in wavelengths; the third baseline of a triangle is that which closes it."""

_AT_BASELINES, _AT_TRIANGLES = ("amplitude", "phase_deg"), ("amplitude1", "amplitude2", "amplitude3", "closure_phase_deg")
WRITTEN = frozenset((*_AT_BASELINES, *_AT_TRIANGLES))
_AT_ONCE = 4096  # baselines: what they need for themselves is as large as so many rows of the picture
_CLOSED = 1e-6  # by how much, relatively, a triangle may be open


@dataclass(frozen=True)
class SkyPicture:
    """The light of a scene as it is on the sky.

    Attributes:
        light: luminance over that of the whole picture, its top row first; sums up to 1.
        pixel: the angle of a pixel's side, in radians.
    """

    light: Float[np.ndarray, "height width"]
    pixel: float


@dataclass(frozen=True)
class Visibilities:
    """Of baselines in arrays of any shape (…).

    Attributes:
        u, v: towards east and north, in wavelengths.
        value: complex, 1 on no baseline: shares of all the light in the picture.
    """

    u: Float[np.ndarray, "*baselines"]
    v: Float[np.ndarray, "*baselines"]
    value: Complex[np.ndarray, "*baselines"]

    @property
    def amplitude(self) -> Float[np.ndarray, "*baselines"]:
        """|V|, 1 on no baseline."""
        return np.abs(self.value)

    @property
    def phase(self) -> Float[np.ndarray, "*baselines"]:
        """arg V in radians, −π … π; of the picture's middle 0."""
        return np.angle(self.value)

    def closure_phases(self) -> np.ndarray:
        """arg V₁V₂V₃ in radians of triangles, three baselines each along the last axis: no telescope's own delay is in it (Jennison 1958).

        Raises:
            ValueError: the last axis has not three, or they do not add up to 0.
        """
        if self.value.shape[-1:] != (3,):
            raise ValueError(f"baselines: got the shape {self.value.shape}; allowed for closure phases is (…, 3), three to a triangle")
        longest = np.hypot(self.u, self.v).max(axis=-1)
        if np.any(np.hypot(self.u.sum(axis=-1), self.v.sum(axis=-1)) > _CLOSED * longest):
            raise ValueError("baselines: the three of a triangle do not add up to 0; allowed are those from 1 to 2, 2 to 3 and 3 to 1")
        return np.angle(self.value.prod(axis=-1))


def sky_picture(renderer: Renderer, scene: Scene, time: float, size: tuple[int, int], samples: int = 1) -> SkyPicture:
    """The light of `scene` at scene time `time`, `size` pixels large, at the mass and distance that it states.

    Raises:
        SceneError: there is no light, or a view's colours, which are none; or as drawing it.
    """
    if scene.post.view != "picture":
        raise SceneError("post.view", f"got {scene.post.view!r}; allowed is 'picture' here, as a view's colours are no brightness")
    if not projection.is_perspective(scene.camera):
        raise SceneError("camera.projection", f"got {scene.camera.projection}; the sky is told of a plane picture: allowed is {projection.PERSPECTIVE}")
    light = renderer.still_radiance(scene, time, size, samples).astype(float) @ LUMINANCE
    if not light.sum() > 0.0:
        raise SceneError("disk", "nothing shines in this picture, so that there is nothing to measure")
    pixel = angular_size.picture_height_uas(scene.camera, scene.source) * angular_size.MICROARCSECOND / size[1]
    return SkyPicture(light / light.sum(), pixel)


def of(picture: SkyPicture, u: ArrayLike, v: ArrayLike) -> Visibilities:
    """The visibilities of `picture` on baselines (`u`, `v`), arrays that broadcast, in wavelengths.

    Raises:
        ValueError: they are not finite.
    """
    east, north = (np.array(part) for part in np.broadcast_arrays(np.asarray(u, float), np.asarray(v, float)))
    if not (np.isfinite(east).all() and np.isfinite(north).all()):
        raise ValueError("baselines: allowed are finite u and v, in wavelengths")
    flat_u, flat_v = east.ravel(), north.ravel()
    parts = [_transformed(picture, flat_u[k : k + _AT_ONCE], flat_v[k : k + _AT_ONCE]) for k in range(0, len(flat_u), _AT_ONCE)]
    return Visibilities(east, north, np.concatenate([np.empty(0, complex), *parts]).reshape(east.shape))


def of_list(picture: SkyPicture, listed: NumberList) -> Visibilities:
    """Of a list with the columns `BASELINES`, shape (N,), or `TRIANGLES`, shape (N, 3)."""
    values = listed.values
    if values.shape[1] == len(BASELINES):
        return of(picture, values[:, 0], values[:, 1])
    u, v = (np.stack([values[:, k], values[:, k + 2], -values[:, k] - values[:, k + 2]], axis=-1) for k in (0, 1))
    return of(picture, u, v)


def as_csv(found: Visibilities, listed: NumberList, flux: float) -> str:
    """A row for each of `listed`, whose columns stand first, as they were given; amplitudes of a picture of the flux `flux`."""
    text = io.StringIO()
    writer = csv.writer(text, lineterminator="\n")
    if found.value.ndim == 1:
        names, columns = _AT_BASELINES, [flux * found.amplitude, np.degrees(found.phase)]
    else:
        names, columns = _AT_TRIANGLES, [*(flux * found.amplitude.T), np.degrees(found.closure_phases())]
    writer.writerow([*listed.names, *names])
    for given, row in zip(listed.texts, np.transpose(columns)):
        writer.writerow([*given, *(f"{value:.9g}" for value in row)])
    return text.getvalue()


def _transformed(picture: SkyPicture, u: Float[np.ndarray, " N"], v: Float[np.ndarray, " N"]) -> Complex[np.ndarray, " N"]:
    height, width = picture.light.shape
    east = -(np.arange(width) - 0.5 * (width - 1)) * picture.pixel
    north = -(np.arange(height) - 0.5 * (height - 1)) * picture.pixel
    along_rows = np.exp(-2j * np.pi * u[:, None] * east) @ picture.light.T  # (N, height)
    return (along_rows * np.exp(-2j * np.pi * v[:, None] * north)).sum(axis=1)
