"""Films: every frame drawn as `render` draws it at its exact time, kept as a PNG until the film is whole, so that a film goes on after whatever stopped it."""

from __future__ import annotations

import json
import shutil
from collections import deque
from collections.abc import Callable, Iterable, Iterator
from concurrent.futures import Future, ThreadPoolExecutor
from contextlib import AbstractContextManager
from dataclasses import dataclass
from fractions import Fraction
from pathlib import Path

import numpy as np

from .output import png
from .output.files import write_whole
from .output.film_file import CODECS, FilmError, packing
from .physics.flight import Flight, Moment
from .rendering.annotation import annotated
from .rendering.frame import Renderer
from .scene import presets

_MANIFEST = "film.json"
_WAITING = 4  # of frames that are drawn, what is still to be written or packed: that goes on while the next are drawn
_BLUR_SAMPLES = 8  # moments in a frame while the shutter is open


_USUAL = {".mp4": "h264", ".mov": "prores", ".webm": "vp9", ".mkv": "h264"}
SUFFIXES = tuple(_USUAL)


@dataclass(frozen=True)
class Film:
    """What a film shows.

    Attributes:
        fps: frames a second, exactly.
        count: of its frames; number k shows the flight at k/fps seconds.
        size: (width, height) in pixels.
        samples: rays a pixel along each axis.
        shutter_deg: for how much of a frame's time, as an angle of 360, light is gathered from its moment on; 0: a moment.
    """

    flight: Flight
    fps: Fraction
    count: int
    size: tuple[int, int]
    samples: int = 1
    shutter_deg: float = 0.0

    def moments(self, number: int) -> list[Moment]:
        """What frame `number` is the mean of."""
        start = Fraction(number) / self.fps
        if not self.shutter_deg:
            return [self.flight.at(float(start))]
        open_for = Fraction(self.shutter_deg) / 360 / self.fps
        return [self.flight.at(float(start + open_for * Fraction(2 * k + 1, 2 * _BLUR_SAMPLES))) for k in range(_BLUR_SAMPLES)]

    def told(self) -> str:
        """All that its frames depend on, as JSON."""
        flight = self.flight
        about = {
            "scene": presets.picture_text(flight.scene, flight.start),
            "keys": [[keyframe.at, dict(keyframe.values)] for keyframe in flight.keys],
            "way": None if flight.way is None else [flight.way.kind, flight.way.rate, flight.way.distance, flight.way.slows],
            "rate": flight.rate,
            "fps": str(self.fps),
            "frames": self.count,
            "size": self.size,
            "samples": self.samples,
            "shutter_deg": self.shutter_deg,
        }
        return json.dumps(about, indent=1, default=list) + "\n"


def frames_folder(out: Path) -> Path:
    """Where the frames of the film `out` lie until it is whole; `out` itself where that is to be a folder of pictures."""
    return out.with_name(f"{out.name}.frames") if out.suffix else out


def codec_of(out: Path, name: str | None) -> str:
    """The codec of the film `out`.

    Raises:
        FilmError: there is none called `name`, it does not go into such a file, or the file's suffix is unknown.
    """
    suffix = out.suffix.lower()
    if suffix not in _USUAL:
        raise FilmError(f"{out}: got the suffix {out.suffix}; allowed is {', '.join(SUFFIXES)}, or a name without one: a folder of PNG pictures")
    chosen = _USUAL[suffix] if name is None else name
    if chosen not in CODECS:
        raise FilmError(f"--codec: got {name!r}; allowed is one of {', '.join(CODECS)}")
    if suffix not in CODECS[chosen].suffixes:
        fitting = [key for key, codec in CODECS.items() if suffix in codec.suffixes]
        raise FilmError(f"--codec: got {chosen} in a {suffix} file; allowed there is {', '.join(fitting)}")
    return chosen


def begin(film: Film, folder: Path) -> None:
    """Makes `folder` ready for the frames of `film`; what is there of the same film stays.

    Raises:
        FilmError: it holds frames of another film.
        OSError: it cannot be made.
    """
    folder.mkdir(parents=True, exist_ok=True)
    manifest = folder / _MANIFEST
    if manifest.is_file() and manifest.read_text(encoding="utf-8") != film.told():
        raise FilmError(f"{folder} holds frames of another film, or of this one with other settings: remove it, or choose another --out")
    write_whole(manifest, film.told().encode("utf-8"))


def frame_path(folder: Path, number: int) -> Path:
    """The file of frame `number`."""
    return folder / f"frame_{number:06}.png"


def missing(film: Film, folder: Path, numbers: Iterable[int]) -> list[int]:
    """Those of `numbers` that are still to be drawn. A frame is written whole or not at all."""
    return [number for number in numbers if not frame_path(folder, number).is_file()]


def draw(
    film: Film,
    folder: Path,
    numbers: Iterable[int],
    renderer: Renderer,
    progress: Callable[[float], None] | None = None,
    pack: Callable[[np.ndarray], None] | None = None,
    *,
    stays: bool = True,
) -> int:
    """Draws those frames of `numbers` that are missing; returns how many those were.

    Args:
        pack: is given the pixels of each of `numbers`, also those that are there, in order and while others are drawn: `packing_of`.
        stays: False of frames that are cleared when the film is whole, and need not be small.

    Raises:
        SceneError, ValueError: a moment cannot be drawn.
        OSError: a frame cannot be written.
    """
    numbers = list(numbers)
    wanted = set(missing(film, folder, numbers))
    if pack is None:
        numbers = [number for number in numbers if number in wanted]
    waiting: deque[Future[None]] = deque()
    with ThreadPoolExecutor(1) as writer, ThreadPoolExecutor(1) as packer:
        for done, number in enumerate(numbers):
            if number in wanted:
                pixels, shown = frame(renderer, film, number)
                waiting.append(writer.submit(_write, folder, number, pixels, shown, stays))
                if pack is not None:
                    waiting.append(packer.submit(pack, pixels))
            elif pack is not None:
                waiting.append(packer.submit(_pack_kept, pack, frame_path(folder, number)))
            while len(waiting) > _WAITING:
                waiting.popleft().result()
            if progress is not None:
                progress((done + 1) / len(numbers))
        for written in waiting:
            written.result()
    return len(wanted)


def _write(folder: Path, number: int, pixels: np.ndarray, shown: Moment, stays: bool) -> None:
    png.write(frame_path(folder, number), pixels, frame_text(shown, folder), packed=stays)


def _pack_kept(pack: Callable[[np.ndarray], None], path: Path) -> None:
    pack(png.read(path))


def frame(renderer: Renderer, film: Film, number: int) -> tuple[np.ndarray, Moment]:
    """The pixels of frame `number`, uint8 (height, width, 3), and the moment whose scene its picture carries.

    Raises:
        SceneError, ValueError: it cannot be drawn.
    """
    moments = film.moments(number)
    shown = moments[len(moments) // 2]
    renderer.render_mean([(moment.scene, moment.time) for moment in moments], film.size, film.samples)
    return annotated(renderer.read_rgb8(), shown.scene, renderer.view_of(shown.scene)), shown


def frame_text(shown: Moment, folder: Path) -> str:
    """What a frame's picture in `folder` carries, as TOML: no work for the thread that draws."""
    return presets.picture_text(shown.scene, shown.time, folder.absolute())


def encode(film: Film, folder: Path, out: Path, codec_name: str) -> None:
    """Packs all frames in `folder` into `out`, as `packing_of` does.

    Raises:
        FilmError: as there.
    """
    with packing_of(film, out, codec_name) as pack:
        for pixels in _pictures(film, folder):
            pack(pixels)


def packing_of(film: Film, out: Path, codec_name: str) -> AbstractContextManager[Callable[[np.ndarray], None]]:
    """Takes the pixels of all frames one after the other, and packs them into `out`, which is written whole or not at all.

    Raises:
        FilmError: there is no PyAV or no such encoder.
    """
    return packing(out, codec_name, film.size, film.fps, film.flight.title or out.stem, film.told(), film.flight.scene.camera.projection)


def clear(folder: Path) -> None:
    """Removes the frames of a film that is whole."""
    shutil.rmtree(folder)


def _pictures(film: Film, folder: Path) -> Iterator[np.ndarray]:
    """Each frame, uint8 (height, width, 3), read ahead by one."""
    with ThreadPoolExecutor(1) as reader:
        ahead = reader.submit(png.read, frame_path(folder, 0))
        for number in range(film.count):
            pixels = ahead.result()
            if number + 1 < film.count:
                ahead = reader.submit(png.read, frame_path(folder, number + 1))
            yield pixels
