"""Drawing only the pixels of one class (`PixelClass`): the depth test compares them with the depth at which the triangle is drawn."""

from __future__ import annotations

from collections.abc import Generator, Mapping
from contextlib import contextmanager
from dataclasses import dataclass

import moderngl
import numpy as np

from ..glsl.declared import PixelClass
from ..planning import Plan
from .draw import Draw


@dataclass(frozen=True, eq=False)
class Where:
    """Those pixels whose depth compares with `depth`: ``>`` where it is nearer, ``<`` where it is farther away, ``1`` always.

    Attributes:
        needed: how far away they are at most that need it; those farther away may be left out.
    """

    comparison: str
    depth: float
    needed: float = 1.0

    def holds(self, depths: np.ndarray) -> np.ndarray:
        """Which pixels need it, by what the depth buffer holds of them; bool, of the same shape."""
        passed = self.passed_by(depths)
        return passed & (depths < self.needed) if self.comparison == "<" else passed

    def passed_by(self, depths: np.ndarray) -> np.ndarray:
        """Which the depth test lets pass, be they needed or not."""
        if self.comparison == "<":
            return depths > self.depth
        return depths < self.depth if self.comparison == ">" else np.ones(depths.shape, bool)


MATTER = Where(">", PixelClass.MATTER.depth_beyond)
BEYOND_MATTER = Where("<", PixelClass.MATTER.depth_beyond)
"""All but those of `MATTER`."""
SKY = Where(">", PixelClass.SKY.depth_beyond)
FLAT_SKY = Where("<", PixelClass.FLAT_SKY.depth - 0.1, needed=PixelClass.FLAT_SKY.depth_beyond)
"""Those of things may be drawn too: what is drawn for them has to come later."""
THINGS = Where("<", PixelClass.FLAT_SKY.depth_beyond)
OPEN_THINGS = Where("<", PixelClass.SOLID_THING.depth_beyond)
"""Those of `THINGS` that may be of the sky too."""
EVERYWHERE = Where("1", 0.5)
OWN_RAYS = Where(">", PixelClass.OWN_RAY.depth_beyond)


NO_THINGS: Mapping[str, int] = {"MEETINGS": 0}
"""The switches of programs for pixels and rays that show no thing or medium, and for which none was written."""


def seeking_nothing(plan: Plan) -> Mapping[str, int]:
    """The switches of rays that look for no thing or medium, in a map of rays that do."""
    return {**NO_THINGS, "NO_MEETINGS": plan.meetings}


def own_rays(plan: Plan) -> tuple[tuple[Where, Mapping[str, int]], ...]:
    """The pixels of a refined map that are traced themselves, and the switches of what reads them."""
    return ((OWN_RAYS, NO_THINGS), (OPEN_THINGS, {})) if plan.meetings else ((OWN_RAYS, {}),)


@contextmanager
def drawn(ctx: moderngl.Context, draw: Draw, where: Where) -> Generator[None]:
    """Has `draw` draw only `where` it says, by the depth buffer of the target in use."""
    draw.set(triangle_depth=2.0 * where.depth - 1.0)
    ctx.enable(moderngl.DEPTH_TEST)
    ctx.depth_func = where.comparison
    yield
    ctx.disable(moderngl.DEPTH_TEST)
    ctx.depth_func = "<"
