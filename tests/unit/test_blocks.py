"""The bytes of a uniform block lie where std140 puts them."""

from __future__ import annotations

import numpy as np
import pytest

from blackhole_gl.glsl.blocks import Block
from blackhole_gl.planning import plan
from blackhole_gl.rendering import uniforms
from blackhole_gl.scene import catalogue, presets


def test_offsets_follow_std140():
    block = Block("B", 0, (("a", "float"), ("b", "vec2"), ("c", "float"), ("d", "vec4"), ("e", "int"), ("m", "mat4")))
    offsets = {name: block.dtype.fields[name][1] for name in block.dtype.names}
    assert offsets == {"a": 0, "b": 8, "c": 16, "d": 32, "e": 48, "m": 64}
    assert block.dtype.itemsize == 128


def test_a_small_block_still_fills_sixteen_bytes():
    assert Block("B", 0, (("a", "float"),)).dtype.itemsize == 16


def test_matrices_are_stored_by_columns():
    block = Block("B", 0, (("m", "mat4"),))
    rows = np.arange(16.0).reshape(4, 4)
    np.testing.assert_array_equal(np.frombuffer(block.pack({"m": rows}), np.float32).reshape(4, 4), rows.T)


def test_declaration_and_bytes_come_from_one_list():
    block = Block("Numbers", 3, (("size", "vec2"), ("count", "int")))
    assert block.glsl == "layout(std140) uniform Numbers {\n    vec2 size;\n    int count;\n};"
    record = np.frombuffer(block.pack({"size": (1.0, 2.0), "count": 7}), block.dtype)[0]
    assert tuple(record["size"]) == (1.0, 2.0) and record["count"] == 7


def test_a_missing_member_is_an_error():
    with pytest.raises(KeyError, match="count"):
        Block("B", 0, (("count", "int"),)).pack({})


def test_the_driver_agrees_about_every_offset(ctx):
    """Each member of each block, read back through a shader: the one test of std140 that counts."""
    for block in (uniforms.ray_block(), uniforms.shade_block(), uniforms.scene_block()):
        rng = np.random.default_rng(1)
        values, reads, expected = {}, [], []
        for name, kind in block.members:
            shape = {"float": (), "int": (), "vec2": (2,), "vec4": (4,), "mat4": (4, 4)}[kind]
            values[name] = rng.integers(1, 1000, shape)
            if kind == "mat4":  # row r, column c of the host is [c][r] in GLSL
                reads += [f"{name}[{c}][{r}]" for r in range(4) for c in range(4)]
            else:
                reads += [f"float({name})"] if shape == () else [f"{name}[{k}]" for k in range(shape[0])]
            expected += np.ravel(values[name]).tolist()
        assignments = "\n".join(f"if (place == {k}) found = {read};" for k, read in enumerate(reads))
        program = ctx.program(
            vertex_shader="#version 330 core\nvoid main() { gl_Position = vec4(vec2((gl_VertexID & 1) * 4 - 1, (gl_VertexID & 2) * 2 - 1), 0.0, 1.0); }",
            fragment_shader=f"#version 330 core\n{block.glsl}\nout float found;\n"
            f"void main() {{ int place = int(gl_FragCoord.x); found = 0.0;\n{assignments}\n}}",
        )
        buffer = ctx.buffer(block.pack(values))
        program[block.name].binding = 5
        buffer.bind_to_uniform_block(5)
        target = ctx.framebuffer([ctx.texture((len(reads), 1), 1, dtype="f4")])
        target.use()
        ctx.vertex_array(program, []).render(vertices=3)
        assert np.frombuffer(target.color_attachments[0].read(), np.float32).tolist() == expected


def test_one_number_of_packed_bytes_is_changed_alone():
    block = Block("B", 0, (("a", "float"), ("count", "int"), ("v", "vec2")))
    values = {"a": 1.5, "count": 3, "v": (2.0, 4.0)}
    assert block.changed(block.pack(values), "a", 7.0) == block.pack({**values, "a": 7.0})
    assert block.changed(block.pack(values), "v", (5.0, 6.0)) == block.pack({**values, "v": (5.0, 6.0)})


@pytest.mark.parametrize(
    "slot, key, switch, other",
    [("disk_layer", "hot_spot", {"disk.hot_spot": True}, {"disk.hot_spot": False}), ("sky", "drifting_field", {"sky.model": "drifting_field"}, {})],
)
def test_numbers_of_a_plug_in_are_made_where_it_is_used(slot, key, switch, other):
    """Its shader text is in no other program."""
    used, unused = plan(presets.load(["kerr"], switch)), plan(presets.load(["kerr"], other))
    made, nothing = uniforms.shade_values(used, 3.0), uniforms.shade_values(unused, 3.0)
    for number in catalogue.plug_ins(slot)[key].numbers:
        np.testing.assert_array_equal(made[number.name], number.at(used.scene, 3.0))
        assert not np.any(nothing[number.name])
