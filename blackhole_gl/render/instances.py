"""Things and media as shaders see them: for each kind a table with a row an instance, and GLSL that reads it by the parameters' names.

A slider writes into a table, and one instance more makes it longer: neither compiles anything.
"""

from __future__ import annotations

from collections.abc import Iterable

import moderngl
import numpy as np

from ..scene import Scene, met
from ..scene.plug_in import PlugIn
from ..scene.schema import Field, number_of

_NUMBERS = ("float", "int", "switch", "choice")
"""Kinds of parameters that shaders know; a choice is known by its place among the options."""


def glsl(kinds: Iterable[PlugIn]) -> str:
    """Declarations for shaders: ``thing_ball_count``, and ``thing_ball_radius(i)`` for each parameter of the kind `ball`."""
    lines: list[str] = []
    for kind in kinds:
        name = f"{kind.slot}_{kind.key}"
        lines += [f"uniform sampler2D {name}_table;", f"#define {name}_count textureSize({name}_table, 0).y"]
        for place, item in enumerate(_known(kind)):
            value = f"texelFetch({name}_table, ivec2({place // 4}, i), 0).{'xyzw'[place % 4]}"
            read = {"float": value, "switch": f"({value} > 0.5)"}.get(item.kind, f"int({value})")
            lines.append(f"#define {name}_{item.key}(i) {read}")
    return "\n".join(lines)


def switches(kinds: Iterable[PlugIn]) -> dict[str, int]:
    """Name → number: what tells the kinds of a scene apart in a hit, and which are opaque."""
    found: dict[str, int] = {}
    for number, kind in enumerate(kinds):
        name = f"{kind.slot}_{kind.key}".upper()
        found[name] = number
        if kind.slot == "thing":
            found[f"{name}_OPAQUE"] = int(kind.traits.opaque)
    return found


def used(scene: Scene) -> list[PlugIn]:
    """The kinds that `scene` has instances of, numbered as in `switches`."""
    return [kind for slot in met.SLOTS for kind in met.kinds(scene, slot)]


def key(scene: Scene) -> tuple:
    """What hits depend on here: every instance."""
    return tuple((slot, *met.instances(scene, slot)) for slot in met.SLOTS)


class InstanceTables:
    """The tables of the kinds in use."""

    def __init__(self, ctx: moderngl.Context):
        self._ctx = ctx
        self._kept: dict[str, tuple[bytes, moderngl.Texture]] = {}

    def samplers(self, scene: Scene) -> dict[str, moderngl.Texture]:
        """Sampler's name → table, as `scene` has them."""
        return {f"{kind.slot}_{kind.key}_table": self._texture(kind, _rows(scene, kind)) for kind in used(scene)}

    def release(self) -> None:
        """Gives the GL objects back."""
        for _, texture in self._kept.values():
            texture.release()
        self._kept = {}

    def _texture(self, kind: PlugIn, rows: np.ndarray) -> moderngl.Texture:
        name, data, size = f"{kind.slot}_{kind.key}", rows.tobytes(), (rows.shape[1], rows.shape[0])
        before, texture = self._kept.get(name, (None, None))
        if texture is None or texture.size != size:
            if texture is not None:
                texture.release()
            texture = self._ctx.texture(size, 4, data, dtype="f4")
            texture.filter = moderngl.NEAREST, moderngl.NEAREST
        elif data != before:
            texture.write(data)
        self._kept[name] = data, texture
        return texture


def _known(kind: PlugIn) -> list[Field]:
    return [item for item in kind.parameters.values() if item.kind in _NUMBERS]


def _rows(scene: Scene, kind: PlugIn) -> np.ndarray:
    """float32 (instances, columns, 4), at least one column."""
    items = _known(kind)
    instances = [instance for instance in met.instances(scene, kind.slot) if instance.kind == kind.key]
    rows = np.zeros((len(instances), 4 * max(-(-len(items) // 4), 1)), np.float32)
    for row, instance in zip(rows, instances):
        for place, item in enumerate(items):
            value = instance.values[item.key]
            row[place] = item.options.index(value) if isinstance(value, str) else number_of(value)
    return rows.reshape(len(instances), -1, 4)
