"""Which squares of a picture may show anything of given balls in space: what has to be traced where things are, or where one has moved."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import moderngl
import numpy as np

from ..physics import motion, projection
from ..planning import REACH_STEP, REFINE_STEP, Plan, steps_in_motion
from ..scene import met
from ..shapes import Bool, Float, Int
from .boxes import Box
from .classes import EVERYWHERE, Where, drawn
from .inputs import FrameInputs
from .programs import Programs
from .squares import Squares
from .tables import Tables
from .target import Target, plain_texture

MOST_BALLS = 24
"""Balls that rays are held against; more are put together in larger ones."""

# Nodes of the first level across the height of a picture, at least, unless they would be closer than REACH_STEP; twice as many as tests hold to be enough.
_ACROSS = 45

_MARKED = Where(">", 0.5)  # by shaders/reach_marks.frag

ALONE = {"ORDERS": 0, "MEETINGS": 0}
"""The switches of rays that end on nothing and look for no crossing."""

# Rays end where they leave this shell: horizon radii, and r_s about a hole of strength 1, outside which none turns back. That of a field holds its sphere.
_INNERMOST, _OUTERMOST = 1.02, 3.0


# Ways in a field are held against balls in pieces as long as that, r_s, which are cubics; where steps are longer than the plan's, the way bends the less.
_PIECE = 1.6

# What is not linear between four rays that miss a ball, of the margin that each of them has by itself: twice as much as tests hold to be enough where they are
# `_APART` (rad) from each other. It grows as the square of that, the margin as that itself; where they are nearer it is less, but never next to nothing.
_NOT_LINEAR, _BY_ITSELF = 0.3, 1.0
_APART, _LEAST_NOT_LINEAR = 0.02, 0.1

# What is held against where nothing has a size.
_NOWHERE = np.array([(1e9, 0.0, 0.0, 0.0)])

# Side of the tiles that llvmpipe's threads take one after another, in texels.
_TILE = 64

FINER = {"REACH_FINER": 1}
"""The switch of the program that tells of cells what is first told of squares."""

PARTS = {"ORDERS": 0, "REACH_PARTS": 1}
"""The switches of rays that are held against the parts of things, too."""


@dataclass(frozen=True, eq=False)
class Reached:
    """What the cells of a picture may show.

    Attributes:
        cells: R8, a texel for each cell of ``REFINE_STEP``² pixels, as shaders/reach_cells.frag leaves them.
        cell_balls: R32UI, a bit for each ball that may be the first that is met in the cell.
        balls: what is held against, as shaders/common/reach.glsl takes it.
        fills: whether any ball is filled, so that a cell may show it alone.
        known: whether each ball is that of one thing.
    """

    cells: moderngl.Texture
    cell_balls: moderngl.Texture
    balls: moderngl.Texture
    fills: bool
    known: bool

    @property
    def samplers(self) -> dict[str, moderngl.Texture]:
        """What shaders/common/known_balls.glsl reads, by name."""
        return {"cell_balls": self.cell_balls, "reach_balls": self.balls}


@dataclass(frozen=True, eq=False)
class _Level:
    """Nodes, and for each cell between them what it may show, R8 and R32UI.

    Attributes:
        box: where the nodes lie in their texture: of the first level, of which there are few, so that llvmpipe's tiles part them in halves.
        depth: of the nodes, by which they are drawn.
        marks: draws into `depth`.
    """

    box: Box
    nodes: Target
    cells: Target
    depth: moderngl.Texture
    marks: moderngl.Framebuffer

    @classmethod
    def of(cls, ctx: moderngl.Context, size: tuple[int, int], step: int, *, first: bool) -> _Level:
        """Nodes `step` pixels apart, for a picture of `size`; of the `first` level or another."""
        cells = -(-size[0] // step), -(-size[1] // step)
        columns, rows = cells[0] + 1, cells[1] + 1
        x, y = (_first_texel(columns), _first_texel(rows)) if first else (0, 0)
        nodes = x + columns, y + rows
        depth = ctx.depth_texture(nodes)
        return cls(
            box=(x, y, columns, rows),
            nodes=Target.of(ctx, [plain_texture(ctx, nodes, 2, "u4")], depth),
            cells=Target.of(ctx, [plain_texture(ctx, cells, 1, "f1"), plain_texture(ctx, cells, 1, "u4")]),
            depth=depth,
            marks=ctx.framebuffer([], depth),
        )

    def release(self) -> None:
        for item in (self.nodes, self.cells, self.marks, self.depth):
            item.release()


@dataclass(frozen=True, eq=False)
class _Made:
    """Of a picture's size: nodes by the pixels between them, each half as far apart as those before."""

    size: tuple[int, int]
    levels: dict[int, _Level]

    def release(self) -> None:
        for level in self.levels.values():
            level.release()


class Reach:
    """Draws shaders/reach_*.frag.

    Args:
        tables: what rays are traced with; they stay their owner's.
    """

    def __init__(self, ctx: moderngl.Context, programs: Programs, tables: Tables):
        self._ctx, self._programs, self._tables = ctx, programs, tables
        self._made: _Made | None = None
        self._balls: moderngl.Texture | None = None

    def draw(
        self,
        inputs: FrameInputs,
        balls: Float[np.ndarray, "balls 4"],
        numbers: Int[np.ndarray, " balls"],
        fills: Bool[np.ndarray, " balls"],
        *,
        exact: bool = False,
    ) -> Reached:
        """What each cell may show of `balls`, centre and radius each in r_s in the plan's frame.

        Args:
            numbers: 1 + kind + 32·index of what lies in each; 0 where that is no thing.
            fills: whether it fills the ball and hides what is behind.
            exact: for squares that nothing else judges; else cells between whose rays directions are not to be interpolated may show what they are near, too.
        """
        made = self._targets(inputs.size)
        traced, length = (inputs, inputs.plan.step_length) if exact else _longer_steps(inputs)
        nodes = self._programs.get("reach_field.frag" if inputs.plan.model.traits.field else "reach_nodes.frag", traced, ALONE)
        seen = balls[:, 3] > 0.0  # lamps may have no size
        few = gathered(balls[seen], MOST_BALLS) if seen.any() else _NOWHERE
        each_its_own = np.count_nonzero(seen) == len(few)
        own, filled = (numbers[seen], fills[seen]) if each_its_own else (np.zeros(len(few), int), np.zeros(len(few), bool))
        table = {"reach_balls": self._table(few, own, filled)}
        balls_held: dict[str, object] = {"reach_count": len(few), "reach_steps": inputs.plan.reach_steps, "reach_radii": _shell(inputs.plan)}
        nodes.set(**balls_held)
        if inputs.plan.model.traits.field:
            nodes.set(reach_stride=max(1, int(_PIECE / length)))
        found: Sequence[moderngl.Texture] = ()
        parted, things = _parted(inputs.plan, own), dict[str, moderngl.Texture]()
        for step, level in made.levels.items():
            if found:
                self._mark(inputs, level, found[0])
            if parted and step == REFINE_STEP:
                nodes, things = self._programs.get("reach_nodes.frag", inputs, PARTS), self._tables.of_instances(inputs)
                nodes.set(reach_parted=parted, **balls_held)
            self._tables.bind(nodes, {**table, **things})
            nodes.set(reach_step=float(step), reach_first=tuple(map(float, level.box[:2])))
            nodes.set(reach_not_linear=_BY_ITSELF if exact else _not_linear(inputs, step))
            frame = level.nodes.frame
            frame.use()
            frame.depth_mask = False
            with drawn(self._ctx, nodes, _MARKED if found else EVERYWHERE):
                nodes.draw_boxes([level.box])
            self._judge(inputs, level, found, len(few))
            found = level.cells.textures
        cells, cell_balls = made.levels[REFINE_STEP].cells.textures
        return Reached(cells, cell_balls, table["reach_balls"], bool(filled.any()), each_its_own)

    def _mark(self, inputs: FrameInputs, level: _Level, found_first: moderngl.Texture) -> None:
        """Marks the nodes of the cells in those that were found first."""
        marks = self._programs.get("reach_marks.frag", inputs)
        marks.sample({"found_first": found_first})
        level.marks.use()
        self._ctx.enable(moderngl.DEPTH_TEST)
        self._ctx.depth_func = "1"  # always
        marks.draw()
        self._ctx.disable(moderngl.DEPTH_TEST)
        self._ctx.depth_func = "<"

    def _judge(self, inputs: FrameInputs, level: _Level, found_first: Sequence[moderngl.Texture], count: int) -> None:
        """Tells of the cells between the level's nodes what they may show of `count` balls."""
        cells = self._programs.get("reach_cells.frag", inputs, FINER if found_first else {})
        cells.sample({"nodes": level.nodes.texture, **dict(zip(("found_first", "balls_first"), found_first))})
        cells.set(reach_count=count, reach_first=level.box[:2])
        level.cells.frame.use()
        cells.draw()

    def squares(self, inputs: FrameInputs, balls: Float[np.ndarray, "balls 4"]) -> Squares:
        """Those cells, listed. Waits for the GPU."""
        texture = self.draw(inputs, balls, np.zeros(len(balls), int), np.zeros(len(balls), bool), exact=True).cells
        found = np.frombuffer(texture.read(alignment=1), np.uint8).reshape(texture.height, texture.width)
        rows, columns = np.nonzero(found)
        return Squares.of(np.stack([columns, rows], axis=-1), REFINE_STEP, inputs.size)

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
            self._made = _Made(size, {step: _Level.of(self._ctx, size, step, first=k == 0) for k, step in enumerate(steps(size[1]))})
        return self._made

    def _table(self, balls: Float[np.ndarray, "balls 4"], numbers: Int[np.ndarray, " balls"], fills: Bool[np.ndarray, " balls"]) -> moderngl.Texture:
        if self._balls is None:
            self._balls = self._ctx.texture((MOST_BALLS, 2), 4, dtype="f4")
            self._balls.filter = moderngl.NEAREST, moderngl.NEAREST
        texels = np.zeros((2, MOST_BALLS, 4), np.float32)
        texels[0, : len(balls)], texels[1, : len(balls), 0] = balls, numbers
        texels[0, : len(balls), 3] *= np.where(fills, -1.0, 1.0)
        self._balls.write(texels.tobytes())
        return self._balls


def _parted(plan: Plan, numbers: Int[np.ndarray, " balls"]) -> int:
    """A bit for each ball in which a thing of many parts lies, that rays are held against; 0 in fields, which march in steps of another kind."""
    if plan.model.traits.field or plan.meetings != 1:
        return 0
    apart = [number for number, kind in enumerate(met.kinds(plan.scene, "thing")) if kind.traits.tells_apart]
    return sum(1 << ball for ball, number in enumerate(numbers.tolist()) if number > 0 and (number - 1) % 32 in apart)


def steps(height: int) -> list[int]:
    """Pixels between the nodes of each level, of a picture of that height: the first are as many whatever the picture's size."""
    first = REACH_STEP
    while 2 * first * _ACROSS <= height:
        first *= 2
    found = [first]
    while found[-1] > REFINE_STEP:
        found.append(found[-1] // 2)
    return found


def _first_texel(count: int) -> int:
    """Where the first of so many nodes in a row is to lie, so that a tile ends in their middle if they fit into two; even, as quads stay together."""
    return (_TILE - count // 2) // 2 * 2 if count <= 2 * _TILE else 0


def balls(plan: Plan, time: float) -> Float[np.ndarray, "balls 4"]:
    """A ball about each thing and medium of the plan's scene at scene time `time`, in the order of `instances.key`: centre and radius in r_s."""
    return np.concatenate([motion.rows(plan.scene, slot, plan.space_time, time)[:, 0] for slot in met.SLOTS])


def _shell(plan: Plan) -> tuple[float, float]:
    least = plan.scene.rays.field_radius if plan.model.traits.field else _OUTERMOST * plan.scene.hole.gravity_strength
    return _INNERMOST * plan.space_time.horizon_radius, max(least, plan.reach)


def _not_linear(inputs: FrameInputs, step: int) -> float:
    """What is not linear between rays `step` pixels apart, of the margin."""
    apart = step * projection.view_angle(inputs.plan.scene.camera) / inputs.picture[1]
    return min(max(_NOT_LINEAR * apart / _APART, _LEAST_NOT_LINEAR), _NOT_LINEAR)


def _longer_steps(inputs: FrameInputs) -> tuple[FrameInputs, float]:
    """`inputs` by steps as long as they may be in motion, and that length in r_s, unless one is longer than a piece: pieces are no longer for it."""
    length = inputs.plan.step_length * steps_in_motion(inputs.plan, inputs.picture[1])
    return (inputs.in_motion, length) if length <= _PIECE else (inputs, inputs.plan.step_length)


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
