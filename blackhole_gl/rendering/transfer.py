"""The light of media: what they add to each ray and let through, marched from the camera, or from where the hit map has the ray enter them."""

from __future__ import annotations

from collections.abc import Mapping

import moderngl
import numpy as np

from ..planning import Plan
from ..scene import met
from ..shapes import Float
from . import instances
from .classes import Where, drawn
from .draw import Draw
from .hit_map import HitMap


class TransferPass:
    """Draws shaders/transfer.frag into textures of its own, and keeps what it drew as long as neither the rays nor the media's light change.

    Attributes:
        marches: how many times it has drawn, for tests.
    """

    def __init__(self, ctx: moderngl.Context):
        self._ctx = ctx
        self.marches = 0
        self._textures: list[moderngl.Texture] = []
        self._frame: moderngl.Framebuffer | None = None
        self._key: tuple | None = None
        self._rows = 0  # that are drawn

    def draw(self, march: Draw, hit_map: HitMap, classes: moderngl.Texture, where: Where, most: int | None = None) -> bool:
        """Draws with `march`, its samplers bound, the pixels of `hit_map` that are `where` it says by their `classes`, unless that is what the textures hold.

        Args:
            most: rays, about, that are drawn now, the others by the next calls; None: all.

        Returns:
            Whether the textures hold all of it.
        """
        inputs = march.inputs
        plan = inputs.plan
        key = (hit_map.generation, march.serial, plan.scene.media, plan.scene.rays.medium_step, inputs.time if changes(plan) else 0.0)
        if key != self._key or self._frame is None or self._frame.depth_attachment is not classes:
            self._fit(classes, stretches(plan))
            self._key, self._rows = key, 0
            self.marches += 1
        width, height = classes.size
        first, self._rows = self._rows, height if most is None else min(self._rows + max(most // width, 1), height)
        if first < height and self._frame is not None:
            self._frame.use()
            self._ctx.disable(moderngl.BLEND)
            self._ctx.scissor = 0, first, width, self._rows - first
            with drawn(self._ctx, march, where):
                march.draw()
            self._ctx.scissor = None
        return self._rows == height

    @property
    def samplers(self) -> Mapping[str, moderngl.Texture]:
        """What shaders/common/stretches.glsl reads, by name."""
        return {f"{('gathered', 'dimmed')[place % 2]}{place // 2}": texture for place, texture in enumerate(self._textures)}

    def read(self) -> tuple[Float[np.ndarray, "stretches height width 3"], Float[np.ndarray, "stretches height width 3"]]:
        """What media add and let through, float32 (stretches, height, width, 3), row 0 at the bottom; without meaning where a ray meets none."""
        shape = self._textures[0].height, self._textures[0].width, 4
        texels = [np.frombuffer(texture.read(), np.float32).reshape(shape)[..., :3] for texture in self._textures]
        return np.stack(texels[::2]), 1.0 - np.stack(texels[1::2])

    def release(self) -> None:
        """Gives the GL objects back."""
        for item in (self._frame, *self._textures):
            if item is not None:
                item.release()
        self._textures, self._frame, self._key = [], None, None

    def _fit(self, classes: moderngl.Texture, count: int) -> None:
        """A pair of textures for each of `count` stretches, of the size of `classes`, which stay their owner's."""
        held = self._frame is not None and self._frame.depth_attachment is classes
        if held and len(self._textures) == 2 * count:
            return
        self.release()
        self._textures = [self._ctx.texture(classes.size, 4, dtype="f4") for _ in range(2 * count)]
        for texture in self._textures:
            texture.filter = moderngl.NEAREST, moderngl.NEAREST
        self._frame = self._ctx.framebuffer(self._textures, classes)
        self._frame.depth_mask = False


def stretches(plan: Plan) -> int:
    """How many parts a ray has between crossings of the disk's plane."""
    return plan.orders + 1


def changes(plan: Plan) -> bool:
    """Whether a medium's light, or its place, is another at another time on rays that stay the same."""
    return any(kind.traits.changes for kind in met.kinds(plan.scene, "medium")) or instances.anything_moves(plan)
