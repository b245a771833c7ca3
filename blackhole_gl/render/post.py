"""Post: radiance → picture. Bloom as a chain of ever smaller levels, then exposure, tone map, gamma and dither."""

from __future__ import annotations

from typing import Iterator

import moderngl

from ..plan import RayPlan
from ..scene import Scene
from .programs import Programs, draw
from .shading import bind_samplers

MOST_LEVELS = 6
"""Levels of the bloom chain at most; the smallest is then 1/128 of the picture."""


def bloom_sizes(size: tuple[int, int]) -> Iterator[tuple[int, int]]:
    """Sizes of the bloom levels of a picture of `size`: a quarter, then halves, rounded up, until a side is 2 or less."""
    size = -(-size[0] // 4), -(-size[1] // 4)
    yield size
    for _ in range(MOST_LEVELS - 1):
        if min(size) <= 2:
            return
        size = -(-size[0] // 2), -(-size[1] // 2)
        yield size


class PostPass:
    """Draws shaders/post/*.frag and owns the levels of the bloom. With bloom off it draws one triangle and owns nothing."""

    def __init__(self, ctx: moderngl.Context, programs: Programs):
        self._ctx, self._programs = ctx, programs
        self._size: tuple[int, int] | None = None
        self._down: list[moderngl.Framebuffer] = []
        self._up: list[moderngl.Framebuffer] = []

    def draw(self, scene: Scene, ray_plan: RayPlan, radiance: moderngl.Texture, target: moderngl.Framebuffer, viewport: tuple[int, int, int, int]) -> None:
        """Makes `radiance` (RGBA16F) the picture in the `viewport` (x, y, width, height) of `target`. The uniform blocks are bound."""
        radiance.filter = (moderngl.LINEAR, moderngl.LINEAR)
        radiance.repeat_x = radiance.repeat_y = False
        samplers = {"radiance": radiance}
        if scene.post.bloom:
            samplers["glow"] = self._bloom(scene, ray_plan, radiance)
        triangle = self._programs.get("post/tone_map.frag", scene, ray_plan)
        bind_samplers(triangle.program, samplers)
        triangle.program["target_origin"].value = viewport[:2]
        triangle.program["target_texel"].value = _texel(viewport[2:])
        target.use()
        outer = target.viewport
        target.viewport = viewport
        draw(triangle)
        target.viewport = outer

    def release(self) -> None:
        """Gives the GL objects back."""
        for level in (*self._down, *self._up):
            level.color_attachments[0].release()
            level.release()
        self._down, self._up, self._size = [], [], None

    def _bloom(self, scene: Scene, ray_plan: RayPlan, radiance: moderngl.Texture) -> moderngl.Texture:
        self._make_levels(radiance.size)
        source, threshold, centre = radiance, scene.post.bloom_threshold, 0.0
        triangle = self._programs.get("post/bloom_down.frag", scene, ray_plan)
        for level in self._down:
            bind_samplers(triangle.program, {"source": source})
            _set(triangle, source_texel=_texel(source.size), target_texel=_texel(level.size), threshold=threshold, centre_weight=centre)
            level.use()
            draw(triangle)
            source, threshold, centre = level.color_attachments[0], 0.0, 4.0
        triangle = self._programs.get("post/bloom_up.frag", scene, ray_plan)
        share = scene.post.bloom_spread / (0.4 + scene.post.bloom_spread)
        for own, level in zip(reversed(self._down[:-1]), self._up):
            bind_samplers(triangle.program, {"wider": source, "level": own.color_attachments[0]})
            _set(triangle, wider_texel=_texel(source.size), target_texel=_texel(level.size), spread=share)
            level.use()
            draw(triangle)
            source = level.color_attachments[0]
        return source

    def _make_levels(self, size: tuple[int, int]) -> None:
        if size == self._size:
            return
        self.release()
        self._down = [self._level(level) for level in bloom_sizes(size)]
        self._up = [self._level(level.size) for level in reversed(self._down[:-1])]
        self._size = size

    def _level(self, size: tuple[int, int]) -> moderngl.Framebuffer:
        texture = self._ctx.texture(size, 4, dtype="f2")
        texture.filter = (moderngl.LINEAR, moderngl.LINEAR)
        texture.repeat_x = texture.repeat_y = False
        return self._ctx.framebuffer([texture])


def _texel(size: tuple[int, int]) -> tuple[float, float]:
    return 1.0 / size[0], 1.0 / size[1]


def _set(triangle: moderngl.VertexArray, **uniforms: object) -> None:
    for name, value in uniforms.items():
        triangle.program[name].value = value
