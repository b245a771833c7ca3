"""What a frame is made from, as one record. Its uniform blocks follow from it and from nothing else."""

from __future__ import annotations

from collections.abc import Collection
from dataclasses import dataclass, field
from functools import cached_property

import moderngl

from ..planning import Plan, steps_in_motion
from ..scene.frozen import changed
from . import uniforms


@dataclass(frozen=True)
class FrameInputs:
    """One frame, or a part of one.

    Attributes:
        plan: the plan, with the scene in it.
        time: scene time in r_s/c.
        size: (width, height) in pixels of what is drawn.
        picture: (width, height) in pixels of the whole picture that it is a part of.
        offset: of the drawn part in the picture, in pixels from the bottom left, with the shift of the rays inside their pixels.
        shown: (width, height) in pixels that the picture is to be shown with; None: its own.
        start: of a part that is kept in a ring (direction_grid.py), column and row of its first pixel; pixels before that come after the last.
        frame: the same object in all that is derived from these inputs, and in no other frame's: files are looked at once for each.
    """

    plan: Plan
    time: float
    size: tuple[int, int]
    picture: tuple[int, int]
    offset: tuple[float, float] = (0.0, 0.0)
    shown: tuple[int, int] | None = None
    start: tuple[int, int] = (0, 0)
    frame: object = field(default_factory=object, compare=False, repr=False)

    @classmethod
    def whole(
        cls, plan: Plan, time: float, size: tuple[int, int], offset: tuple[float, float] = (0.0, 0.0), shown: tuple[int, int] | None = None
    ) -> FrameInputs:
        """A whole picture of `size`, its rays shifted by `offset` pixels, to be `shown` with another."""
        return cls(plan, time, size, size, offset, shown)

    @property
    def finer(self) -> tuple[float, float]:
        """Sides of a pixel shown over those of the picture's own, at most 1."""
        shown = self.shown or self.picture
        return min(self.picture[0] / shown[0], 1.0), min(self.picture[1] / shown[1], 1.0)

    def with_plan(self, plan: Plan) -> FrameInputs:
        """The same frame by another plan."""
        return changed(self, plan=plan)

    @cached_property
    def in_motion(self) -> FrameInputs:
        """The same frame by steps as long as they may be under a moving camera."""
        times = steps_in_motion(self.plan, self.picture[1])
        if times == 1.0:
            return self
        made = changed(self)
        made.__dict__["blocks"] = uniforms.in_longer_steps(self.blocks, self.plan, times)
        return made

    def drawn_as(self, size: tuple[int, int]) -> FrameInputs:
        """The same picture's rays, drawn into `size` pixels: the uniform blocks are the same ones."""
        made = changed(self, size=size)
        made.__dict__["blocks"] = self.blocks
        return made

    def in_picture(self, plan: Plan, size: tuple[int, int]) -> FrameInputs:
        """The same blocks for what is drawn as if it were a picture of `size` by `plan`: for what asks no rays."""
        made = changed(self, plan=plan, size=size, picture=size, offset=(0.0, 0.0))
        made.__dict__["blocks"] = self.blocks
        return made

    @cached_property
    def blocks(self) -> dict[str, bytes]:
        """The packed uniform blocks by name.

        Raises:
            ValueError: the camera is where no observer can be.
        """
        ring = (*self.start, *self.size) if any(self.start) else uniforms.NO_RING
        return uniforms.as_bytes(self.plan, self.time, self.picture, self.offset, ring)

    @cached_property
    def ray_bytes(self) -> bytes:
        """The block of what rays depend on: part of the key of hits that are kept."""
        return self.blocks[uniforms.ray_block().name]


class UniformBuffers:
    """The buffers of the uniform blocks: the one place where a frame's inputs are bound."""

    def __init__(self, ctx: moderngl.Context):
        self._ctx = ctx
        self._bindings: tuple[tuple[str, moderngl.Buffer, int], ...] = ()
        self._written: dict[str, bytes] | None = None

    def bind(self, inputs: FrameInputs, used: Collection[str]) -> None:
        """Binds those blocks of `inputs` that are `used`, each written anew unless it is what was written last. Binding is not remembered: others may share the
        context."""
        if inputs.blocks is not self._written:
            self._write(inputs.blocks)
        for name, buffer, binding in self._bindings:
            if name in used:
                buffer.bind_to_uniform_block(binding)

    def _write(self, blocks: dict[str, bytes]) -> None:
        if not self._bindings:
            self._bindings = tuple((block.name, self._ctx.buffer(blocks[block.name], dynamic=True), block.binding) for block in uniforms.blocks())
        elif self._written is not None:
            for name, buffer, _ in self._bindings:
                if blocks[name] is not self._written[name]:
                    buffer.write(blocks[name])
        self._written = blocks

    def release(self) -> None:
        """Gives the GL objects back."""
        for _, buffer, _ in self._bindings:
            buffer.release()
        self._bindings, self._written = (), None
