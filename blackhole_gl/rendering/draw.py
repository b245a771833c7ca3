"""A compiled program, and what it draws by one frame's inputs: the whole of its target, boxes or squares of it, a mesh or points."""

from __future__ import annotations

from collections.abc import Iterable, Mapping
from dataclasses import dataclass
from functools import cached_property
from typing import Any

import moderngl
import numpy as np

from ..shapes import Float
from .boxes import Box
from .inputs import FrameInputs, UniformBuffers
from .squares import Patches, SquareBuffer, Squares

Samplers = Mapping[str, moderngl.Texture | moderngl.TextureArray]
"""Sampler's name → texture."""


@dataclass(frozen=True, eq=False)
class Compiled:
    """A compiled program with the triangle that covers its target, and squares of it.

    Attributes:
        serial: a number that no other program of this process has, for the keys of what was drawn by it.
        squares: points at what `points` hold.
        blocks: the buffers of the uniform blocks.
        points: the buffer of squares.
    """

    serial: int
    triangle: moderngl.VertexArray
    squares: moderngl.VertexArray
    blocks: UniformBuffers
    points: SquareBuffer

    @cached_property
    def members(self) -> dict[str, Any]:
        """Its samplers, loose uniforms and blocks by name: looking a name up in the program walks through all of them."""
        return {name: self.program[name] for name in self.program}

    @cached_property
    def values(self) -> dict[str, object]:
        """What its samplers and loose uniforms were last set to: to set one takes a hundred times as long as to compare."""
        return {}

    @property
    def program(self) -> moderngl.Program:
        """The program, which takes samplers and loose uniforms."""
        return self.triangle.program

    def release(self) -> None:
        """Gives the GL objects back."""
        program = self.program  # which a released triangle no longer knows
        self.triangle.release()
        self.squares.release()
        program.release()


@dataclass(frozen=True, eq=False)
class Draw:
    """A program made ready for one frame's inputs.

    Attributes:
        serial: of its program.
        inputs: what its uniform blocks hold when it draws.
    """

    compiled: Compiled
    inputs: FrameInputs

    @property
    def serial(self) -> int:
        """That of the program."""
        return self.compiled.serial

    @property
    def program(self) -> moderngl.Program:
        """The program, which takes samplers and loose uniforms."""
        return self.compiled.program

    def takes(self, name: str) -> bool:
        """Whether the program has a sampler or a loose uniform of that name."""
        return name in self.compiled.members

    def sample(self, samplers: Samplers, first: int = 0) -> None:
        """Binds those of `samplers` (name → texture) that the program uses, to texture units from `first` on."""
        members, held = self.compiled.members, self.compiled.values
        for unit, name in enumerate(filter(members.__contains__, samplers), first):
            samplers[name].use(unit)
            if held.get(name) != unit:
                members[name].value = held[name] = unit

    def set(self, **uniforms: object) -> None:
        """Sets loose uniforms by name."""
        members, held = self.compiled.members, self.compiled.values
        for name, value in uniforms.items():
            if held.get(name) != value:
                members[name].value = held[name] = value

    def tell(self, **uniforms: object) -> None:
        """Sets those of the loose `uniforms` that the program has."""
        members, held = self.compiled.members, self.compiled.values
        for name, value in uniforms.items():
            if name in members and held.get(name) != value:
                members[name].value = held[name] = value

    def draw(self) -> None:
        """Draws the triangle that covers the bound target."""
        self._bind()
        self.compiled.triangle.render(moderngl.TRIANGLES, vertices=3)

    def draw_boxes(self, boxes: Iterable[Box]) -> None:
        """Draws `boxes` of the bound target alone, by its scissor."""
        self._bind()
        triangle = self.compiled.triangle
        for box in boxes:
            triangle.ctx.scissor = box
            triangle.render(moderngl.TRIANGLES, vertices=3)
        triangle.ctx.scissor = None

    def draw_squares(self, *squares: Squares) -> None:
        """Draws `squares` of the bound target alone."""
        self._draw_points(np.concatenate([some.points for some in squares]))

    def draw_patches(self, patches: Patches) -> None:
        """Draws `patches` of the bound target alone."""
        self._draw_points(patches.points)
        self.draw_boxes(patches.boxes)

    def _draw_points(self, points: Float[np.ndarray, "squares 3"]) -> None:
        self._bind()
        self.compiled.points.draw(self.compiled.squares, points)

    def draw_mesh(self, columns: int, rows: int) -> None:
        """Draws a mesh, by a program whose vertex shader places the two triangles of each of its quads."""
        self._bind()
        self.compiled.triangle.render(moderngl.TRIANGLES, vertices=6 * columns * rows)

    def draw_points(self, count: int) -> None:
        """Draws `count` points, by a program whose vertex shader places them."""
        self._bind()
        self.compiled.triangle.render(moderngl.POINTS, vertices=count)

    def _bind(self) -> None:
        self.compiled.blocks.bind(self.inputs, self.compiled.members)
