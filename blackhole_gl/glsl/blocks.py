"""One declaration → a NumPy dtype and a GLSL std140 uniform block, so that host and shader cannot disagree."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from functools import cached_property
from typing import Any

import numpy as np

_LAYOUT = {
    # type: (alignment and size in bytes by std140, NumPy base, shape)
    "float": (4, 4, np.float32, ()),
    "int": (4, 4, np.int32, ()),
    "vec2": (8, 8, np.float32, (2,)),
    "vec4": (16, 16, np.float32, (4,)),
    "mat4": (16, 64, np.float32, (4, 4)),
}


@dataclass(frozen=True)
class Block:
    """A std140 uniform block.

    Attributes:
        name: the GLSL block's name.
        binding: the uniform buffer binding point.
        members: (name, GLSL type) pairs; types are float, int, vec2, vec4, mat4.
    """

    name: str
    binding: int
    members: tuple[tuple[str, str], ...]

    @cached_property
    def dtype(self) -> np.dtype:
        """The structured dtype of one block, padded to 16 bytes as std140 asks."""
        names, formats, offsets, end = [], [], [], 0
        for name, kind in self.members:
            alignment, size, base, shape = _LAYOUT[kind]
            start = -(-end // alignment) * alignment
            names.append(name)
            formats.append((base, shape))
            offsets.append(start)
            end = start + size
        return np.dtype({"names": names, "formats": formats, "offsets": offsets, "itemsize": max(16, -(-end // 16) * 16)})

    @property
    def glsl(self) -> str:
        """The block's GLSL declaration."""
        lines = [f"    {kind} {name};" for name, kind in self.members]
        return "\n".join([f"layout(std140) uniform {self.name} {{", *lines, "};"])

    def pack(self, values: Mapping[str, Any]) -> bytes:
        """The block's bytes. Matrices are given as rows and stored as the columns that GLSL expects.

        Raises:
            KeyError: `values` lacks a member.
        """
        record = np.zeros((), self.dtype)
        for name, kind in self.members:
            value = np.asarray(values[name])
            record[name] = value.T if kind == "mat4" else value
        return record.tobytes()
