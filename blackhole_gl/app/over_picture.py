"""What stands over the picture: figures, directions, clocks, labels, values under the mouse, the scale of a view, messages, and the line of the start."""

from __future__ import annotations

from ..scene import Scene
from . import overlay, view_scale
from .area import FreePart
from .flight_overlay import FlightOverlay
from .label_overlay import LabelOverlay
from .mouse_values import MouseValues
from .picture import Picture
from .start_line import StartLine
from .state import WindowState

_MARGIN = 0.6  # ems that it keeps from the picture's edges


class OverPicture:
    """All of it, kept from frame to frame where it moves with the picture.

    Args:
        scene: the first scene.
        help_key: what opens the help, as the line of the start names it.

    Attributes:
        start_line: how to move and where help is, until somebody has moved.
        labels: those of the picture.
    """

    def __init__(self, scene: Scene, help_key: str):
        self.start_line = StartLine(scene, help_key)
        self.labels = LabelOverlay()
        self._mouse_values = MouseValues()
        self._flown = FlightOverlay()

    def draw(self, state: WindowState, picture: Picture, view: FreePart, em: float, *, start_line: bool) -> float:
        """Draws it into the `view` of the `picture`; where its foot ends, below which the view's scale stands, in imgui's units.

        Args:
            em: a letter's size.
            start_line: whether the user wants the line of the start.
        """
        margin = _MARGIN * em
        left, right, top, bottom = view.left + margin, view.left + view.width - margin, view.top + margin, view.top + view.height - margin
        left_top, size, middle = (view.left, view.top), (view.width, view.height), view.left + 0.5 * view.width
        figures, directions = overlay.figures(state, picture, (left, top)), overlay.directions(state, (right, top))
        self._mouse_values.frame(state, picture, left_top, size)
        beside = max((box[2] - box[0] for box in (figures, directions) if box), default=0.0) + 2.0 * margin
        below = (directions[3] if directions else view.top) + margin
        flown = self._flown.draw(state, (right, below), (middle, top), max(view.width - 2.0 * beside, 12.0 * em))
        self.labels.draw(state, left_top, size, filter(None, (figures, directions, *flown)))
        colours = picture.renderer.view_of(picture.shown) if picture.shown is not None else None
        foot = view_scale.draw(colours, (right, bottom), max(right - left, 1.0))
        overlay.messages(state, picture, (left, bottom), max(right - left, 10.0 * em))
        if start_line:
            self.start_line.draw(state.scene, middle, view.top + view.height - 4.0 * em, view.width - 2.0 * em)
        return foot
