"""Pictures of a camera that only turns or zooms: from light that is kept by direction.

What comes from a direction of the observer's frame does not depend on where he looks. So rays are traced and their sky is shaded on a grid of directions
(known_light.py), square by square as a view first shows them; the disk alone, which turns, is shaded in each frame. The finished picture of what the view shows
of the grid is then filtered into the view's own pixels, and single stars are drawn over it. It is as sharp as a picture that is moved by a part of a pixel: for
frames in motion. One at rest has rays of its own.

A grid serves a view as long as its pixels are about as wide and the view lies in it. Another is made in time, some of its rays in every second frame.
"""

from __future__ import annotations

import math
from dataclasses import dataclass, replace

import moderngl
import numpy as np

from ..planning import Plan
from ..scene import Scene
from . import kept_light
from .boxes import Box
from .direction_grid import CELL, DirectionGrid, View
from .inputs import FrameInputs
from .known_light import KnownLight
from .post import PostPass
from .programs import Programs, chosen
from .star_layer import StarLayer
from .tables import Tables
from .target import Target
from .temperatures import TemperatureProfile
from .uniforms import stars_a_pixel

_STAYS = 4  # pictures of one view that follow one that has turned, before it counts as resting: hands do not turn in every frame

# Pixels of a grid to those of a view, along each axis of its middle; of one whose picture is not made in every frame, and which shows all of its stars.
_FINER, _FINER_LASTING = 1.0, 1.2
_MARGIN = (0.3, 0.3)  # of a view's width and height that a grid has on each side
_UNLIKE = 1.05  # change of a view's pixel from which on another grid is begun
_AHEAD_OF_ZOOM = 1.25  # by how much a grid that is begun while a view zooms is finer, or coarser, than it should be by then
_FINEST = 1.35  # how fine a grid may be, of what the view needs: beyond, its pixels cost more than to trace those of another at once
_MOST = 0.047  # share of the picture's pixels that get rays in a frame, if the view needs no more
_AHEAD = CELL  # pixels beside a view that are traced when something of it is
_SPARE = 12  # pixels beside a view that are drawn with it where nothing but the view moves
_FEW = 4  # stars in a pixel: of a sky that may show more all but the brightest would become a haze
_SINGLE = 0.95  # as for pictures that are shown a little larger: stars that can be seen singly are left to the picture shown


def place_of(scene: Scene) -> Scene:
    """All of `scene` but where its camera looks and how much it shows: frames that have the same only turn and zoom."""
    return replace(scene, camera=replace(scene.camera, yaw_deg=0.0, pitch_deg=0.0, roll_deg=0.0, fov_deg=45.0))


def can_turn(plan: Plan) -> bool:
    """Whether light of a picture by `plan` can be kept by direction: there is nothing in it but a disk and a sky that stands still, and nothing is done to the
    picture that depends on where in it a pixel lies."""
    scene, post = plan.scene, plan.scene.post
    plain = scene.camera.projection == "perspective" and math.isfinite(scene.camera.distance) and post.view == "picture"
    changes = plan.meetings or scene.media or any(kind.traits.changes for kind in chosen(plan, "sky"))
    lines = post.lines_in_plane or post.show_horizon or post.show_sky_grid
    return plain and not changes and not (post.lens or post.beam or lines) and post.colours == "light"


class Turns:
    """Tells which pictures differ from those before by where the camera looks alone.

    Attributes:
        stays: whether the camera of the last picture was where that of the one before was, and nothing else had changed.
    """

    def __init__(self) -> None:
        self.stays = False
        self._last: Scene | None = None
        self._since = _STAYS  # pictures since the last that did

    def turned(self, scene: Scene) -> bool:
        """Whether `scene` does: or one of the last few did."""
        last, self._last = self._last, scene
        self.stays = last is not None and (last is scene or place_of(last) == place_of(scene))
        self._since = _STAYS if not self.stays else self._since + 1 if last == scene else 0
        return self._since < _STAYS


class TurningPass:
    """Draws them.

    Args:
        tables, temperatures: what rays are traced and light is shaded with; they stay their owner's.

    Attributes:
        marched: how many rays have been traced.
    """

    def __init__(self, ctx: moderngl.Context, programs: Programs, tables: Tables, temperatures: TemperatureProfile):
        self._ctx, self._programs = ctx, programs
        self._light_by = tables, temperatures
        self._post = PostPass(ctx, programs)
        self._stars = StarLayer(ctx)
        self.marched = 0
        self._known: KnownLight | None = None
        self._next: KnownLight | None = None  # what is made ready to take its place
        self._frames = 0  # in which another grid is made
        self._extended = 0  # cells, in the last frame
        self._picture: Target | None = None
        self._made: _Made | None = None
        self._shown: tuple[FrameInputs, View] | None = None  # by the last picture

    def draw(
        self, scene: Scene, plan: Plan, time: float, size: tuple[int, int], target: moderngl.Framebuffer, viewport: Box, shown: tuple[int, int] | None
    ) -> bool:
        """Draws the picture of `plan`, which is one of `scene` and `can_turn`, at `time` in `size` pixels into `viewport` (x, y, width, height) of `target`.

        Args:
            shown: as for `Renderer.render`; single stars are then left to `draw_stars`.

        Returns:
            Whether that was done: a view that is too wide is not.
        """
        view = View.of(plan.scene.camera, size)
        known = self._known_for(place_of(scene), plan, time, view, shown)
        if known is None:
            return False
        inputs = known.inputs(plan, time)
        made, self._extended = self._made, 0
        if made is None or not made.serves(known, inputs, view):
            made = self._made = self._make(known, inputs, plan, view)
        self._turn(known, inputs, view, made.box, target, viewport)
        self._shown = inputs, view
        if shown is None:
            self.draw_stars(target, viewport)
        return True

    def draw_stars(self, target: moderngl.Framebuffer, viewport: Box) -> None:
        """Adds the single stars of the last picture, which `viewport` of `target` holds, enlarged or not."""
        known = self._known
        if known is None or self._shown is None or known.finer == 1.0:
            return
        inputs, view = self._shown
        stars, samplers = known.stars(inputs)
        stars.set(to_plane=known.grid.to_plane(view))
        self._stars.draw_listed(stars, {**self._post.samplers, **samplers}, known.light, known.stars_in(view), target, viewport, self._post.glow_window)

    def forget(self) -> None:
        """Gives back what is kept of directions."""
        for known in (self._known, self._next):
            if known is not None:
                known.release()
        self._known = self._next = self._made = self._shown = None

    def release(self) -> None:
        """Gives the GL objects back."""
        self.forget()
        self._post.release()
        self._stars.release()
        if self._picture is not None:
            self._picture.release()
        self._picture = None

    def _known_for(self, key: Scene, plan: Plan, time: float, view: View, shown: tuple[int, int] | None) -> KnownLight | None:
        """What serves `view` of a camera in the place of `key`; None where the view is too wide for a grid."""
        known = self._known
        if known is None or known.key != key:
            self.forget()
            self._known = self._begun(key, plan, view, shown)
            return self._known
        finer = _finer(plan)
        if self._next is not None and not (self._next.grid.holds(view) and 1.0 / _AHEAD_OF_ZOOM**2 < _scale(self._next.grid, view, finer) < _AHEAD_OF_ZOOM**2):
            self._next.release()
            self._next = None
        serves = known.grid.holds(view)
        if not serves:
            serves = self._move(known, plan, time, view)
        scale = _scale(known.grid, view, finer)
        if self._next is None and not (serves and 1.0 / _UNLIKE < scale < _UNLIKE):
            ahead = _AHEAD_OF_ZOOM if scale < 1.0 / _UNLIKE else 1.0 / _AHEAD_OF_ZOOM if scale > _UNLIKE else 1.0
            self._next = self._begun(key, plan, view, shown, ahead)
        if self._next is not None and (self._made_ready(self._next, plan, time, view) or not serves or scale > _FINEST):
            self._take(self._next)
            self._next = None
        return self._known if self._known is not None and self._known.grid.holds(view) else None

    def _move(self, known: KnownLight, plan: Plan, time: float, view: View) -> bool:
        """Has `view` in the middle of a grid with the same pixels; whether there is one."""
        grid = known.grid.moved_to(view)
        if grid is None:
            return False
        known.move(grid, plan, time)
        self._made = None
        return True

    def _take(self, known: KnownLight) -> None:
        if self._known is not None:
            self._known.release()
        self._known, self._made = known, None

    def _begun(self, key: Scene, plan: Plan, view: View, shown: tuple[int, int] | None, ahead: float = 1.0) -> KnownLight | None:
        grid = DirectionGrid.about(plan.scene.camera, view, ahead * _finer(plan), _MARGIN)
        return None if grid is None else KnownLight(self._ctx, self._programs, self._light_by, key, plan, grid, _finer_of_stars(plan.scene, view, shown))

    def _made_ready(self, known: KnownLight, plan: Plan, time: float, view: View) -> bool:
        """Whether all that `view` shows is in `known`, which gets some of it."""
        seen = known.grid.seen(view)
        left = np.argwhere(seen & ~known.cells)
        if not len(left):
            return True
        self._frames += 1
        cells = _cells(view) - self._extended
        if self._frames % 2 and cells > 0:
            away = np.abs(left - np.argwhere(seen).mean(axis=0)) / known.cells.shape
            inner = np.argsort(away.max(axis=1))[:cells]  # of a view that narrows the rest may not be needed
            fresh = np.zeros_like(known.cells)
            fresh[tuple(left[inner].T)] = True
            self._extend(known, known.inputs(plan, time), fresh)
        return False

    def _extend_for(self, known: KnownLight, inputs: FrameInputs, view: View, spare: int) -> int:
        """Traces what `view` shows and `known` lacks, and as much about it as a frame has rays for; returns how many pixels of `spare` ones that is."""
        for spared, ahead in ((spare, _AHEAD), (spare, 0), (0, 0)):
            fresh = known.grid.seen(view, spared + ahead) & ~known.cells
            self._extended = int(np.count_nonzero(fresh))
            if self._extended <= _cells(view) or not known.cells.any():
                break
        known.extend(inputs, fresh)
        return spared

    def _extend(self, known: KnownLight, inputs: FrameInputs, fresh: np.ndarray) -> None:
        before = known.marched
        known.extend(inputs, fresh)
        self.marched += known.marched - before

    def _make(self, known: KnownLight, inputs: FrameInputs, plan: Plan, view: View) -> _Made:
        """The picture of what `view` shows; of a little more where it may serve for the next ones."""
        lasts = kept_light.stands(inputs.plan)
        spare = _SPARE if lasts else 0
        before = known.marched
        seen = known.grid.seen(view, spare)
        if (seen & ~known.cells).any():
            spare = self._extend_for(known, inputs, view, spare)
        known.draw_disk(inputs, seen)
        self.marched += known.marched - before
        x, y, width, height = known.grid.box(view)
        size = self._size_for(width + 2 * spare, height + 2 * spare)
        box = x - spare, y - spare, *size
        self._post.draw_part(inputs.in_picture(plan, size), known.light, box[:2], self._picture_of(size).frame)
        return _Made(known, inputs, box, lasts)

    def _size_for(self, width: int, height: int) -> tuple[int, int]:
        """Of the picture, with room for so many pixels: what depends on its size stays as long as it is not much too large."""
        if self._picture is not None:
            size = self._picture.size
            if width <= size[0] and height <= size[1] and width * height > 0.85 * size[0] * size[1]:
                return size
        return _roomy(width), _roomy(height)

    def _picture_of(self, size: tuple[int, int]) -> Target:
        if self._picture is None or self._picture.size != size:
            if self._picture is not None:
                self._picture.release()
            texture = self._ctx.texture(size, 4)
            texture.repeat_x = texture.repeat_y = False
            self._picture = Target.of(self._ctx, [texture])
        return self._picture

    def _turn(self, known: KnownLight, inputs: FrameInputs, view: View, box: Box, target: moderngl.Framebuffer, viewport: Box) -> None:
        """Filters the picture of `box` into that of `view`."""
        turned = self._programs.get("turned.frag", inputs)
        turned.sample({"around": self._picture_of(box[2:]).texture})
        around, place = known.grid.from_plane(view, box)
        width, height = viewport[2:]
        columns, rows = -(-width // view.mesh_side), -(-height // view.mesh_side)
        turned.set(from_plane=around, around_place=place, columns=columns, quad=(2.0 * view.mesh_side / width, 2.0 * view.mesh_side / height))
        target.use()
        outer, target.viewport = target.viewport, viewport
        turned.draw_mesh(columns, rows)
        target.viewport = outer


@dataclass(frozen=True, eq=False)
class _Made:
    """The picture of a `box` of what is `known`, as `inputs` have it; `lasts`: at any time."""

    known: KnownLight
    inputs: FrameInputs
    box: Box
    lasts: bool

    def serves(self, known: KnownLight, inputs: FrameInputs, view: View) -> bool:
        """Whether it holds what `view` shows of `known`, by `inputs`."""
        if known is not self.known or inputs.plan != self.inputs.plan or not (self.lasts or inputs.time == self.inputs.time):
            return False
        (x, y, width, height), (left, low, *sides) = known.grid.box(view), self.box
        inside = x >= left and y >= low and x + width <= left + sides[0] and y + height <= low + sides[1]
        return inside and not (known.grid.seen(view) & ~known.cells).any()


def _cells(view: View) -> int:
    """How many may get rays in a frame."""
    return int(_MOST * view.size[0] * view.size[1]) // CELL**2


def _finer(plan: Plan) -> float:
    return _FINER_LASTING if kept_light.stands(plan) else _FINER


def _scale(grid: DirectionGrid, view: View, finer: float) -> float:
    """How fine the pixels of `grid` are, of what they should be for `view`."""
    return view.pixel / (finer * grid.pixel)


def _finer_of_stars(scene: Scene, view: View, shown: tuple[int, int] | None) -> float:
    """Side of a pixel shown over the grid's, for its stars: 1 where they are drawn with the rest."""
    if shown is not None:
        return view.size[1] / shown[1]
    return _SINGLE if 0 < stars_a_pixel(scene) <= _FEW else 1.0


def _roomy(side: int) -> int:
    """`side` in pixels rounded up to whole sixteens, and to no power of two (docs/llvmpipe.md)."""
    whole = -(-(side + 2) // 16) * 16
    return whole + 16 if whole & (whole - 1) == 0 else whole
