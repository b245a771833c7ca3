"""What is worked out bit by bit while the view rests, by a renderer of its own: a plot's numbers."""

from __future__ import annotations

from collections.abc import Callable, Iterator
from typing import Any, Generic, TypeVar

import moderngl

from ..scene import SceneError

_RESTS = 0.4  # seconds of stillness before work on a new view begins

View = TypeVar("View")
Part = TypeVar("Part")


class AtRest(Generic[View, Part]):
    """One bit of work a frame, for the view that is wanted last.

    Args:
        make_renderer: makes the renderer, when it is first needed, so that the picture's hit map is left alone.
        begin: what does the work for a view with that renderer, in parts; one that is None tells nothing new.

    Attributes:
        found: the last part; None before the first, and where the work failed.
        view: what it is of.
        failure: why there is none, in a sentence; else empty.
    """

    def __init__(self, make_renderer: Callable[[moderngl.Context], Any], begin: Callable[[Any, View], Iterator[Part | None]]):
        self._make_renderer, self._begin = make_renderer, begin
        self._renderer: Any = None
        self._parts: Iterator[Part | None] | None = None
        self._since = 0.0
        self.view: View | None = None
        self.found: Part | None = None
        self.failure = ""

    def busy(self, wanted: View) -> bool:
        """Whether there is work left for the view that is `wanted`."""
        return self._parts is not None or self.view != wanted

    def waits(self, now: float) -> None:
        """The view moves, or nobody looks."""
        self._since = now

    def advance(self, gl: moderngl.Context, wanted: View, now: float) -> None:
        """The next part, for the view that is `wanted`. Leaves the context with another framebuffer bound.

        Args:
            now: any clock in seconds.
        """
        try:
            if wanted != self.view and now - self._since >= _RESTS:
                if self._renderer is None:
                    self._renderer = self._make_renderer(gl)
                self.view, self.failure = wanted, ""
                self._parts = self._begin(self._renderer, wanted)
            if self._parts is not None:
                part = next(self._parts)
                self.found = self.found if part is None else part
        except StopIteration:
            self._parts = None
        except SceneError as error:
            self._parts, self.found, self.failure = None, None, str(error)
