"""What is told of a frame that was drawn."""

from __future__ import annotations

from dataclasses import dataclass


@dataclass(frozen=True)
class FrameReport:
    """What one frame took.

    Attributes:
        trace_ms, shade_ms, post_ms: wall-clock milliseconds of each pass; all 0 unless asked to measure.
        traced: whether rays of the hit map were traced; False when what is kept of it, or of directions, served.
        marched: how many rays were, for the picture's pixels and for what it keeps of directions beside it.
        sharp: whether every pixel had a ray of its own.
        sharpened: whether the rays traced only made a slice of a kept map exact, or were for a picture to come, so that what it took says little.
        method: the plan's method in a few words.
        reasons: why the plan chose it.
        warnings: what it makes worse than the scene asks.
        stops: what automatic exposure adds; 0 where it is off.
        settled: whether that is what it will add to the next frame of the same, too.
    """

    trace_ms: float
    shade_ms: float
    post_ms: float
    traced: bool
    marched: int
    sharp: bool
    sharpened: bool
    method: str
    reasons: tuple[str, ...]
    warnings: tuple[str, ...]
    stops: float
    settled: bool
