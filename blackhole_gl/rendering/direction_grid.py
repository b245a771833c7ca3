"""Directions about an observer at even steps of longitude and latitude, and which of them a view shows. All in float64.

Directions are those of the observer's frame (physics/observer.py), in which a camera that turns or zooms changes nothing.
"""

from __future__ import annotations

import math
from dataclasses import dataclass, replace
from functools import cached_property

import numpy as np

from ..physics import projection
from ..physics.observer import look_rotation
from ..scene import Camera
from ..shapes import Bool, Float, Int
from .boxes import Box

CELL = 16
"""Pixels along each side of the squares that a grid is known by."""

# Of a view: its middle may stand so far from the grid's equator, where a pixel is narrower by a seventh; and nothing of it nearer to a pole than that.
_MIDDLE_WITHIN_DEG, _ALL_WITHIN_DEG = 30.0, 75.0
_TILT_DEG = 12.0  # from there on a grid is rolled and pitched as the view, so that its box holds little else

_ON_A_SIDE = 33  # places at which a view's border is looked at: its middle is one
_WIDE_PIXEL = 2e-3  # rad
_BEYOND = 3.0  # pixels about a view that its box holds, for filters


_FROM_SCREEN = np.array([[0.0, 0.0, -1.0], [0.0, -1.0, 0.0], [1.0, 0.0, 0.0]])  # (back, down, right) from (x, y, 1) on a screen at distance 1


@dataclass(frozen=True)
class View:
    """What a camera shows of all directions.

    Attributes:
        look: rotation (3, 3) from the view's (back, down, right) to the observer's frame.
        half: half the picture's width and height at distance 1.
        size: (width, height) in pixels.
    """

    look: Float[np.ndarray, "3 3"]
    half: tuple[float, float]
    size: tuple[int, int]

    @classmethod
    def of(cls, camera: Camera, size: tuple[int, int]) -> View:
        """The view of a perspective `camera` that is not at infinity, in a picture of `size`."""
        high = projection.half_height(camera)
        return cls(look_rotation(camera), (high * size[0] / size[1], high), size)

    @property
    def pixel(self) -> float:
        """The angle in radians of a pixel in the middle."""
        return 2.0 * self.half[1] / self.size[1]

    @property
    def most_latitude(self) -> float:
        """How far its middle may be from a grid's equator, in radians, before that cannot show it."""
        return min(math.radians(_MIDDLE_WITHIN_DEG), math.radians(_ALL_WITHIN_DEG) - math.atan(self.half[1]))

    def going_on(self, before: View, pixels: int) -> View:
        """Where it will be when it has gone on by so many `pixels` as it has come from `before`; itself where it rests, or goes as far in one step."""
        if self.size != before.size:
            return self
        turn, zoom = self.look @ before.look.T, self.half[0] / before.half[0]
        angle = math.acos(min(max(0.5 * (float(np.trace(turn)) - 1.0), -1.0), 1.0))
        step = angle / self.pixel + 0.5 * abs(zoom - 1.0) * self.size[0]
        steps = int(pixels / step) if step > 1e-3 else 0
        grown = zoom**steps
        return replace(self, look=np.linalg.matrix_power(turn, steps) @ self.look, half=(grown * self.half[0], grown * self.half[1]))

    def new_since(self, before: View) -> float:
        """About the share of the picture that one of `before` did not show, 0…2, where it has turned by less than half round."""
        back, down, right = (-before.look[:, 0] @ self.look).tolist()
        ahead = max(-back, 1e-6)
        return 0.5 * (min(abs(right) / (ahead * self.half[0]), 2.0) + min(abs(down) / (ahead * self.half[1]), 2.0))

    @property
    def mesh_side(self) -> int:
        """Side in pixels of the quads of a mesh so fine that the angles of directions are linear in each of them to a quarter of a pixel. A multiple of what
        software renderers shade together, as squares that two quads share are shaded twice."""
        return 32 if self.pixel < _WIDE_PIXEL else 16

    @cached_property
    def border(self) -> Float[np.ndarray, "places 3"]:
        """Directions all along the picture's edge."""
        along = np.linspace(-1.0, 1.0, _ON_A_SIDE)
        sides = [np.stack([along, np.full_like(along, side)], axis=-1) for side in (-1.0, 1.0)]
        places = np.concatenate([*sides, *(side[:, ::-1] for side in sides)]) * self.half
        return np.column_stack([-np.ones(len(places)), -places[:, 1], places[:, 0]]) @ self.look.T

    def shows(self, directions: Float[np.ndarray, "*at 3"], within: float) -> Bool[np.ndarray, "*at"]:
        """Which unit vectors (…, 3) lie in the picture, or `within` so many radians of its edge."""
        back, down, right = np.moveaxis(directions @ self.look, -1, 0)
        ahead = np.maximum(-back, 1e-6)
        x, y = np.abs(right) / ahead, np.abs(down) / ahead
        room = within * (1.0 + x * x + y * y)
        return (back < 0.0) & (x < self.half[0] + room) & (y < self.half[1] + room)


@dataclass(frozen=True)
class DirectionGrid:
    """A part of the equirectangular picture of all directions, kept in textures of its size as in a ring both ways: a pixel of the whole lies where it lay when
    the part moves, and what comes in takes the place of what goes out.

    Attributes:
        axes: rotation (3, 3) from that picture's (back, down, right) to the observer's frame.
        yaw_deg, pitch_deg, roll_deg: of a camera that has these axes.
        rows: of the whole picture, which has twice as many columns.
        corner: column and row of the whole picture at which the part begins.
        size: (width, height) of the part, whole numbers of `CELL`.
        start: column and row in the textures, whole numbers of `CELL`, of the part's first pixel.
    """

    axes: Float[np.ndarray, "3 3"]
    yaw_deg: float
    pitch_deg: float
    roll_deg: float
    rows: int
    corner: tuple[int, int]
    size: tuple[int, int]
    start: tuple[int, int] = (0, 0)

    @classmethod
    def about(cls, camera: Camera, view: View, finer: float, margin: float, least: int = 0, rise_deg: float = 0.0) -> DirectionGrid | None:
        """One that holds the `view` of `camera` and `margin` of its width and height more on each side, `least` pixels at that. Its pixels are `finer` times as
        many along each axis as in the view's middle, and its equator goes where the camera looks when it has turned up by `rise_deg`. None where the view is
        too wide for one."""
        pitch = min(max(camera.pitch_deg + rise_deg, -90.0), 90.0)
        tilted = abs(pitch) > _TILT_DEG or abs(camera.roll_deg) > _TILT_DEG
        pitch, roll = (pitch, camera.roll_deg) if tilted else (0.0, 0.0)
        rows = 2 * round(0.5 * math.pi * finer / view.pixel)
        level = Camera(distance=camera.distance, yaw_deg=camera.yaw_deg, pitch_deg=pitch, roll_deg=roll)
        whole = cls(look_rotation(level), camera.yaw_deg, pitch, roll, rows, (0, 0), (2 * rows, rows))
        if not whole.can_show(view):
            return None
        (x, y, width, height), across = whole.box(view), tuple(2 * rows // side for side in (1, 2))
        low = [max(int(first - max(margin * side, least)), 0) for first, side in ((x, width), (y, height))]
        high = [min(int(first + side + max(margin * side, least)), most) for first, side, most in ((x, width, across[0]), (y, height, across[1]))]
        return cls(whole.axes, whole.yaw_deg, pitch, roll, rows, (low[0], low[1]), (_cells(high[0] - low[0]), _cells(high[1] - low[1])))

    @property
    def picture(self) -> tuple[int, int]:
        """(width, height) of the whole."""
        return 2 * self.rows, self.rows

    @property
    def pixel(self) -> float:
        """The angle in radians from one to the next."""
        return math.pi / self.rows

    def places(self, directions: Float[np.ndarray, "*at 3"]) -> Float[np.ndarray, "*at 2"]:
        """Where in the part `directions` (…, 3) of any length are, in pixels from its lower left."""
        back, down, right = np.moveaxis(directions @ self.axes, -1, 0)
        angles = np.stack([np.arctan2(right, -back), np.arctan2(-down, np.hypot(back, right))], axis=-1)
        return angles / self.pixel + np.array([self.rows, 0.5 * self.rows]) - self.corner

    def box(self, view: View) -> Box:
        """The smallest part of it that holds all that `view` shows, and what filters take beside; it may reach beyond."""
        at = self.places(view.border)
        low, high = np.floor(at.min(axis=0) - _BEYOND), np.ceil(at.max(axis=0) + _BEYOND)
        return int(low[0]), int(low[1]), int(high[0] - low[0]), int(high[1] - low[1])

    def can_show(self, view: View) -> bool:
        """Whether `view` is neither so far from the equator nor so wide that pixels about a pole would be many for what they show."""
        middle, border = ((at + self.corner)[..., 1] * self.pixel - 0.5 * math.pi for at in (self.places(-view.look[:, 0]), self.places(view.border)))
        wide = math.atan(math.hypot(*view.half))
        return bool(abs(middle) < math.radians(_MIDDLE_WITHIN_DEG) and max(wide, np.abs(border).max()) < math.radians(_ALL_WITHIN_DEG))

    def moved_to(self, view: View, beside: int) -> tuple[DirectionGrid, Bool[np.ndarray, "rows columns"]] | None:
        """One of the same pixels, and as large, that holds `view` and, but for the poles, so many pixels `beside` it, moved by as few cells as that takes; and
        which cells of the textures both hold. None where there is none: about a pole, or half round a grid that is tilted."""
        columns, rows = (_step(first - beside, side + 2 * beside, most) for first, side, most in zip(self.box(view)[:2], self.box(view)[2:], self.size))
        rows = min(max(rows, -(self.corner[1] // CELL) * CELL), (self.rows - self.size[1] - self.corner[1]) // CELL * CELL)
        start = (self.start[0] + columns) % self.size[0], (self.start[1] + rows) % self.size[1]
        moved = replace(self, corner=(self.corner[0] + columns, self.corner[1] + rows), start=start)
        if not self.pitch_deg and not self.roll_deg:  # longitude 0 goes along
            yaw = (self.yaw_deg + columns * math.degrees(self.pixel) + 180.0) % 360.0 - 180.0
            moved = replace(moved, yaw_deg=yaw, axes=look_rotation(Camera(yaw_deg=yaw)), corner=(self.corner[0], moved.corner[1]))
        if not (0 <= moved.corner[0] <= 2 * self.rows - self.size[0] and moved.corner[1] >= 0 and moved.holds(view)):
            return None
        across, up = ((places >= step // CELL) & (places < step // CELL + len(places)) for places, step in zip(self._ring_cells, (columns, rows)))
        return moved, up[:, None] & across

    def is_level_with(self, view: View) -> bool:
        """Whether the middle of `view` is so near to its equator that another grid would not have it much nearer."""
        return abs(self.latitude(view)) < math.radians(_TILT_DEG + 1.0)

    def latitude(self, view: View) -> float:
        """Of the middle of `view`, in radians from its equator."""
        return math.asin(min(max(-float((self.axes.T @ -view.look[:, 0])[1]), -1.0), 1.0))

    def holds(self, view: View, beside: int = 0) -> bool:
        """Whether all of `view` lies in it, and so many pixels `beside` that."""
        x, y, width, height = self.box(view)
        sides = zip((x, y), (width, height), self.size)
        return self.can_show(view) and all(first >= beside and first + side <= size - beside for first, side, size in sides)

    def seen(self, view: View, beside: float = 0.0) -> Bool[np.ndarray, "rows columns"]:
        """Which cells of the textures hold anything that `view` shows, or that lies within so many pixels `beside` it."""
        return view.shows(self._cell_directions, (0.72 * CELL + _BEYOND + beside) * self.pixel)

    def ahead(self, view: View) -> Float[np.ndarray, "rows columns"]:
        """Cosine of the angle between each cell of the textures and the middle of `view`."""
        return self._cell_directions @ -view.look[:, 0]

    def from_plane(self, view: View, box: Box) -> tuple[tuple[float, ...], tuple[float, float, float, float]]:
        """How a picture of `view` finds what it shows in the part `box`.

        Returns:
            The matrix (3, 3), column by column, from a place in the picture (x, y, 1), −1…1 from edge to edge, to (right, up, ahead), turned to where the
            view's middle has longitude 0; and scale and shift from (longitude, latitude) there, in radians, to the place in the box, 0…1.
        """
        local = self.axes.T @ view.look @ _FROM_SCREEN @ np.diag([*view.half, 1.0])  # rows: back, down, right
        middle = self.axes.T @ -view.look[:, 0]
        longitude = math.atan2(middle[2], -middle[0])
        c, s = math.cos(longitude), math.sin(longitude)
        around = np.stack([c * local[2] + s * local[0], -local[1], -c * local[0] + s * local[2]])
        x, y = longitude / self.pixel + self.rows - self.corner[0] - box[0], 0.5 * self.rows - self.corner[1] - box[1]
        place = 1.0 / (self.pixel * box[2]), 1.0 / (self.pixel * box[3]), x / box[2], y / box[3]
        return tuple(around.T.ravel().tolist()), place

    def to_plane(self, view: View) -> tuple[float, ...]:
        """The matrix (3, 3), column by column, from (back, down, right) to a place in the picture of `view`, (x, y, 1) · ahead, −1…1 from edge to edge."""
        found = np.diag([1.0 / view.half[0], 1.0 / view.half[1], 1.0]) @ _FROM_SCREEN.T @ view.look.T @ self.axes
        return tuple(found.T.ravel().tolist())

    @property
    def _ring_cells(self) -> tuple[Int[np.ndarray, " columns"], Int[np.ndarray, " rows"]]:
        """Column and row in the part of each column and row of cells in the textures."""
        across, up = ((np.arange(side // CELL) - start // CELL) % (side // CELL) for side, start in zip(self.size, self.start))
        return across, up

    @cached_property
    def _cell_directions(self) -> Float[np.ndarray, "rows columns 3"]:
        columns, rows = (CELL * places + 0.5 * CELL for places in self._ring_cells)
        right, up = (columns + self.corner[0] - self.rows) * self.pixel, (rows + self.corner[1] - 0.5 * self.rows) * self.pixel
        right, up = np.meshgrid(right, up)
        return np.stack([-np.cos(up) * np.cos(right), -np.sin(up), np.cos(up) * np.sin(right)], axis=-1) @ self.axes.T


def _step(first: int, side: int, most: int) -> int:
    """By how many pixels, whole cells, a part of `most` is to move for `side` pixels from the place `first` in it on to lie within it, or in its middle."""
    if side > most - CELL:
        return round((first + 0.5 * (side - most)) / CELL) * CELL
    if first < 0:
        return first // CELL * CELL
    return -(-max(first + side - most, 0) // CELL) * CELL


def _cells(pixels: int) -> int:
    """`pixels` rounded up to whole cells, and never a power of two: docs/llvmpipe.md."""
    whole = -(-pixels // CELL) * CELL
    return whole + CELL if whole & (whole - 1) == 0 else whole
