"""Tables that closed ray models look things up in: made when what they depend on changes, and only then."""

from __future__ import annotations

import math

import moderngl
import numpy as np

from ..physics import orbit_table
from ..scene import Scene

UNIT = 7
"""The texture unit of the table, above those of all other samplers."""


class RayTables:
    """The tables that ray models' programs ask for by the names of their samplers.

    Attributes:
        made: how many tables have been made, for tests.
    """

    def __init__(self, ctx: moderngl.Context):
        self._ctx = ctx
        self.made = 0
        self._orbit: moderngl.Texture | None = None
        self._distance = math.nan

    def bind(self, program: moderngl.Program, scene: Scene) -> None:
        """Gives `program` the table it reads, if it reads one."""
        if "orbit_table" not in program:
            return
        self._update(scene.camera.distance)
        program["orbit_table"].value = UNIT
        self._orbit.use(UNIT)

    def release(self) -> None:
        """Gives the GL objects back."""
        if self._orbit is not None:
            self._orbit.release()
        self._orbit, self._distance = None, math.nan

    def _update(self, distance: float) -> None:
        if distance == self._distance:
            return
        cubics = orbit_table.table(distance)
        if self._orbit is None:
            self._orbit = self._ctx.texture((orbit_table.WIDTH, 2), 4, dtype="f4")
            self._orbit.filter = (moderngl.NEAREST, moderngl.NEAREST)
        self._orbit.write(np.ascontiguousarray(cubics).tobytes())
        self._distance = distance
        self.made += 1
