"""Which grid of directions a view that turns or zooms is to have next: how wide its pixels are, and where its equator goes.

A grid is right when its pixels are as wide as the view's, and the view lies about its equator. Rays of another are traced beside what the view takes of the one
that it has, so many a frame; so it is begun while that one still serves, where the view goes to, and as fine as there are frames left to make it.
"""

from __future__ import annotations

import math

from ..planning import Plan
from ..scene import Camera
from . import kept_light
from .direction_grid import DirectionGrid, View

MOST = 0.042
"""Share of a picture's pixels that get rays in a frame, if the view needs no more."""

COARSE = 2.0
"""Pixels of the first grid of a movement to those of the view, along each axis."""

BESIDE = 64
"""Pixels that a grid has on each side of a view, but about the poles."""

ZOOMS = 1e-3
"""Change of a view's pixel from frame to frame from which on it zooms."""

# Pixels of a grid to those of a view, along each axis of its middle; of one whose picture is not made in every frame, and which shows all of its stars.
_FINER, _FINER_LASTING = 1.0, 1.2
_UNLIKE = 1.05  # change of a view's pixel from which on another grid is begun
_AHEAD_IN = 0.8  # pixels of a grid that is begun while a view zooms in, ahead of it, to those of the view

# A view that zooms out gets a grid with pixels as wide as its own so many frames later, no more than `_MOST_OUT` times as wide as they are; the wider, the
# earlier, as what is new of the view needs ever more of the old one's. One that is coarser than `_SOFT` by then is not waited for to become right, and one that
# holds fewer than so many widths of the view not either.
_FRAMES_OUT, _MOST_OUT, _SOFT, _TIGHT = 70, 2.0, 0.7, 1.3

# A view that turns up or down gets one with its equator where it will be in so many frames, no further than lies well within a grid. Its pixels are the finest
# of these of which all that is seen is there in time, and then lasts until a coarse one is.
_FRAMES_UP, _MOST_UP_DEG = 60, 20.0
_WIDER = 1.0, math.sqrt(2.0), COARSE
_RAYS, _SPARE, _FIRST = 1.15, 1.2, 6  # rays a pixel; frames over those that they take, as a factor, and those in which textures are made
_MUCH = 0.01  # new of the view in each frame, from which on the finest would take half as long again as a frame at rest
_PATIENCE = 100  # frames within which any is to be there
_RESTS = 1e-5  # rad a frame, by which a latitude does not change


def rise_deg(camera: Camera, before: Camera) -> float:
    """By how much the equator of a grid that is begun for `camera`, which comes from `before`, is to lie above it: by less where it turns more to a side, as
    the equator bends away from its way then."""
    up, aside = camera.pitch_deg - before.pitch_deg, abs((camera.yaw_deg - before.yaw_deg + 180.0) % 360.0 - 180.0)
    return min(max(_FRAMES_UP * up, -_MOST_UP_DEG), _MOST_UP_DEG) * min(abs(up) / max(aside, 1e-6), 1.0)


def finer_of(plan: Plan) -> float:
    """Pixels of a grid to those of a view that it is right for."""
    return _FINER_LASTING if kept_light.stands(plan) else _FINER


def scale(grid: DirectionGrid, view: View, finer: float) -> float:
    """How fine the pixels of `grid` are, of what they should be for `view`."""
    return view.pixel / (finer * grid.pixel)


def frames_for(lacking: float, fine: float, known: float, new: float) -> float:
    """In how many frames a grid has all that is seen, of which it is `lacking` so many pixels over those of the view; infinite where it never has.

    Args:
        fine, known: scales of it, and of the one that is seen meanwhile.
        new: share of the view that is new in each frame.
    """
    left = MOST - _RAYS * new * (fine * fine + known * known)
    return _RAYS * lacking / left if left > 0.0 else math.inf


def wanted(grid: DirectionGrid, view: View, before: View, finer: float) -> float | None:
    """The pixels, in those of `view`, that another grid should have; None where `grid` will do for what comes. `before`: the last frame's view."""
    fine, zoom = scale(grid, view, finer), view.pixel / before.pixel
    if zoom > 1.0 + ZOOMS:
        ahead = min(zoom**_FRAMES_OUT, _MOST_OUT)
        soon = ahead**0.6
        if fine > _UNLIKE / ahead**0.2 or grid.size[0] < _TIGHT * grid.box(view)[2]:
            return ahead
        return soon if fine * soon < _SOFT else None
    if zoom < 1.0 - ZOOMS:
        return _AHEAD_IN if fine < 1.0 / _UNLIKE else None
    in_time = (wider for wider in _WIDER[view.new_since(before) > _MUCH :] if _is_in_time(finer / wider, grid, finer * fine, view, before))
    if _leaves(grid, view, before):
        return next(in_time, COARSE)
    if fine > _UNLIKE:
        return 1.0
    wider = next(in_time, COARSE)
    return wider if wider * fine < 1.0 / _UNLIKE else None


def is_late(grid: DirectionGrid, lacking: float, seen: DirectionGrid, view: View, before: View) -> bool:
    """Whether `grid`, which lacks so many pixels over those of `view`, will not have all that is seen before the one that is `seen` has to go, but a coarse one
    would."""
    left, known, new = frames_left(seen, view, before), scale(seen, view, 1.0), view.new_since(before)
    fine, coarse = scale(grid, view, 1.0), 1.0 / COARSE
    return fine > 1.2 * coarse and _frames_to_make(coarse, known, new) < left < frames_for(lacking, fine, known, new)


def frames_left(grid: DirectionGrid, view: View, before: View) -> float:
    """How many more frames, each with as much of latitude as from `before` to `view`, there are before `grid` cannot show the view; infinite where it rests."""
    at = grid.latitude(view)
    step = at - grid.latitude(before)
    return (view.most_latitude - math.copysign(at, at * step)) / abs(step) if abs(step) > _RESTS else math.inf


def _frames_to_make(fine: float, known: float, new: float) -> float:
    """As `frames_for`, of a grid of which there is nothing yet, with some to spare."""
    return _FIRST + _SPARE * frames_for(fine * fine, fine, known, new)


def _is_in_time(fine: float, seen: DirectionGrid, known: float, view: View, before: View) -> bool:
    """Whether a grid as `fine` has all that is seen before the one that is `seen`, as fine as is `known`, has to go; and a coarse one before it has to."""
    new, step = view.new_since(before), abs(seen.latitude(view) - seen.latitude(before))
    takes, then = _frames_to_make(fine, known, new), _frames_to_make(1.0 / COARSE, fine, new)
    ahead = min(math.radians(_MOST_UP_DEG), _FRAMES_UP * step)
    return takes < min(frames_left(seen, view, before), _PATIENCE) and (takes + then) * step < view.most_latitude + ahead


def _leaves(grid: DirectionGrid, view: View, before: View) -> bool:
    """Whether `view` goes away from the equator of `grid`, and is far from it or will soon be."""
    at, was = abs(grid.latitude(view)), abs(grid.latitude(before))
    if not grid.holds(view, BESIDE):
        return True
    return at >= was and (not grid.is_level_with(view) or frames_left(grid, view, before) < _FRAMES_UP)
