"""What may be drawn in a frame while some programs of a scene are still missing: a rehearsal, the scene by an earlier method, or nothing."""

from __future__ import annotations

from dataclasses import dataclass, replace

from .. import planning
from ..physics.space_time import is_inside
from ..scene import Scene
from .preparation import Preparation

# A scene whose programs have not drawn yet is drawn coarse first, whether rays may be interpolated or not: the first draw makes drivers finish
# what compiling began, and takes its time however few the pixels. After that nothing is missing. Each of these says whether rays may be interpolated, and
# whether pixels at edges have several. That with the fewest programs comes first, and is the first picture of a window.
_REHEARSALS = ((False, False), (False, True), (True, True))


@dataclass(frozen=True)
class TracedBy:
    """How a scene was traced: the scene as it was asked for, and with everything chosen that it left to the plan."""

    asked: Scene
    stated: Scene

    @classmethod
    def of(cls, asked: Scene, drawn: Scene) -> TracedBy:
        """That of `asked`, which was drawn as `drawn`."""
        return cls(asked, planning.plan(drawn).scene)

    def stated_in(self, scene: Scene) -> Scene | None:
        """`scene` traced in this way; None unless it is the scene asked for with another camera or hole, and this way can trace it."""
        if replace(scene, camera=self.asked.camera, hole=self.asked.hole) != self.asked:
            return None
        # Another model is taken for another hole or beyond the horizon, which this one may not lead round or through; else as it is cheaper there.
        same_model = planning.plan(scene).scene.rays.model == self.stated.rays.model
        if not same_model and (scene.hole != self.asked.hole or is_inside(scene) != is_inside(self.asked)):
            return None
        return replace(scene, rays=self.stated.rays, parameters=self.stated.parameters)

    def bridges(self, scene: Scene) -> bool:
        """Whether `scene`, some program of which is missing, may be drawn in this way meanwhile: only where it is its method that is new."""
        return self.stated_in(scene) is not None and planning.plan(scene).scene.rays != self.stated.rays


@dataclass(frozen=True)
class Step:
    """What a frame may draw.

    Attributes:
        asked: the scene of the window.
        drawn: the same by the method that it can be drawn with now.
        waits: whether another process is at work for the scene's own method.
        rehearsal: of a rehearsal, whether rays are interpolated; None for a picture.
        is_first: whether it is the first whole picture of a scene, right after its rehearsals.
        deadline: after when no program may be compiled, for ``Programs.deadline``.
        foresees: whether those that only later pictures may need are to be, for ``Programs.foresees``.
    """

    asked: Scene
    drawn: Scene
    waits: bool
    rehearsal: bool | None
    is_first: bool
    deadline: float
    foresees: bool

    @property
    def rehearses(self) -> bool:
        """Whether it is no picture yet."""
        return self.rehearsal is not None


class Readiness:
    """Leads a scene from its missing programs to its first whole picture.

    Args:
        preparation: when programs may be compiled.

    Attributes:
        bridges: whether the picture goes on by an earlier method while the programs of the scene's own are prepared, as where a moving camera
            comes to where the plan takes another.
    """

    def __init__(self, preparation: Preparation):
        self.preparation = preparation
        self.bridges = False
        self._done = 0  # of `_REHEARSALS`, and one more when a whole picture has followed
        self._last: TracedBy | None = None  # the last picture
        self._prepared: TracedBy | None = None  # what the other process was asked for

    @property
    def is_over(self) -> bool:
        """Whether the scene has had its rehearsals and a whole picture after them."""
        return self._done > len(_REHEARSALS)

    def step(self, scene: Scene, now: float) -> Step | None:
        """What to draw of `scene` at `now` [s]; None for nothing, as the last picture is to stay meanwhile."""
        waits = self.preparation.waits(now)
        bridge = self._bridge(scene, waits)
        self.bridges = bridge is not None
        if waits and not self.bridges:
            return None
        rehearsal, edges = _REHEARSALS[self._done] if self._done < len(_REHEARSALS) else (None, True)
        drawn = bridge or (scene if edges else scene.with_values({"rays.edges": 1}))
        is_first, foresees = self._done == len(_REHEARSALS), not self.is_over or self.preparation.since is not None
        return Step(scene, drawn, waits, rehearsal, is_first, self.preparation.deadline(now), foresees)

    def drew(self, step: Step) -> None:
        """What `step` says has been drawn."""
        if not self.is_over:
            self._done += 1
        if self.is_over and not step.waits:
            self._last = TracedBy.of(step.asked, step.drawn)
            self.preparation.over()

    def missed(self, step: Step, size: tuple[int, int], now: float) -> None:
        """A program of what `step` says was missing; the first rehearsal of it will have this `size`."""
        self.preparation.missed(step.asked, size, now)
        if self.is_over and not self.bridges and self._last is not None and self._last.bridges(step.asked):
            self._prepared = TracedBy.of(step.asked, step.asked)
        else:
            self._done = 0

    def failed(self) -> None:
        """It could not be drawn, for another reason."""
        self.preparation.over()

    def _bridge(self, scene: Scene, waits: bool) -> Scene | None:
        """`scene` by the method that it can be drawn with now, while another is prepared: that of the last picture, and then the one asked for, though
        the camera may be where the plan takes a third by then. None where nothing is prepared, or the scene is another one altogether."""
        if self.preparation.since is None or not self.is_over:
            return None
        way = self._last if waits else self._prepared
        return None if way is None else way.stated_in(scene)
