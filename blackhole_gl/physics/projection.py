"""How directions lie in a picture: a perspective, or all round. Float64; shaders/common/observer.glsl has the same for shaders.

Directions are those of the view's frame, (back, down, right) of who looks at the picture's middle; places are pixels from the bottom left. Angles on a picture
that shows all round are the same in a pixel whichever way: where its shape is another, the largest that fits stands in the middle, and nothing about it.
"""

from __future__ import annotations

import math

import numpy as np

from ..scene import Camera, Scene, SceneError
from ..shapes import Float

PERSPECTIVE, EQUIRECTANGULAR, STEREO, CUBE, DOME = OPTIONS = ("perspective", "equirectangular", "stereo", "cube", "dome")

SHAPES = {EQUIRECTANGULAR: (2, 1), STEREO: (1, 1), CUBE: (6, 1), DOME: (1, 1)}
"""Width to height of a picture that a projection fills."""

FACES = ("right", "left", "up", "down", "front", "back")
"""Of the cube from left to right, each as who turns there from the front sees it: what FFmpeg's filter v360 calls c6x1."""

# (back, down, right) of a face's middle, its up and its right.
_FACE_AXES = np.array(
    [
        [[0, 0, 1], [0, -1, 0], [1, 0, 0]],
        [[0, 0, -1], [0, -1, 0], [-1, 0, 0]],
        [[0, -1, 0], [1, 0, 0], [0, 0, 1]],
        [[0, 1, 0], [-1, 0, 0], [0, 0, 1]],
        [[-1, 0, 0], [0, -1, 0], [0, 0, 1]],
        [[1, 0, 0], [0, -1, 0], [0, 0, -1]],
    ],
    float,
)

_NEEDS_PERSPECTIVE = ("post.lens", "post.beam")


def is_perspective(camera: Camera) -> bool:
    """Whether the pictures of `camera` are plane, as all are that need not show more than a half of the world."""
    return camera.projection == PERSPECTIVE


def goes_round(camera: Camera) -> bool:
    """Whether the left and the right border of what is shown are neighbours."""
    return camera.projection in (EQUIRECTANGULAR, STEREO)


def refuse(scene: Scene) -> None:
    """Raises SceneError where `scene` asks for what its camera's projection has not."""
    camera = scene.camera
    if is_perspective(camera):
        return
    if math.isinf(camera.distance):
        text = f"got {camera.projection}; a camera at infinity has parallel rays, which come from one side alone: allowed is {PERSPECTIVE}"
        raise SceneError("camera.projection", text)
    for key in _NEEDS_PERSPECTIVE:
        if scene.get(key):
            raise SceneError(key, f"got true with camera.projection = {camera.projection}; it acts on a plane picture: allowed with {PERSPECTIVE} alone")


def refuse_size(camera: Camera, size: tuple[int, int]) -> None:
    """Raises ValueError where a file of `size` (width, height) would show black borders, or what its metadata say would be false.

    A dome's picture may have any, as it has a border anyway.
    """
    if camera.projection in (PERSPECTIVE, DOME):
        return
    across, along = SHAPES[camera.projection]
    width, height = size
    if width * along != height * across or height % 2:
        fitting = max(2 * round(height / 2), 2)
        text = f"width:height {across}:{along}, and an even height, as in {fitting * across // along}x{fitting}"
        raise ValueError(f"size: got {width}x{height}; allowed with camera.projection = {camera.projection} is {text}")


def view_angle(camera: Camera) -> float:
    """The angle in radians that a picture is high, of a camera that is not at infinity."""
    if is_perspective(camera):
        return math.radians(camera.fov_deg)
    return 0.5 * math.pi if camera.projection == CUBE else math.pi


def half_height(camera: Camera) -> float:
    """Half a perspective picture's height on a screen at distance 1, or in M where the camera is infinitely far; of others the half of `view_angle`, or of
    a face of the cube."""
    if math.isinf(camera.distance):
        return 0.5 * camera.field_m
    return math.tan(0.5 * view_angle(camera)) if camera.projection in (PERSPECTIVE, CUBE) else 0.5 * view_angle(camera)


def filled(camera: Camera, size: tuple[int, int]) -> tuple[float, float]:
    """(width, height) in pixels of what the projection fills of a picture of `size`."""
    if is_perspective(camera):
        return float(size[0]), float(size[1])
    across, along = (2, 1) if camera.projection == STEREO else SHAPES[camera.projection]
    height = min(size[0] * along / across, float(size[1]))
    return height * across / along, height


def directions(camera: Camera, size: tuple[int, int], places: Float[np.ndarray, "*at 2"]) -> Float[np.ndarray, "*at 3"]:
    """Unit vectors (…, 3) that `places` (…, 2) of a picture of `size` show; (−1, −β, α) in M for a camera at infinity, whose rays are parallel.

    What lies outside of what a projection fills has one, too, as if it went on there.

    Raises:
        SceneError: the scene has a picture for each of two eyes, which are not in one place.
    """
    width, height = filled(camera, size)
    from_middle = np.asarray(places, float) - 0.5 * np.asarray(size, float)
    if camera.projection == STEREO:
        raise SceneError("camera.projection", f"got {STEREO}, whose eyes are in many places; allowed is any of {', '.join(set(OPTIONS) - {STEREO})}")
    if camera.projection == CUBE:
        return _of_cube(from_middle / height)
    right, up = np.moveaxis(2.0 * half_height(camera) / height * from_middle, -1, 0)
    if camera.projection == EQUIRECTANGULAR:
        return np.stack([-np.cos(up) * np.cos(right), -np.sin(up), np.cos(up) * np.sin(right)], axis=-1)
    if camera.projection == DOME:
        away = np.hypot(right, up)
        share = np.sinc(away / math.pi)  # sin(away)/away
        return np.stack([-np.cos(away), -share * up, share * right], axis=-1)
    local = np.stack([-np.ones_like(right), -up, right], axis=-1)
    return local if math.isinf(camera.distance) else local / np.linalg.norm(local, axis=-1, keepdims=True)


def _of_cube(places: Float[np.ndarray, "*at 2"]) -> Float[np.ndarray, "*at 3"]:
    """Of `places` in sides of a face, from the middle of the picture."""
    across = places[..., 0] + 3.0
    face = np.clip(np.floor(across), 0, 5).astype(int)
    middle, up, right = np.moveaxis(_FACE_AXES[face], -2, 0)
    local = middle + 2.0 * places[..., 1:] * up + (2.0 * (across - face) - 1.0)[..., None] * right
    return local / np.linalg.norm(local, axis=-1, keepdims=True)
