"""Pictures of a camera that only turns or zooms: from light that is kept by direction.

What comes from a direction of the observer's frame does not depend on where he looks. So rays are traced and their sky is shaded on a grid of directions
(known_light.py), square by square as a view first shows them; the disk alone, which turns, is shaded in each frame. The finished picture of what the view shows
of the grid is then filtered into the view's own pixels, and single stars are drawn over it. It is as sharp as a picture that is moved by a part of a pixel: for
frames in motion. One at rest has rays of its own.

The first grid of a movement is coarse, so that its first picture is there soon. One with pixels as wide as the view's takes its place when it has all that is
seen, with some of its rays in each frame; as does another where the view zooms, or leaves the equator of the grid (grid_choice.py).
"""

from __future__ import annotations

import math
from dataclasses import dataclass
from functools import partial

import moderngl
import numpy as np

from ..planning import Plan
from ..scene import Camera, Scene
from ..scene.frozen import changed
from ..shapes import Bool, Int
from . import kept_light
from .boxes import Box, joined
from .direction_grid import CELL, DirectionGrid, View
from .grid_choice import BESIDE, COARSE, MOST, ZOOMS, finer_of, is_late, rise_deg, scale, wanted
from .inputs import FrameInputs
from .known_light import KnownLight
from .post import PostPass
from .programs import Programs
from .star_layer import StarLayer
from .structure import chosen
from .tables import Tables
from .target import Target
from .temperatures import TemperatureProfile
from .uniforms import stars_a_pixel

_STAYS = 4  # pictures of one view that follow one that has turned, before it counts as resting: hands do not turn in every frame

# Widths and heights of a view that a grid holds: of one that turns; that has zoomed in for some frames; and that zooms out, with pixels as wide as the grid's.
_ROOM, _ROOM_IN, _ROOM_OUT = 1.25, 1.12, 1.35
# Share of the picture's pixels that would get rays in a frame, for which a coarse grid is begun instead; and how fine one is of what the view needs, for which
# it is, too.
_LEAP, _COARSEST = 0.2, 0.3
_WORTH, _WORTH_IN, _WORTH_OUT = (0.45, 1.6), (0.7, 1.6), (0.45, 1.0)  # how fine a grid that is being made may be, of what the view needs; while that zooms
_AHEAD = CELL  # pixels beside a view of which none is left out when more of it is traced
_MOVED = 7 * CELL  # pixels that a grid has on each side of a view when it has been moved
_FIRST_OF = 3  # of its width, that a view goes on by, lies the middle of what a grid that is being made gets first
_TOGETHER = 4  # cells along the side of a block of which all are traced, before those of another
_SPARE = 48  # pixels beside a view that are traced before it comes to them, and drawn where nothing but the view moves
_FEW = 4  # stars in a pixel: of a sky that may show more all but the brightest would become a haze
_SINGLE = 0.95  # as for pictures that are shown a little larger: stars that can be seen singly are left to the picture shown


def place_of(scene: Scene) -> Scene:
    """All of `scene` but where its camera looks and how much it shows: frames that have the same only turn and zoom."""
    return changed(scene, camera=changed(scene.camera, yaw_deg=0.0, pitch_deg=0.0, roll_deg=0.0, fov_deg=45.0))


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
        last: the scene of the last picture.
        stays: whether the camera of the last picture was where that of the one before was, and nothing else had changed.
    """

    def __init__(self) -> None:
        self.stays = False
        self.last: Scene | None = None
        self._place: Scene | None = None  # of that
        self._since: int | None = None  # pictures since the last that did; None where none has in this place

    def turned(self, scene: Scene) -> bool:
        """Whether `scene` does: or one of the last few did."""
        last, place = self.last, self._place_of(scene)
        self.stays, self.last, self._place = place == self._place, scene, place
        since = self._since if self.stays else None
        self._since = 0 if self.stays and last != scene else None if since is None else since + 1
        return self._since is not None and self._since < _STAYS

    def would_turn(self, scene: Scene) -> bool:
        """Whether `scene` is of a place in which the camera turns, or has turned."""
        return self._place_of(scene) == self._place and (self._since is not None or self.last != scene)

    def _place_of(self, scene: Scene) -> Scene:
        return self._place if scene is self.last and self._place is not None else place_of(scene)


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
        self._makes = False  # whether that lacks any of what is seen
        self._extended = 0  # cells, in the last frame
        self._picture: Target | None = None
        self._made: _Made | None = None
        self._shown: tuple[FrameInputs, View] | None = None  # by the last picture

    @property
    def prepares(self) -> bool:
        """Whether another grid is being made, so that what a picture takes says little of others."""
        return self._makes

    def draw(
        self,
        scene: Scene,
        plan: Plan,
        time: float,
        size: tuple[int, int],
        target: moderngl.Framebuffer,
        viewport: Box,
        *,
        shown: tuple[int, int] | None,
        before: Scene,
    ) -> bool:
        """Draws the picture of `plan`, which is one of `scene` and `can_turn`, at `time` in `size` pixels into `viewport` (x, y, width, height) of `target`.

        Args:
            shown: as for `Renderer.render`; single stars are then left to `draw_stars`.
            before: of the last picture, of whichever kind.

        Returns:
            Whether that was done: a view that is too wide is not.

        Raises:
            Unready: a program is missing; nothing has been drawn.
        """
        view = View.of(plan.scene.camera, size)
        known = self._known_for(place_of(scene), plan, time, view, shown, before.camera)
        if known is None:
            return False
        self._makes = self._next is not None and self._lacks(self._next, view) > 0
        inputs = known.inputs(plan, time)
        if not known.cells.any():
            known.require(inputs)
        coming = view if self._shown is None else view.going_on(self._shown[1], _SPARE)
        made, self._extended = self._made, 0
        if made is None or not made.serves(known, inputs, view):
            made = self._made = self._make(known, inputs, plan, view, coming)
        elif self._is_short(known, view, coming):  # the picture stands: there is time to look ahead
            self._extend_for(known, inputs, view, coming)
        self._turn(known, inputs, view, made.box, target, viewport)
        if self._next is not None:
            middle = view if self._shown is None else view.going_on(self._shown[1], view.size[0] // _FIRST_OF)
            self._extend_next(self._next, plan, time, view, middle)
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
        self._makes = False

    def release(self) -> None:
        """Gives the GL objects back."""
        self.forget()
        self._post.release()
        self._stars.release()
        if self._picture is not None:
            self._picture.release()
        self._picture = None

    def _known_for(self, key: Scene, plan: Plan, time: float, view: View, shown: tuple[int, int] | None, last: Camera) -> KnownLight | None:
        """What serves `view`, which comes after that of the camera `last` in the place of `key`; None where it is too wide for a grid."""
        before, finer, begun = View.of(last, view.size), finer_of(plan), partial(self._begun, key, plan, view, shown, last)
        if self._known is not None and not self._known.serves(key, plan, time):
            self.forget()
        if self._next is not None and not self._is_worth(self._next, view, before, finer):
            self._next = self._given_back(self._next)
        serves = self._known is not None and self._serves(self._known, view, finer)
        if self._next is not None and self._is_due(self._next, view, before, finer, serves):
            self._take(self._next)
            self._next = None
        elif not serves:
            self._take(begun(COARSE))
        if self._known is not None and self._next is None and plan.scene.camera != last:
            wider = wanted(self._known.grid, view, before, finer)
            self._next = None if wider is None else begun(wider)
        return self._known

    def _is_worth(self, known: KnownLight, view: View, before: View, finer: float) -> bool:
        """Whether what is `known` is to be made ready for `view`, which comes after `before`: it holds that, is about as fine, and will be there in time."""
        zoom = view.pixel / before.pixel
        low, high = _WORTH_OUT if zoom > 1.0 + ZOOMS else _WORTH_IN if zoom < 1.0 - ZOOMS else _WORTH
        if not (self._follow(known, view) and low < scale(known.grid, view, finer) < high):
            return False
        lacking = self._lacks(known, view) / (view.size[0] * view.size[1])
        return self._known is None or not is_late(known.grid, lacking, self._known.grid, view, before)

    def _is_due(self, known: KnownLight, view: View, before: View, finer: float, serves: bool) -> bool:
        """Whether what is `known` is to take the place of what is seen, which `serves` or not: where that does, all that `view` shows is to be there, and one
        that is coarser waits, unless the view zooms out."""
        if not serves:
            return self._serves(known, view, finer)
        fine = scale(known.grid, view, finer)
        waits = self._known is not None and view.pixel <= before.pixel * (1.0 + ZOOMS) and fine < min(0.95, 0.95 * scale(self._known.grid, view, finer))
        return not waits and not self._lacks(known, view)

    def _serves(self, known: KnownLight, view: View, finer: float) -> bool:
        """Whether what is `known` will do for `view`: it holds that, has most of it, and is not far coarser than it."""
        if not self._follow(known, view) or scale(known.grid, view, finer) < _COARSEST:
            return False
        return self._lacks(known, view) <= _LEAP * view.size[0] * view.size[1]

    def _follow(self, known: KnownLight, view: View) -> bool:
        """Moves the grid of what is `known` where it has to be moved for `view`; whether it holds that."""
        if known.grid.holds(view, BESIDE):
            return True
        moved = known.grid.moved_to(view, _MOVED)
        if moved is None:
            return known.grid.holds(view)
        if moved[0].corner != known.grid.corner or moved[0].start != known.grid.start:
            known.move(*moved)
            self._made = None if known is self._known else self._made
        return True

    def _take(self, known: KnownLight | None) -> None:
        self._given_back(self._known)
        self._known, self._made = known, None

    def _given_back(self, known: KnownLight | None) -> None:
        if known is not None:
            known.release()

    def _begun(self, key: Scene, plan: Plan, view: View, shown: tuple[int, int] | None, last: Camera, wider: float) -> KnownLight | None:
        """With pixels so many times as wide as the view needs."""
        camera = plan.scene.camera
        room = _ROOM_OUT * wider if view.pixel > View.of(last, view.size).pixel * (1.0 + ZOOMS) else _ROOM_IN if wider < 1.0 else _ROOM
        about = partial(DirectionGrid.about, camera, view, finer_of(plan) / wider, 0.5 * (room - 1.0), _MOVED + CELL)
        grid = about(rise_deg(camera, last)) or about()  # a wide view has none but about itself
        return None if grid is None else KnownLight(self._ctx, self._programs, self._light_by, key, plan, grid, _finer_of_stars(plan.scene, view, shown, grid))

    def _lacks(self, known: KnownLight, view: View) -> int:
        """How many pixels `known` lacks of what `view` shows."""
        return CELL**2 * int(np.count_nonzero(known.grid.seen(view) & ~known.cells))

    def _is_short(self, known: KnownLight, view: View, coming: View) -> bool:
        """Whether `known` lacks any of what `view` shows; or of what is just beside that or `coming`, unless rays are wanted for another grid, as to trace for
        both in one frame takes longer."""
        seen = known.grid.seen(view) if self._makes else known.grid.seen(view, _AHEAD) | known.grid.seen(coming)
        return bool((seen & ~known.cells).any())

    def _extend_next(self, known: KnownLight, plan: Plan, time: float, view: View, coming: View) -> None:
        """Traces as much of what `view` shows, and of what is beside it, and `known` lacks as the frame has rays left for, from the middle of what is `coming`
        outwards, as the rest is soon seen no more, and in blocks: what is beside new cells is looked at, too."""
        seen = known.grid.seen(view, _AHEAD)
        left = np.argwhere(seen & ~known.cells)
        cells = _cells(view, known) - self._extended
        if len(left) and cells > self._extended:
            shown = known.grid.seen(view)[tuple(left.T)]
            blocks = left // _TOGETHER
            middles = np.minimum(_TOGETHER * blocks + _TOGETHER // 2, np.array(seen.shape) - 1)
            inner = np.lexsort((*blocks.T, -known.grid.ahead(coming)[tuple(middles.T)], ~shown))[:cells]
            inputs = known.inputs(plan, time)
            if known.prepare(inputs):
                self._extend(known, inputs, _marked(left[inner], seen.shape))

    def _extend_for(self, known: KnownLight, inputs: FrameInputs, view: View, coming: View) -> None:
        """Traces what `view` shows and `known` lacks, and as much of what is beside it, and of what is `coming`, as the frame has rays for."""
        grid, most, fresh = known.grid, _cells(view, known), np.zeros_like(known.cells)
        shown = grid.seen(view)
        for seen in (shown, grid.seen(view, _AHEAD), grid.seen(coming, 0 if self._next is not None else 2 * _AHEAD)):
            left = np.argwhere(seen & ~known.cells & ~fresh)
            if seen is not shown:
                left = left[: max(most - self._extended, 0)]
            fresh |= _marked(left, fresh.shape)
            self._extended = int(np.count_nonzero(fresh))
        self._extend(known, inputs, fresh)

    def _extend(self, known: KnownLight, inputs: FrameInputs, fresh: np.ndarray) -> None:
        before = known.marched
        known.extend(inputs, fresh)
        self.marched += known.marched - before

    def _make(self, known: KnownLight, inputs: FrameInputs, plan: Plan, view: View, coming: View) -> _Made:
        """The picture of what `view` shows; of what is `coming`, too, where it may serve for that."""
        lasts = kept_light.stands(inputs.plan)
        if self._is_short(known, view, coming):
            self._extend_for(known, inputs, view, coming)
        before = known.marched
        known.draw_disk(inputs, known.grid.seen(view))
        self.marched += known.marched - before
        x, y, width, height = joined(known.grid.box(view), known.grid.box(coming)) if lasts else known.grid.box(view)
        size = self._size_for(width, height)
        box = x, y, *size
        corner = box[0] + inputs.start[0], box[1] + inputs.start[1]
        self._post.draw_part(inputs.in_picture(plan, size), known.light, corner, self._picture_of(size).frame)
        return _Made(known, inputs, box, known.cells, lasts)

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
    """The picture of a `box` of what is `known`, as `inputs` have it, with those `cells`; `lasts`: at any time."""

    known: KnownLight
    inputs: FrameInputs
    box: Box
    cells: Bool[np.ndarray, "rows columns"]
    lasts: bool

    def serves(self, known: KnownLight, inputs: FrameInputs, view: View) -> bool:
        """Whether it holds what `view` shows of `known`, by `inputs`."""
        if known is not self.known or inputs.plan != self.inputs.plan or not (self.lasts or inputs.time == self.inputs.time):
            return False
        (x, y, width, height), (left, low, *sides) = known.grid.box(view), self.box
        inside = x >= left and y >= low and x + width <= left + sides[0] and y + height <= low + sides[1]
        return inside and not (known.grid.seen(view) & ~self.cells).any()


def _cells(view: View, known: KnownLight) -> int:
    """How many may get rays in a frame."""
    return int(MOST * view.size[0] * view.size[1] / known.rays_a_pixel) // CELL**2


def _finer_of_stars(scene: Scene, view: View, shown: tuple[int, int] | None, grid: DirectionGrid) -> float:
    """Side of a pixel shown over the grid's, for its stars: 1 where they are drawn with the rest."""
    stars, enlarged = stars_a_pixel(scene), view.size[1] / shown[1] if shown is not None else 1.0
    if stars > _FEW:
        return enlarged
    return min(enlarged * view.pixel / grid.pixel, _SINGLE) if stars else 1.0


def _marked(cells: Int[np.ndarray, "cells 2"], shape: tuple[int, ...]) -> Bool[np.ndarray, "rows columns"]:
    """Those at the rows and columns `cells`."""
    marked = np.zeros(shape, bool)
    marked[tuple(cells.T)] = True
    return marked


def _roomy(side: int) -> int:
    """`side` in pixels rounded up to whole sixteens, and to no power of two (docs/llvmpipe.md)."""
    whole = -(-(side + 2) // 16) * 16
    return whole + 16 if whole & (whole - 1) == 0 else whole
