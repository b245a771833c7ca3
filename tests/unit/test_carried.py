"""The host's numbers arrive in the fragment shader unchanged, as inputs or, where there is no room, from their block."""

from __future__ import annotations

import moderngl
import numpy as np
import pytest

from blackhole_gl.glsl.blocks import Block
from blackhole_gl.glsl.carried import MOST_INPUTS, carry
from blackhole_gl.glsl.live import Words

KINDS = {"float": (), "int": (), "vec2": (2,), "vec4": (4,), "mat4": (4, 4)}


BLOCKS = Block("A", 0, (("one", "float"), ("two", "vec2"))), Block("B", 1, (("three", "float"),))


def test_only_what_is_mentioned_is_carried() -> None:
    made = carry(BLOCKS, Words(frozenset({"two", "main"}), frozenset({"two", "main"})))
    assert "#define two carried_0.xy" in made.fragment and "one" not in made.fragment and "uniform" not in made.fragment
    assert "uniform A" in made.vertex and "uniform B" not in made.vertex


def test_what_no_call_reaches_is_declared_and_takes_no_room() -> None:
    made = carry(BLOCKS, Words(frozenset({"two", "three"}), frozenset({"two"})))
    assert "#define two carried_0.xy" in made.fragment and "three carried" not in made.fragment and "uniform B" in made.fragment
    assert "uniform B" not in made.vertex


@pytest.mark.parametrize("many", [1, 40])
def test_every_number_arrives_whole(ctx: moderngl.Context, many: int) -> None:
    """`many` floats beside one of each other kind: few enough to be carried, and too many."""
    block = Block(
        "Numbers", 0, (("single", "float"), ("m", "mat4"), ("count", "int"), ("pair", "vec2"), ("four", "vec4"), *((f"more_{k}", "float") for k in range(many)))
    )
    rng = np.random.default_rng(3)
    values = {name: rng.integers(-(2**23), 2**23, KINDS[kind]) for name, kind in block.members}
    made = carry((block,), Words(frozenset(values), frozenset(values)))
    assert made.fragment.count("flat in") <= MOST_INPUTS
    assert ("uniform" in made.fragment) == (many == 40)
    reads, expected = [], []
    for name, kind in block.members:
        if kind == "mat4":
            reads += [f"{name}[{c}][{r}]" for r in range(4) for c in range(4)]
        else:
            reads += [f"float({name})"] if KINDS[kind] == () else [f"{name}[{k}]" for k in range(KINDS[kind][0])]
        expected += np.ravel(values[name]).tolist()
    picks = "\n".join(f"if (place == {k}) found = {read};" for k, read in enumerate(reads))
    corner = "vec2((gl_VertexID & 1) * 4 - 1, (gl_VertexID & 2) * 2 - 1)"
    program = ctx.program(
        vertex_shader=f"#version 330 core\n{made.vertex}\nvoid main() {{ gl_Position = vec4({corner}, 0.0, 1.0); carry(); }}",
        fragment_shader=f"#version 330 core\n{made.fragment}\nout float found;\nvoid main() {{ int place = int(gl_FragCoord.x); found = 0.0;\n{picks}\n}}",
    )
    program["Numbers"].binding = 6
    buffer = ctx.buffer(block.pack(values))
    buffer.bind_to_uniform_block(6)
    target = ctx.framebuffer([ctx.texture((len(reads), 1), 1, dtype="f4")])
    target.use()
    ctx.disable(moderngl.BLEND | moderngl.DEPTH_TEST | moderngl.CULL_FACE)
    ctx.vertex_array(program, []).render(moderngl.TRIANGLES, vertices=3)
    np.testing.assert_array_equal(np.frombuffer(target.color_attachments[0].read(), np.float32), np.array(expected, np.float32))
