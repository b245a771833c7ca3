"""The textures that plug-ins declare in their headers, tables and pictures: made when what they depend on changes, and only then."""

from __future__ import annotations

from collections.abc import Callable, Iterable, Mapping
from types import MappingProxyType
from typing import Any

import moderngl
import numpy as np

from ..planning import Plan
from ..scene import Scene
from ..scene.catalogue import CatalogueError, PlugIn
from ..scene.tables import Table
from . import mip_levels
from .draw import Draw, Samplers
from .inputs import FrameInputs
from .instances import InstanceTables
from .pictures import Pictures
from .structure import RAY_SLOTS, chosen

RAY_UNIT = 7
"""The first texture unit of what rays are traced with, above those of all other samplers."""

_Texture = moderngl.Texture | moderngl.TextureArray

_DTYPES = {np.dtype(np.uint8): "f1", np.dtype(np.float16): "f2", np.dtype(np.float32): "f4"}
_FILTERS = {
    "nearest": (moderngl.NEAREST, moderngl.NEAREST),
    "linear": (moderngl.LINEAR, moderngl.LINEAR),
    "mipmap": (moderngl.LINEAR_MIPMAP_LINEAR, moderngl.LINEAR),
}


class Tables:
    """The tables of whatever plug-ins are in use.

    Attributes:
        pictures: those that parameters name.
        instances: the things and media that rays may meet: of one scene and time in all maps that are traced with these.
        made: how many tables have been made, for tests.
    """

    def __init__(self, ctx: moderngl.Context):
        self._ctx = ctx
        self.pictures = Pictures(ctx)
        self.instances = InstanceTables(ctx)
        self.made = 0
        self._kept: dict[Table, tuple[tuple[Any, ...], moderngl.Texture]] = {}
        self._found: tuple[object, Plan, dict[tuple[str, ...], Mapping[str, _Texture]]] | None = None  # in the frame of that name

    def of(self, plug_ins: Iterable[PlugIn], scene: Scene) -> dict[str, moderngl.Texture]:
        """Sampler's name → texture of all tables that `plug_ins` declare and all pictures that their parameters name, as `scene` wants them.

        Raises:
            CatalogueError: a header names what is not there, or what makes no table.
            SceneError: a picture cannot be used.
        """
        plug_ins = tuple(plug_ins)
        made = {table.name: self._texture(table, scene) for plug_in in plug_ins for table in plug_in.tables}
        return {**made, **self.pictures.of(plug_ins, scene)}

    def of_slots(self, inputs: FrameInputs, slots: tuple[str, ...]) -> Mapping[str, _Texture]:
        """The same of the plug-ins of `slots` that `inputs` use, looked for once in a frame."""
        return self._once(inputs, slots, lambda: self.of(chosen(inputs.plan, *slots), inputs.plan.scene))

    def of_instances(self, inputs: FrameInputs) -> Mapping[str, _Texture]:
        """Sampler's name → table of the things and media of `inputs`, and of the lamps; and the array of their pictures."""
        tables = self.instances.samplers(inputs.plan, inputs.time, inputs.frame)
        return {**tables, **self._once(inputs, ("pictures",), lambda: self.pictures.of_instances(inputs.plan.scene))}

    def bind(self, rays: Draw, others: Samplers = MappingProxyType({})) -> None:
        """Gives the trace pass `rays` the tables and pictures of its plug-ins, and `others` by their samplers' names."""
        rays.sample({**self.of_slots(rays.inputs, RAY_SLOTS), **others}, RAY_UNIT)

    def release(self) -> None:
        """Gives the GL objects back."""
        self.pictures.release()
        self.instances.release()
        for _, texture in self._kept.values():
            texture.release()
        self._kept, self._found = {}, None

    def _once(self, inputs: FrameInputs, what: tuple[str, ...], look: Callable[[], Mapping[str, _Texture]]) -> Mapping[str, _Texture]:
        """`what` a frame's plan uses, by its samplers' names: a file is looked at once, so that no texture is made anew within a frame."""
        if self._found is None or self._found[0] is not inputs.frame or self._found[1] is not inputs.plan:
            self._found = inputs.frame, inputs.plan, {}
        found = self._found[2]
        if what not in found:
            found[what] = look()
        return found[what]

    def _texture(self, table: Table, scene: Scene) -> moderngl.Texture:
        arguments = table.arguments(scene)
        kept = self._kept.get(table)
        if kept is not None and kept[0] == arguments:
            return kept[1]
        texture = _filled(self._ctx, table, _levels(table, arguments), kept[1] if kept else None)
        self._kept[table] = arguments, texture
        self.made += 1
        return texture


def _levels(table: Table, arguments: tuple[Any, ...]) -> list[np.ndarray]:
    """What the table holds, and where its maker says so its smaller levels.

    Raises:
        CatalogueError: it is not what a texture can hold.
    """
    made = table.made(arguments)
    levels = list(made) if isinstance(made, tuple) else [made]
    for number, values in enumerate(levels):
        if not isinstance(values, np.ndarray) or values.ndim != 3 or not 1 <= values.shape[2] <= 4 or values.dtype not in _DTYPES:
            found = f"{values.dtype} {values.shape}" if isinstance(values, np.ndarray) else type(values).__name__
            raise CatalogueError(f"{table.place}: {table.make} made {found}; allowed is an array (rows, columns, 1 to 4) of uint8, float16 or float32")
        wanted = *(max(size >> number, 1) for size in levels[0].shape[:2]), levels[0].shape[2]
        if number and (table.filter != "mipmap" or values.shape != wanted or values.dtype != levels[0].dtype):
            found = f"level {number} as {values.dtype} {values.shape}"
            raise CatalogueError(f"{table.place}: {table.make} made {found}; allowed, with the filter mipmap, is {levels[0].dtype} {wanted}")
    return [np.ascontiguousarray(values) for values in levels]


def _filled(ctx: moderngl.Context, table: Table, levels: list[np.ndarray], old: moderngl.Texture | None) -> moderngl.Texture:
    """`levels` in the texture `old`, or in a new one where it does not fit."""
    values = levels[0]
    rows, columns, components = values.shape
    dtype = _DTYPES[values.dtype]
    if old is not None and (old.size, old.components, old.dtype) == ((columns, rows), components, dtype):
        texture = old
        texture.write(values.tobytes(), alignment=1)
    else:
        if old is not None:
            old.release()
        texture = ctx.texture((columns, rows), components, values.tobytes(), dtype=dtype, alignment=1)
    if table.filter == "mipmap":
        mip_levels.build(ctx, texture, values, levels[1:])
    texture.filter = _FILTERS[table.filter]
    texture.repeat_x, texture.repeat_y = table.repeat_x, False
    return texture
