"""Words that Python and GLSL share, from one declaration: shaders get each as a ``#define`` of its number."""

from __future__ import annotations

from enum import IntEnum
from functools import cached_property


class Fate(IntEnum):
    """What became of a ray. Two bits of a texel hold it."""

    UNRESOLVED = 0
    ESCAPED = 1
    CAPTURED = 2
    MET = 3
    """It ends on something opaque."""


class PixelClass(IntEnum):
    """What a pixel needs of the shade pass, as tenths of depth: the depth test then keeps shaders from pixels that do not need them."""

    OWN_RAY = 0
    """A ray of its own: the trace pass is still to draw it, and it may need anything."""
    MATTER = 1
    """May show the disk, but no thing or medium, and may be of the sky."""
    SKY = 2
    """Of the sky, with nothing before it."""
    NEITHER = 4
    FLAT_SKY = 7
    """As SKY, and directions may be interpolated linearly: nothing else is read. With `SKY` it adds up to 9, so that one minus its depth is that of SKY."""
    SOLID_THING = 8
    """Its ray ends on a thing: nothing of the sky."""
    THING = 9
    """May show a thing or a medium, and may need anything; with a ray of its own, as `OWN_RAY`, which shows none."""

    @cached_property
    def depth(self) -> float:
        """What stands in the depth buffer."""
        return 0.1 * self + 0.05

    @cached_property
    def depth_beyond(self) -> float:
        """Between this class and those farther away."""
        return 0.1 * (self + 1)


class EdgeMark(IntEnum):
    """What shaders/common/edge_marks.glsl tells of a pixel's ray, in eight bits of which the first two hold its fate, and eight of what is met."""

    RING_1 = 4
    """Two bits: where the crossing that makes the first ring lies."""
    RING_2 = 16
    """The same of the second ring."""
    VEILED = 64
    """The direct picture hides the first ring's edges."""
    IN_FIELD = 128
    """The ray comes into the sphere of a field."""
    NO_RAY = 255
    """The pixel has no ray of its own."""
    MET = 127
    """Of the second eight bits: those that tell things and media apart, 0 where none is met."""


def defines() -> dict[str, int]:
    """Name → number of every shared word."""
    return {
        **{fate.name: int(fate) for fate in Fate},
        **{f"PIXEL_{kind.name}": int(kind) for kind in PixelClass},
        **{f"EDGE_{mark.name}": int(mark) for mark in EdgeMark},
    }
