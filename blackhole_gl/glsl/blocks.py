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
    def _offsets(self) -> tuple[int, ...]:
        """Of each member, in bytes, and of the block's end."""
        offsets, end = [], 0
        for _, kind in self.members:
            alignment, size, _, _ = _LAYOUT[kind]
            offsets.append(-(-end // alignment) * alignment)
            end = offsets[-1] + size
        return *offsets, max(16, -(-end // 16) * 16)

    @cached_property
    def dtype(self) -> np.dtype:
        """The structured dtype of one block, padded to 16 bytes as std140 asks."""
        *offsets, end = self._offsets
        formats = [_LAYOUT[kind][2:] for _, kind in self.members]
        return np.dtype({"names": [name for name, _ in self.members], "formats": formats, "offsets": offsets, "itemsize": end})

    @property
    def glsl(self) -> str:
        """The block's GLSL declaration."""
        lines = [f"    {kind} {name};" for name, kind in self.members]
        return "\n".join([f"layout(std140) uniform {self.name} {{", *lines, "};"])

    def pack(self, values: Mapping[str, Any]) -> bytes:
        """The block's bytes. Matrices are given as rows and stored as the columns that GLSL expects.

        Raises:
            KeyError: `values` lacks a member.
            ValueError: a vector has more or fewer numbers than its member.
        """
        numbers: list[float] = []
        whole: list[int] = []
        for name, kind in self.members:
            value = values[name]
            if kind == "float":
                numbers.append(value)
            elif kind == "int":
                whole.append(value)
            else:
                numbers.extend(np.asarray(value).T.ravel().tolist() if kind == "mat4" else value)
        of_numbers, of_whole = self._words
        words = np.zeros(self._offsets[-1] // 4, np.float32)
        words[of_numbers] = numbers
        words.view(np.int32)[of_whole] = whole
        return words.tobytes()

    def changed(self, packed: bytes, name: str, value: Any) -> bytes:
        """The block's bytes `packed` with another number, or vector, for the member of that name."""
        made = np.frombuffer(packed, self.dtype).copy()
        made[name] = value
        return made.tobytes()

    @cached_property
    def _words(self) -> tuple[np.ndarray, np.ndarray]:
        """Which of the block's words hold floats, and which whole numbers, in the order of `members`: a frame packs hundreds of them at once."""
        numbers: list[int] = []
        whole: list[int] = []
        for (_, kind), offset in zip(self.members, self._offsets):
            _, size, base, _ = _LAYOUT[kind]
            (whole if base is np.int32 else numbers).extend(range(offset // 4, (offset + size) // 4))
        return np.array(numbers, int), np.array(whole, int)
