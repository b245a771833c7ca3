"""Numbers of the uniform blocks, and loose ones that a fragment shader declares, carried to the fragment shader as flat inputs that the vertex shader fills.

They are the same for all pixels either way, but uniforms are dear on software renderers (docs/llvmpipe.md): a flat input costs a twentieth.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

from .blocks import Block
from .live import Words

MOST_INPUTS = 15
"""vec4 inputs of a fragment shader that every driver of GL 3.3 has room for (GL_MAX_VARYING_COMPONENTS is 60 at least)."""

_NO_WORDS = Words(frozenset(), frozenset())

_FLOATS = {"float": 1, "int": 1, "vec2": 2, "vec4": 4, "mat4": 16}


@dataclass(frozen=True)
class Carried:
    """How the numbers that one program mentions reach it.

    Attributes:
        fragment: GLSL that stands for the blocks in the fragment shader: each number has its name there.
        vertex: GLSL for the vertex shader: the blocks and ``void carry()``, which fills the inputs.
    """

    fragment: str
    vertex: str


def carry(blocks: Sequence[Block], words: Words, own: Words = _NO_WORDS) -> Carried:
    """Numbers of `blocks` that `words` name, and loose ones: those that are run as inputs as far as there is room; the rest the fragment shader reads itself.

    Args:
        words: of the fragment shader.
        own: of the vertex shader, which reads its own numbers from the blocks.
    """
    mentioned = {name: kind for block in blocks for name, kind in block.members if name in words.compiled}
    numbers = [*words.loose, *((name, kind) for name, kind in mentioned.items() if name in words.run)]
    used = sorted(numbers, key=lambda member: -_FLOATS[member[1]])
    room, taken = 4 * MOST_INPUTS, 0
    defines, moves = [], []
    for name, kind in used:
        size = _FLOATS[kind]
        if taken + size > room:
            continue
        columns = [_place(taken + k, min(size, 4)) for k in range(0, size, 4)]
        moves += [f"    {column} = {name}{f'[{k}]' if kind == 'mat4' else ''};" for k, column in enumerate(columns)]
        defines.append(f"#define {name} {_as_given(kind, columns)}")
        taken += size
    count = -(-taken // 4)
    carried = {line.split()[1] for line in defines}
    left_out = mentioned.keys() - carried
    kept = [block for block in blocks if any(name in left_out for name, _ in block.members)]
    fragment = [block.glsl for block in kept]
    fragment += [f"flat in vec4 carried_{k};" for k in range(count)] + defines
    vertex = [block.glsl for block in blocks if any(name in words.run | own.run for name, _ in block.members)]
    vertex += [f"uniform {kind} {name};" for name, kind in words.loose if name in carried and (name, kind) not in own.loose]
    vertex += [f"flat out vec4 carried_{k};" for k in range(count)] + ["void carry() {", *moves, "}"]
    return Carried("\n".join(fragment), "\n".join(vertex))


def _place(index: int, size: int) -> str:
    """The swizzle that holds `size` floats from the `index`-th on; sizes come in falling order, so that none straddles two inputs."""
    return f"carried_{index // 4}.{'xyzw'[index % 4 : index % 4 + size]}"


def _as_given(kind: str, columns: list[str]) -> str:
    if kind == "mat4":
        return f"mat4({', '.join(columns)})"
    return f"int({columns[0]})" if kind == "int" else columns[0]
