"""Programs compiled beforehand by another process. Drivers keep on disk what they have compiled, so the window gets them in milliseconds.

Nothing depends on it: where there is no such process or no such cache, the window compiles by itself, some programs a frame.
"""

from __future__ import annotations

import itertools
import time as clock
from concurrent.futures import Future
from functools import cache

from ..rendering.context import create_headless
from ..rendering.frame import Renderer
from ..rendering.target import Target
from ..scene import Scene
from ..worker import Worker

_UNTIL_WRITTEN_S = 0.05  # Mesa hands its cache's files to a thread of its own and offers no way to wait for it


class WarmUp:
    """The other process: one for the window's life, started when first wanted."""

    def __init__(self) -> None:
        self._worker = Worker()

    def start(self) -> None:
        """Starts the process, so that the first `submit` need not wait for it."""
        if not self._worker.is_started:
            self._worker.submit(_renderer)

    def submit(self, scene: Scene, size: tuple[int, int]) -> Future[None]:
        """Has the programs of `scene` compiled by drawing a picture of `size`. The future fails where that process cannot draw.

        Only the first draw makes a driver finish its work, and llvmpipe does so anew for sizes that are powers of two: `size` should be the window's.
        """
        self.start()
        return self._worker.submit(_draw, scene, size)

    def look_ahead(self, scene: Scene, size: tuple[int, int]) -> Future[None]:
        """Has those programs of `scene` compiled that only a view which turns needs: before it does, and nothing need wait for them."""
        self.start()
        return self._worker.submit(_turn, scene, size)

    def close(self) -> None:
        """Ends the process; what it is at is thrown away."""
        self._worker.close()


@cache
def _shared() -> Renderer:
    renderer = Renderer(create_headless())
    renderer.programs.foresees = True
    return renderer


def _renderer() -> None:
    _shared()


def _draw(scene: Scene, size: tuple[int, int]) -> None:
    """Draws `scene` in every way a window does: rays interpolated or not, a sky that is kept or not, stars drawn apart, things that have moved."""
    renderer = _shared()
    shown = 2 * size[0], 2 * size[1]
    enlarged = Target.of(renderer.ctx, [renderer.ctx.texture(shown, 4)])
    for _ in range(2):  # Mesa stores one variant of a program for each time that it is compiled, and some are drawn with in two
        for progressive, time in ((True, 0.0), (True, 1.0), (False, 1.0), (False, 1.0), (False, 2.0)):
            renderer.render(scene, time, size, measure=True, progressive=progressive, glow_may_last=time > 0.0, shown=shown)
            renderer.draw_stars(enlarged.frame, (0, 0, *shown))
        _draw_media(renderer, scene, size)
        renderer.programs.release()
        renderer.hit_map.forget()
    enlarged.release()
    clock.sleep(_UNTIL_WRITTEN_S)


def _turn(scene: Scene, size: tuple[int, int]) -> None:
    """Draws `scene` as its view turns, where that is drawn by programs of its own."""
    renderer = _shared()
    shown = 2 * size[0], 2 * size[1]
    enlarged = Target.of(renderer.ctx, [renderer.ctx.texture(shown, 4)])
    yaw = scene.camera.yaw_deg
    for _ in range(2):
        renderer.render(scene, 0.0, size, progressive=True, shown=shown)
        turned = scene.with_values({"camera.yaw_deg": yaw + 1.0 if yaw < 0.0 else yaw - 1.0})
        if not renderer.turns(turned):
            break
        renderer.render(turned, 0.0, size, progressive=True, shown=shown, may_turn=True)
        renderer.draw_stars(enlarged.frame, (0, 0, *shown))
        renderer.programs.release()
        renderer.hit_map.forget()
    enlarged.release()
    clock.sleep(_UNTIL_WRITTEN_S)


def _draw_media(renderer: Renderer, scene: Scene, size: tuple[int, int]) -> None:
    """Media as a paused picture has them, and by samples along their rays, which are told over some frames."""
    if not scene.media:
        return
    renderer.render(scene, 2.0, size)
    for time in itertools.count(3.0):
        told = not renderer.coarse_transfer.tells
        renderer.render(scene, time, size, glow_may_last=True)
        if told and time > 6.0:  # the grid, and the rays beside it
            break
