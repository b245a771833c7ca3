"""Which squares of a picture may show anything of given balls in space: what has to be traced where things are, or where one has moved."""

from __future__ import annotations

from dataclasses import dataclass

import moderngl
import numpy as np

from ..physics import motion
from ..plan import REACH_STEP, Plan
from ..scene import met
from ..shapes import Float
from .inputs import FrameInputs
from .programs import RAY_SLOTS, Programs, chosen
from .squares import Squares
from .tables import Tables
from .target import Target

MOST_BALLS = 24
"""Balls that rays are held against; more are put together in larger ones."""

ALONE = {"ORDERS": 0, "MEETINGS": 0}
"""The switches of rays that end on nothing and look for no crossing."""

# Rays end where they leave this shell: horizon radii, and r_s about a hole of strength 1, outside which none turns back.
_INNERMOST, _OUTERMOST = 1.02, 3.0


@dataclass(frozen=True, eq=False)
class _Made:
    """Of a picture's size: the nodes, and for each cell between them whether it is near, R8."""

    size: tuple[int, int]
    nodes: Target
    cells: Target

    def release(self) -> None:
        self.nodes.release()
        self.cells.release()


class Reach:
    """Draws shaders/reach_*.frag.

    Args:
        tables: what rays are traced with; they stay their owner's.
    """

    def __init__(self, ctx: moderngl.Context, programs: Programs, tables: Tables):
        self._ctx, self._programs, self._tables = ctx, programs, tables
        self._made: _Made | None = None
        self._balls: moderngl.Texture | None = None

    def draw(self, inputs: FrameInputs, balls: Float[np.ndarray, "balls 4"]) -> moderngl.Texture:
        """R8, 1 for each square of ``REACH_STEP``² pixels that may show anything within `balls`, centre and radius each in r_s in the plan's frame."""
        made = self._targets(inputs.size)
        nodes = self._programs.get("reach_nodes.frag", inputs, ALONE)
        few = gathered(balls, MOST_BALLS)
        self._tables.bind(nodes, chosen(inputs.plan, *RAY_SLOTS), {"reach_balls": self._table(few)})
        nodes.set(reach_count=len(few), reach_steps=inputs.plan.reach_steps, reach_radii=_shell(inputs.plan))
        made.nodes.frame.use()
        nodes.draw()
        cells = self._programs.get("reach_cells.frag", inputs)
        cells.sample({"nodes": made.nodes.texture})
        made.cells.frame.use()
        cells.draw()
        return made.cells.texture

    def squares(self, inputs: FrameInputs, balls: Float[np.ndarray, "balls 4"]) -> Squares:
        """Those squares, listed. Waits for the GPU."""
        texture = self.draw(inputs, balls)
        found = np.frombuffer(texture.read(alignment=1), np.uint8).reshape(texture.height, texture.width)
        rows, columns = np.nonzero(found)
        return Squares.of(np.stack([columns, rows], axis=-1), REACH_STEP, inputs.size)

    def release(self) -> None:
        """Gives the GL objects back."""
        for item in (self._made, self._balls):
            if item is not None:
                item.release()
        self._made = self._balls = None

    def _targets(self, size: tuple[int, int]) -> _Made:
        if self._made is None or self._made.size != size:
            if self._made is not None:
                self._made.release()
            cells = -(-size[0] // REACH_STEP), -(-size[1] // REACH_STEP)
            self._made = _Made(size, self._target((cells[0] + 1, cells[1] + 1), 1, "f4"), self._target(cells, 1, "f1"))
        return self._made

    def _target(self, size: tuple[int, int], components: int, dtype: str) -> Target:
        texture = self._ctx.texture(size, components, dtype=dtype, alignment=1)
        texture.filter = moderngl.NEAREST, moderngl.NEAREST
        texture.repeat_x = texture.repeat_y = False
        return Target.of(self._ctx, [texture])

    def _table(self, balls: Float[np.ndarray, "balls 4"]) -> moderngl.Texture:
        if self._balls is None:
            self._balls = self._ctx.texture((MOST_BALLS, 1), 4, dtype="f4")
            self._balls.filter = moderngl.NEAREST, moderngl.NEAREST
        self._balls.write(balls.astype(np.float32).tobytes(), (0, 0, len(balls), 1))
        return self._balls


def balls(plan: Plan, time: float) -> Float[np.ndarray, "balls 4"]:
    """A ball about each thing and medium of the plan's scene at scene time `time`, in the order of `instances.key`: centre and radius in r_s."""
    return np.concatenate([motion.rows(plan.scene, slot, plan.space_time, time)[:, 0] for slot in met.SLOTS])


def _shell(plan: Plan) -> tuple[float, float]:
    return _INNERMOST * plan.space_time.horizon_radius, max(_OUTERMOST * plan.scene.hole.gravity_strength, plan.reach)


def gathered(balls: Float[np.ndarray, "balls 4"], most: int) -> Float[np.ndarray, "balls 4"]:
    """At most `most` balls that hold all of `balls`, centre and radius each: the widest lot is parted across its longer side until there are so many."""
    if len(balls) <= most:
        return balls
    lots = [balls]
    while len(lots) < most:
        widest = max((k for k in range(len(lots)) if len(lots[k]) > 1), key=lambda k: _held(lots[k])[3])
        lot = lots.pop(widest)
        order = np.argsort(lot[:, np.argmax(np.ptp(lot[:, :3], axis=0))])
        lots += [lot[order[: len(lot) // 2]], lot[order[len(lot) // 2 :]]]
    return np.array([_held(lot) for lot in lots])


def _held(lot: Float[np.ndarray, "balls 4"]) -> Float[np.ndarray, " 4"]:
    """A ball that holds all of `lot`."""
    centre = 0.5 * (lot[:, :3].min(axis=0) + lot[:, :3].max(axis=0))
    return np.append(centre, np.max(np.linalg.norm(lot[:, :3] - centre, axis=1) + lot[:, 3]))
