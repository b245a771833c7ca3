"""The picture behind the panel: rendered only when something changed, kept, and drawn into the free part of the window."""

from __future__ import annotations

import contextlib
import time as clock
from dataclasses import dataclass
from typing import Any

import moderngl
import numpy as np

from ..rendering.programs import Unready
from ..scene import Scene
from .adaptation import Adaptation
from .area import Area
from .pace import Pace
from .preparation import Preparation
from .readiness import Readiness, Step
from .resolution import COARSEST
from .sharpening import Sharpening
from .targets import Drawing, Targets


@dataclass(frozen=True)
class RayFigures:
    """What became of the picture's rays: mean steps of a ray, and how many ended nowhere."""

    steps: float
    unresolved: int

    @classmethod
    def of(cls, fate: np.ndarray, steps: np.ndarray) -> RayFigures:
        """The figures of rays by what became of them, as in `HitArrays`, and the steps they took."""
        return cls(float(np.mean(steps)), int(np.count_nonzero(fate == 0)))


class Picture:
    """Renders a scene, and draws the picture into the window. What it is drawn into is for `Targets`, which programs are there for `Readiness`, how
    coarse it is while it moves for `Pace`, and how many rays a pixel it takes at rest for `Sharpening`.

    Args:
        gl: the window's context.
        renderer: what makes pictures; see ``rendering.frame.Renderer``.
        preparation: when programs may be compiled.

    Attributes:
        report: of the last picture rendered, a ``rendering.frame_report.FrameReport``; None before the first.
        shown: the scene of that picture, which may lag behind that of the last `update`.
        rays: what became of its rays, as of the last `count_rays`.
        scale: width and height of the last picture over those of its area.
    """

    def __init__(self, gl: moderngl.Context, renderer: Any, preparation: Preparation):
        self.renderer = renderer
        self.report: Any = None
        self.shown: Scene | None = None
        self.rays: RayFigures | None = None
        self.scale = 1.0
        self._targets = Targets(gl, renderer)
        self._readiness = Readiness(preparation)
        self._pace = Pace()
        self._sharpening = Sharpening()
        self._adaptation = renderer.exposure.adaptation = Adaptation()
        self._made_of: Drawing | None = None
        self._rays_stale = True

    @property
    def preparation(self) -> Preparation:
        """When programs may be compiled."""
        return self._readiness.preparation

    @property
    def bridges(self) -> bool:
        """Whether the picture goes on by an earlier method while the programs of the scene's own are prepared."""
        return self._readiness.bridges

    @property
    def samples(self) -> int:
        """Rays a pixel that the last picture is the mean of."""
        return self._sharpening.samples

    @property
    def is_current(self) -> bool:
        """Whether the picture is of the scene of the last `update`, and neither an earlier one nor a rehearsal, nor by another method."""
        return self._readiness.is_over and not self.bridges

    @property
    def is_sharp(self) -> bool:
        """Whether every pixel shown has a ray of its own; after a movement that takes some more calls of `update`."""
        return self.report is None or self.report.sharp

    @property
    def is_settled(self) -> bool:
        """Whether the picture has the exposure that it is to keep."""
        return self.report is None or self.report.settled

    @property
    def is_final(self) -> bool:
        """Whether further calls of `update` for the same would draw nothing."""
        return self.is_current and self.is_sharp and self.is_settled and self._sharpening.is_done

    def forget(self) -> None:
        """Makes the next `update` render, whatever it is given."""
        self._made_of = None

    def update(
        self, scene: Scene, time: float, area: Area, *, moving: bool, camera_moving: bool, exact: bool = False, window: moderngl.Framebuffer | None = None
    ) -> bool:
        """Renders when anything that shows has changed. `draw` is to follow.

        Args:
            time: scene time in r_s/c.
            moving: whether the next frame will differ; a picture too costly for the scene's frame rate is then drawn coarser.
            camera_moving: whether rays have to be traced anew, which costs more than shading; some pixels are then interpolated between rays.
            exact: make the picture sharp at once.
            window: where a picture that moves may be drawn at once.

        Returns:
            Whether a picture was rendered that is to be shown.
        """
        now = clock.perf_counter()
        self._targets.begin_frame()
        step = self._readiness.step(scene, now)
        if step is None:
            return False
        turns = camera_moving and self.is_current and self.renderer.turns(scene)
        scale = COARSEST if step.rehearses else self._pace.scale(scene.playback, now, moving=moving, camera_moving=camera_moving, turns=turns)
        progressive = step.rehearsal
        if progressive is None:
            progressive = camera_moving or not (exact or self.is_current and self.is_sharp)
        drawing = Drawing(step.drawn, time, area.scaled(scale), area.size, progressive, passes=moving and not camera_moving)
        if exact:
            self._adaptation.forget()
        if drawing == self._made_of and self.is_sharp and self.is_settled and not step.rehearses:
            return self._improve(drawing)
        passes_by = moving and self._readiness.is_over
        report = self._render(step, drawing, area, window if passes_by else None, now)
        return report is not None and self._take(report, step, scale)

    def draw(self, window: moderngl.Framebuffer, area: Area) -> None:
        """Fills `area` of `window` with the picture, and the rest with black."""
        self._targets.draw(window, area)

    def draw_part(self, window: moderngl.Framebuffer, area: Area, part: Area) -> None:
        """Puts that `part` of the picture in `area` over what `window` holds."""
        self._targets.draw_part(window, area, part)

    def count_rays(self) -> None:
        """Brings `rays` up to date with the hit map. A part of it is read back, so this is for frames in which no rays are traced."""
        if self._rays_stale and self._readiness.is_over and self.is_sharp:
            self.rays = RayFigures.of(*self.renderer.fates_and_steps())
            self._rays_stale = False

    def read_rgb8(self) -> np.ndarray:
        """The picture as uint8 (height, width, 3), top row first."""
        return self._targets.read_rgb8()

    def _improve(self, drawing: Drawing) -> bool:
        """Goes on with a picture in which nothing changes any more. Returns whether there was anything to draw."""
        self._pace.pause()
        return self._keep() or self._sharpening.take(lambda: self._targets.render_finer(drawing))

    def _keep(self) -> bool:
        """Draws the last picture into the texture, if only the window has it. Returns whether it was drawn."""
        report = self._targets.keep()
        if report is None:
            return False
        self.report = report
        return True

    def _keep_if_possible(self) -> None:
        """For when the next picture failed, which is what is to be told."""
        with contextlib.suppress(Exception):
            self._keep()

    def _render(self, step: Step, drawing: Drawing, area: Area, window: moderngl.Framebuffer | None, now: float) -> Any:
        """A picture of what has changed, drawn into `window` if there is one; returns its report, None where a program is missing."""
        # Remembered before rendering: what fails is not tried again until something changes.
        self._made_of = drawing
        self._sharpening.forget()
        if step.rehearses:
            self.renderer.hit_map.forget()
        self.renderer.programs.deadline, self.renderer.programs.foresees = step.deadline, step.foresees
        try:
            if step.rehearses:
                return self._targets.rehearse(drawing)
            return self._targets.render(drawing) if window is None else self._targets.render_into(window, area, drawing)
        except Unready:
            self.renderer.hit_map.forget()  # it may be half drawn
            self._made_of = None
            self._keep_if_possible()
            self._readiness.missed(step, area.scaled(COARSEST), now)
            return None
        except Exception:
            self._readiness.failed()
            self._keep_if_possible()
            raise

    def _take(self, report: Any, step: Step, scale: float) -> bool:
        """Takes in what the picture of `step` turned out as, and what it means for those to come. Returns whether it is shown."""
        if self.report is not None:  # else it is the first picture, drawn with the fewest programs: its rehearsal follows
            self._readiness.drew(step)
        self._rays_stale |= report.traced
        if step.rehearses:
            self._pace.pause()
            self._made_of = None
            if self.report is not None:
                return False
        else:
            if step.is_first:
                self._pace.forget()
            self._pace.learn(report, scale)
        self.report, self.shown, self.scale = report, step.drawn, scale
        self._sharpening.begin(step.drawn)
        return True
