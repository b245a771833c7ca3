"""Where the picture lies in the window, and how large a picture of it is."""

from __future__ import annotations

from dataclasses import dataclass


@dataclass(frozen=True)
class Area:
    """A rectangle of the window in framebuffer pixels, counted from the bottom left."""

    x: int
    y: int
    width: int
    height: int

    @classmethod
    def of_screen(cls, left: float, top: float, width: float, height: float, display_height: float, scale: tuple[float, float]) -> Area:
        """The area of a rectangle in screen coordinates, from the top left, on a display with `scale` framebuffer pixels to a unit."""
        x, right = round(left * scale[0]), round((left + width) * scale[0])
        y, ceiling = round((display_height - top - height) * scale[1]), round((display_height - top) * scale[1])
        return cls(x, y, right - x, ceiling - y)

    @property
    def is_empty(self) -> bool:
        """Whether it holds no pixel."""
        return self.width < 1 or self.height < 1

    @property
    def size(self) -> tuple[int, int]:
        """(width, height)."""
        return self.width, self.height

    @property
    def viewport(self) -> tuple[int, int, int, int]:
        """(x, y, width, height), as GL takes it."""
        return self.x, self.y, self.width, self.height

    def scaled(self, scale: float) -> tuple[int, int]:
        """(width, height) of a picture with about `scale` times as many pixels each way, at least one."""
        return _side(self.width, scale), _side(self.height, scale)


@dataclass(frozen=True)
class FreePart:
    """The part of the window beside the panel: in imgui's units from the top left, and in framebuffer pixels."""

    left: float
    top: float
    width: float
    height: float
    area: Area


def _side(pixels: int, scale: float) -> int:
    """`scale` times as many pixels, or up to four less.

    Sides that are powers of two have shaders compiled anew (docs/llvmpipe.md), for up to a second. The grid of a refined hit map and the first level of the
    bloom have a quarter of the picture's side, rounded up, and with every step of the scale another.
    """
    side = max(round(pixels * scale), 1)
    quarter = -(-side // 4)
    is_power_of_two = quarter & (quarter - 1) == 0
    return 4 * (quarter - 1) if scale < 1.0 and quarter > 4 and is_power_of_two else side
