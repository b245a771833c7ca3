"""The command video: a scene in motion as a film, or as a share of its frames."""

from __future__ import annotations

import math
import os
import sys
from fractions import Fraction
from pathlib import Path
from typing import TYPE_CHECKING, Annotated

from .arguments import Option
from .asked import AnyFile, Backend, Named, Presets, Settings, before_drawing, renderer_by, scene_of, size_of, time_of
from .output.files import refuse_unwritable
from .output.progress import Progress
from .scene import Scene

if TYPE_CHECKING:
    from .physics.flight import Flight

_MOST_FRAMES = 1_000_000


def video(
    out: Annotated[Path, Option("--out", "-o", help="The film: .mp4, .mov, .webm or .mkv; a name without a suffix is a folder of PNG pictures.")],
    names: Named = None,
    preset: Presets = None,
    set_: Settings = None,
    any_file: AnyFile = False,
    path: Annotated[Path | None, Option(help="The flight: a TOML file, or dive, fly_by, hover, orbit_at_isco. Without it the camera rests.")] = None,
    fps: Annotated[str, Option(help="Frames a second; a fraction such as 30000/1001, too.")] = "30",
    seconds: Annotated[float | None, Option(least=0.0, most=1e5, help="Length of the film.", default="that of the flight")] = None,
    size: Annotated[str, Option(help="Width × height in pixels.")] = "1280x720",
    time: Annotated[float | None, Option(help="Scene time in r_s/c to begin at. When not given: that of a saved picture or scene, or 0.")] = None,
    samples: Annotated[int | None, Option(least=1, most=16, help="Rays a pixel along each axis.", default="as the scene's quality has it")] = None,
    shutter: Annotated[float, Option(least=0.0, most=360.0, help="Angle of the shutter in degrees: 180 gathers light for half of a frame's time.")] = 0.0,
    codec: Annotated[str | None, Option(help="One of h264, h265, vp9, av1, prores.", default="what suits the file")] = None,
    frames: Annotated[str | None, Option(metavar="FIRST:END", help="Draw these alone, or slurm: this job's share; it is packed when all are there.")] = None,
    dask: Annotated[str | None, Option(metavar="ADDRESS", help="Have the cluster draw them whose scheduler is there, tcp://….", default="none")] = None,
    keep_frames: Annotated[bool, Option("--keep-frames", help="Leave the frames beside the film.")] = False,
    backend: Backend = "auto",
) -> None:
    """Draw a film, every frame at its exact time. Started again after whatever stopped it, it goes on with the first frame that is missing."""
    from . import film
    from .output import film_file

    path = _found(path)
    preset = [*(names or ()), *(preset or ())] or _presets(path)
    scene = scene_of(preset, set_, any_file)
    made = film.Film(
        flown := _flight(scene, path, time_of(time, preset)),
        rate := _fps(fps),
        _count(flown, rate, seconds),
        size_of(size),
        samples or scene.rays.in_stills,
        shutter,
    )
    packing = film.codec_of(out, codec) if out.suffix else None
    if packing is not None:
        film_file.refuse_size(made.size, packing)
        refuse_unwritable(out, film.SUFFIXES, "a film")
        film_file.encoders()
    wanted = range(made.count) if frames is None else _share(frames, made.count)
    before_drawing(scene, set_)
    folder = film.frames_folder(out)
    film.begin(made, folder)
    there = len(wanted) - len(film.missing(made, folder, wanted))
    if there:
        print(f"{there} of {len(wanted)} frames are there", file=sys.stderr)
    with Progress("drawing") as progress:
        if dask is not None:
            from . import film_cluster

            film_cluster.draw(made, folder, wanted, dask, progress)
        elif packing is not None and wanted == range(made.count):
            with film.packing_of(made, out, packing) as pack:
                film.draw(made, folder, wanted, renderer_by(backend), progress, pack, stays=keep_frames)
        else:
            film.draw(made, folder, wanted, renderer_by(backend), progress)
    left = len(film.missing(made, folder, range(made.count)))
    if packing is None or left:
        print(f"{made.count - left} of {made.count} frames in {folder}", file=sys.stderr)
        return
    if dask is not None or wanted != range(made.count):
        film.encode(made, folder, out, packing)
    if not keep_frames:
        film.clear(folder)


def _flight(scene: Scene, path: Path | None, start: float) -> Flight:
    from .physics import flight, flight_files

    return flight.Flight(scene, rate=scene.playback.rate, start=start) if path is None else flight_files.read(path, scene, start)


def _found(path: Path | None) -> Path | None:
    """The file that `path` means, which may be a shipped flight's name."""
    if path is None or path.exists():
        return path
    from .physics import flight_files

    return flight_files.shipped().get(str(path), path)


def _presets(path: Path | None) -> list[str]:
    """Those that the flight at `path` is made for."""
    if path is None:
        return []
    from .physics import flight_files

    return list(flight_files.presets_of(path))


def _fps(text: str) -> Fraction:
    try:
        found = Fraction(text)
    except (ValueError, ZeroDivisionError):
        found = Fraction(0)
    if not 0 < found <= 1000:
        raise ValueError(f"--fps: got {text!r}; allowed is a number up to 1000, or a fraction such as 30000/1001")
    return found.limit_denominator(100_000)


def _count(flown: Flight, fps: Fraction, seconds: float | None) -> int:
    """How many frames `seconds`, or the flight's own, are; a flight's last moment is on the last frame."""
    length = flown.seconds if seconds is None else seconds
    if math.isinf(length):
        raise ValueError("--seconds: missing; allowed is how long the film is to be, for nothing else ends it")
    count = math.floor(Fraction(length).limit_denominator(1_000_000) * fps) + (seconds is None)
    if not 1 <= count <= _MOST_FRAMES:
        raise ValueError(f"--seconds: got {length:g}, which is {count} frames; allowed are 1 to {_MOST_FRAMES}")
    return count


def _share(text: str, count: int) -> range:
    """The frames ``120:240``, the last not among them; ``120:`` and ``:240`` begin and end with the film; ``slurm``: one of equal shares of a job array."""
    if text == "slurm":
        return _slurm_share(count)
    first, colon, end = text.partition(":")
    try:
        found = range(int(first or 0), min(int(end or count), count))
    except ValueError:
        found = range(0)
    if not colon or not found or found.start < 0:
        raise ValueError(f"--frames: got {text!r}; allowed is FIRST:END within 0:{count}, e.g. 0:{max(count // 2, 1)}")
    return found


def _slurm_share(count: int) -> range:
    try:
        index, first, number = (int(os.environ[f"SLURM_ARRAY_TASK_{name}"]) for name in ("ID", "MIN", "COUNT"))
    except (KeyError, ValueError):
        raise ValueError("--frames: slurm is allowed within a job array, whose variables SLURM_ARRAY_TASK_ID, _MIN and _COUNT are not set here") from None
    share = index - first
    return range(share * count // number, (share + 1) * count // number)
