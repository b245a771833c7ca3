"""Film files, by PyAV: pictures at their times, packed by the codec of one's choice."""

from __future__ import annotations

import os
from collections.abc import Callable, Generator
from contextlib import contextmanager
from dataclasses import dataclass
from fractions import Fraction
from itertools import count
from pathlib import Path
from typing import Any

import numpy as np

from . import spherical


@dataclass(frozen=True)
class Codec:
    """How pictures are packed.

    Attributes:
        encoders: names of FFmpeg's that do, the best first.
        suffixes: of files that may hold it.
        pixels: the format of its pixels.
        options: of the encoder, nearly without loss; where it packs beside the drawing, fast.
    """

    encoders: tuple[str, ...]
    suffixes: tuple[str, ...]
    pixels: str
    options: tuple[tuple[str, str], ...]


# Of x264: without these its preset takes twice the processor time, for a tenth fewer bytes.
_QUICK = ("subq", "1"), ("partitions", "none"), ("motion-est", "dia")

CODECS = {
    "h264": Codec(("libx264", "libopenh264"), (".mp4", ".mov", ".mkv"), "yuv420p", (("crf", "16"), ("preset", "veryfast"), *_QUICK)),
    "h265": Codec(("libx265",), (".mp4", ".mov", ".mkv"), "yuv420p", (("crf", "18"), ("tag", "hvc1"), ("x265-params", "log-level=none"))),
    "vp9": Codec(("libvpx-vp9",), (".webm", ".mkv"), "yuv420p", (("crf", "20"), ("b", "0"), ("row-mt", "1"))),
    "av1": Codec(("libsvtav1", "libaom-av1"), (".mp4", ".webm", ".mkv"), "yuv420p10le", (("crf", "22"),)),
    "prores": Codec(("prores_ks",), (".mov",), "yuv422p10le", (("profile", "3"),)),
}


class FilmError(ValueError):
    """A film that cannot be made; the text says what is allowed."""


def encoders() -> dict[str, str]:
    """Codec → the encoder that this installation has for it.

    Raises:
        FilmError: there is no PyAV.
    """
    available = _av().codec.codecs_available
    found = {name: next((encoder for encoder in codec.encoders if encoder in available), "") for name, codec in CODECS.items()}
    return {name: encoder for name, encoder in found.items() if encoder}


@contextmanager
def packing(
    out: Path, codec_name: str, size: tuple[int, int], fps: Fraction, title: str, comment: str, projection: str = "perspective"
) -> Generator[Callable[[np.ndarray], None]]:
    """Takes the pixels of all frames one after the other, and packs them into `out`, which is written whole or not at all.

    Args:
        projection: of the pictures, as scenes name it; what there are words for is said in the file.

    Raises:
        FilmError: there is no PyAV or no such encoder, or the codec takes even sizes alone.
    """
    av, codec, available = _av(), CODECS[codec_name], encoders()
    if codec_name not in available:
        raise FilmError(f"--codec: got {codec_name}, which this installation of PyAV cannot write; allowed is one of {', '.join(available)}")
    part = out.with_name(f".{out.stem}.part{out.suffix}")
    try:
        with av.open(str(part), "w") as container:
            container.metadata.update({"title": title, "comment": comment})
            stream, numbers = _stream(container, size, fps, codec, available[codec_name]), count()
            converter = av.video.reformatter.VideoReformatter()  # keeps its tables, which each picture would else make anew

            def pack(pixels: np.ndarray) -> None:
                given = av.VideoFrame.from_numpy_buffer(np.ascontiguousarray(pixels), format="rgb24")
                picture = converter.reformat(given, format=codec.pixels, dst_colorspace="ITU709", threads=1)
                picture.pts, picture.time_base = next(numbers), 1 / fps
                container.mux(stream.encode(picture))

            yield pack
            container.mux(stream.encode(None))
        if projection in spherical.PAIRS and out.suffix.lower() in spherical.SUFFIXES:
            spherical.mark(part, pair=spherical.PAIRS[projection])
        part.replace(out)
    finally:
        part.unlink(missing_ok=True)


def refuse_size(size: tuple[int, int], codec_name: str) -> None:
    """Raises FilmError where pictures of `size` cannot be packed: colours have half the resolution."""
    if any(side % 2 for side in size):
        raise FilmError(f"--size: got {size[0]}x{size[1]}; allowed with {codec_name} are even numbers")


def _stream(container: Any, size: tuple[int, int], fps: Fraction, codec: Codec, encoder: str) -> Any:
    options = dict(codec.options)
    tag = options.pop("tag", None)
    stream = container.add_stream(encoder, rate=fps, options=options)
    stream.width, stream.height = size
    stream.pix_fmt = codec.pixels
    context = stream.codec_context
    context.time_base = 1 / fps
    context.color_primaries = context.color_trc = context.colorspace = 1  # BT.709, which players take for HD pictures
    if tag:
        context.codec_tag = tag
    return stream


def _av() -> Any:
    os.environ.setdefault("SVT_LOG", "1")  # of the encoder of AV1, which tells its settings else
    try:
        import av
    except ImportError:
        raise FilmError("a film needs PyAV: pip install 'blackhole-gl[film]'; an --out without a suffix gives a folder of PNG pictures instead") from None
    return av
