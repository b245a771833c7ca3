"""Textures whose pixels are another's, some pixels away."""

from __future__ import annotations

import moderngl

from .inputs import FrameInputs
from .programs import Programs
from .squares import Squares


def shifted_into(
    ctx: moderngl.Context, programs: Programs, inputs: FrameInputs, own: moderngl.Texture, source: moderngl.Texture, squares: Squares, by: tuple[int, int]
) -> None:
    """Clears the texture `own` and draws `squares` of it from `source`, of which they are the pixels when `by` is added."""
    copy = programs.get("shifted.frag", inputs)
    copy.sample({"source": source})
    copy.set(shift=by)
    frame = ctx.framebuffer([own])
    frame.clear()
    frame.use()
    copy.draw_boxes(squares.boxes(own.size))
    frame.release()
