"""What was, for undo and redo: moments of the window, a step between two of them for each gesture. Scenes are frozen, so that keeping them is cheap."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, replace

from ..scene import Scene

LONGEST = 200
"""Steps kept; the oldest go."""


@dataclass(frozen=True)
class Moment:
    """What a step leads from or to: the scene, what the presets in force say, and their names by group."""

    scene: Scene
    home: Scene
    chosen: Mapping[str, str]


@dataclass(frozen=True)
class History:
    """The moment that counts as now, those before it (the last one last), and those undone (the next one last)."""

    present: Moment
    past: tuple[Moment, ...] = ()
    future: tuple[Moment, ...] = ()

    def followed_by(self, moment: Moment) -> History:
        """With a step to `moment`, which ends what could be redone; this history where nothing has changed."""
        if moment == self.present:
            return self
        return History(moment, (*self.past, self.present)[-LONGEST:])

    def undone(self) -> History:
        """A step back; this history where there is none."""
        if not self.past:
            return self
        return replace(self, present=self.past[-1], past=self.past[:-1], future=(*self.future, self.present))

    def redone(self) -> History:
        """A step forward again; this history where there is none."""
        if not self.future:
            return self
        return replace(self, present=self.future[-1], past=(*self.past, self.present), future=self.future[:-1])
