"""Stills as files, with what viewers of panoramas look for. Rows of a PNG are packed while others are drawn."""

from __future__ import annotations

from collections.abc import Iterator
from pathlib import Path

from ..output import jpeg, png, xmp
from ..physics import projection
from ..scene import Camera, Scene, presets
from .annotation import annotated, is_annotated
from .frame import Renderer
from .tiles import TILE

SUFFIXES = (".png", *jpeg.SUFFIXES)

WHITE = 8.0
"""Radiance that a 16-bit PNG's 65535 stands for."""


def write(
    renderer: Renderer, path: Path, scene: Scene, time: float, size: tuple[int, int], samples: int = 1, tile: int = TILE
) -> Iterator[float]:
    """Draws `scene` at scene time `time` (r_s/c) and writes it to `path`, a JPEG by its suffix or else a PNG, whole or not at all; yields the share done.

    As long as it is a PNG, and neither labels nor a view's legend are drawn over it, no more than some bands of it are held.

    Args:
        tile: side in pixels, even, of the tiles that it is drawn in.

    Raises:
        SceneError, ValueError: it cannot be drawn.
        OSError: it cannot be written.
    """
    text = presets.picture_text(scene, time, path.absolute().parent)
    if path.suffix.lower() in jpeg.SUFFIXES:
        yield from renderer.still(scene, time, size, samples, tile)
        jpeg.write(path, annotated(renderer.read_rgb8(), scene, renderer.view_of(scene)), text, metadata(scene.camera, size))
        return
    with png.opened(path, size, text, metadata(scene.camera, size)) as file:
        if is_annotated(scene, renderer.view_of(scene)):
            yield from renderer.still(scene, time, size, samples, tile)
            file.write(annotated(renderer.read_rgb8(), scene, renderer.view_of(scene)))
            return
        for share, rows in renderer.bands([(scene, time)], size, samples, tile):
            if rows is not None:
                file.write(rows)
            yield share


def write_linear(renderer: Renderer, path: Path, scene: Scene, time: float, size: tuple[int, int], samples: int = 1) -> None:
    """Writes the linear radiance of the same to `path`, 16 bits a channel, of which 65535 stands for `WHITE` and all above.

    It is that before exposure, glow and tone curve.

    Raises:
        As `write`.
    """
    text = presets.picture_text(scene, time, path.absolute().parent)
    png.write(path, png.linear16(renderer.still_radiance(scene, time, size, samples), WHITE), text, metadata(scene.camera, size), WHITE)


def save(renderer: Renderer, scene: Scene, time: float, size: tuple[int, int], samples: int, *, path: Path, linear: bool = False) -> None:
    """`write_linear` or `write`, at once."""
    if linear:
        write_linear(renderer, path, scene, time, size, samples)
        return
    for _ in write(renderer, path, scene, time, size, samples):
        pass


def metadata(camera: Camera, size: tuple[int, int]) -> str:
    """The XMP packet of a picture by `camera`; empty for those that there are no words for: a pair for two eyes, a cube, a dome."""
    return xmp.panorama(size) if camera.projection == projection.EQUIRECTANGULAR else ""
