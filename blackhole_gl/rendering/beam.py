"""The picture as seen with a telescope's beam: a round Gaussian of a width on the sky.

A wide one is drawn on a picture that was halved until σ is 2.5 to 5 of its pixels, and enlarged by cubic B-splines. Halving adds 5 (f² − 1)/12 to the square of
the width, f being the factor, and enlarging f²/3: the Gaussian is narrower by both. What is left of an error is below a thousandth of the peak. Pictures in
between are of 32-bit floats: half floats, which some drivers cut instead of rounding them, would darken the picture pass by pass.
"""

from __future__ import annotations

import math

import moderngl

from ..physics.angular_size import picture_height_uas
from ..scene import Scene
from .draw import Draw
from .inputs import FrameInputs
from .levels import Level, draw_into, padded
from .programs import Programs

SIGMAS_OF_WIDTH = 1.0 / math.sqrt(8.0 * math.log(2.0))
"""σ of a Gaussian over its full width at half maximum."""

_LEAST_SIGMA = 2.5  # in pixels of the halved picture
_MARGIN = 3  # pixels of the halved picture about it, so many that the outermost hold nothing but the light that goes on beyond the edge
_AXES = ((1, 0), (0, 1))


def sigma_px(scene: Scene, height: int) -> float:
    """σ of the beam in pixels of a picture of `scene` that is `height` pixels high."""
    return SIGMAS_OF_WIDTH * scene.post.beam_uas * height / picture_height_uas(scene.camera, scene.source)


class BeamPass:
    """Draws shaders/post/beam_*.frag and owns the pictures in between."""

    def __init__(self, ctx: moderngl.Context, programs: Programs):
        self._ctx, self._programs = ctx, programs
        self._levels: dict[str, Level] = {}

    def blurred(self, inputs: FrameInputs, radiance: moderngl.Texture) -> moderngl.Texture:
        """`radiance` (a whole picture) blurred by the beam of the scene, as RGBA32F; the texture is the next call's, too."""
        # All of them: a beam that needs no halving may need one as the camera moves, which would then wait for the program.
        halve, blur, enlarge = (self._programs.get(f"post/beam_{name}.frag", inputs) for name in ("halve", "blur", "enlarge"))
        sigma = sigma_px(inputs.plan.scene, radiance.size[1])
        halvings = max(int(math.log2(sigma / _LEAST_SIGMA)), 0) if sigma > 0.0 else 0
        factor = 2**halvings
        source, size, whole = radiance, radiance.size, inputs.size
        for number in range(halvings):
            for axis in _AXES:
                margin = 0 if number else _MARGIN * factor
                half = _halved(size, axis, margin)
                source, size = self._drawn(halve, f"halved {number} {axis}", source, half, source_last=_last(size), axis=axis, margin=margin)
        widened = 5.0 * (factor**2 - 1) / 12.0 + (factor**2 / 3.0 if halvings else 0.0)
        own = math.sqrt(sigma**2 - widened) / factor
        for axis in _AXES:
            source, size = self._drawn(blur, f"blurred {axis}", source, size, source_last=_last(size), axis=axis, sigma=own)
        for axis, larger in zip(_AXES, ((whole[0], size[1]), whole)) if halvings else ():
            source, size = self._drawn(enlarge, f"enlarged {axis}", source, larger, axis=axis, factor=float(factor), margin=float(_MARGIN))
        return source

    def release(self) -> None:
        """Gives the GL objects back."""
        for level in self._levels.values():
            level.target.release()
        self._levels = {}

    def _drawn(
        self, draw: Draw, name: str, source: moderngl.Texture, size: tuple[int, int], **uniforms: object
    ) -> tuple[moderngl.Texture, tuple[int, int]]:
        """The level called `name`, of `size`, drawn from `source`."""
        draw.sample({"source": source})
        draw.set(**uniforms)
        level = self._level(name, size, size if size == draw.inputs.size else padded(size))
        draw_into(level, draw)
        return level.texture, size

    def _level(self, name: str, size: tuple[int, int], allocated: tuple[int, int]) -> Level:
        known = self._levels.get(name)
        if known is None or known.size != size:
            if known is not None:
                known.target.release()
            known = self._levels[name] = Level.of(self._ctx, size, allocated, "f4")
        return known


def _halved(size: tuple[int, int], axis: tuple[int, int], margin: int) -> tuple[int, int]:
    """`size` with a margin on both sides along `axis`, and half as large there."""
    width, height = (-(-(side + 2 * margin) // 2) if along else side for side, along in zip(size, axis))
    return width, height


def _last(size: tuple[int, int]) -> tuple[int, int]:
    """The last pixel of a picture of `size`."""
    return size[0] - 1, size[1] - 1
