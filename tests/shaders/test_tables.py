"""Textures that plug-ins declare: as the header says, made anew when what they depend on changes, errors that name file and entry."""

from __future__ import annotations

from dataclasses import replace

import moderngl
import numpy as np
import pytest

from blackhole_gl.physics import orbit_table
from blackhole_gl.rendering import mip_levels, star_index
from blackhole_gl.rendering.tables import Tables
from blackhole_gl.scene import Scene, catalogue
from blackhole_gl.scene import tables as catalogue_tables
from blackhole_gl.scene.catalogue import CatalogueError
from blackhole_gl.scene.tables import Number, Table

ORBIT = Table("orbit_table", "mine.glsl", "blackhole_gl.physics.orbit_table:table", ("camera.distance",))
PLUG_IN = catalogue.plug_ins("sky")["procedural"]


def declaring(*tables: Table) -> list[catalogue.PlugIn]:
    return [replace(PLUG_IN, tables=tables)]


def test_a_table_is_what_its_function_makes(ctx: moderngl.Context) -> None:
    tables = Tables(ctx)
    texture = tables.of(declaring(ORBIT), Scene())["orbit_table"]
    values = np.frombuffer(texture.read(), np.float32).reshape(2, orbit_table.WIDTH, 4)
    np.testing.assert_array_equal(values, orbit_table.table(Scene().camera.distance))
    assert texture.filter == (moderngl.NEAREST, moderngl.NEAREST) and not texture.repeat_x and not texture.repeat_y
    tables.release()


def test_the_skys_tables_are_filtered_as_its_header_says(ctx: moderngl.Context) -> None:
    tables = Tables(ctx)
    made = tables.of([PLUG_IN], Scene())
    assert list(made) == ["galaxy_band", "star_cells"]
    band, stars = made.values()
    assert (band.dtype, band.components, band.filter, band.repeat_x) == ("f1", 3, (moderngl.LINEAR_MIPMAP_LINEAR, moderngl.LINEAR), True)
    assert (stars.dtype, stars.components, stars.filter, stars.repeat_x) == ("f4", 4, (moderngl.NEAREST, moderngl.NEAREST), False)
    tables.release()


READ_LEVEL = """#version 330 core
uniform sampler2D given; uniform int level; out vec4 found;
void main() { found = texelFetch(given, ivec2(gl_FragCoord.xy), level); }"""
WHOLE = "#version 330 core\nvoid main() { gl_Position = vec4(4.0 * (gl_VertexID & 1) - 1.0, 2.0 * (gl_VertexID & 2) - 1.0, 0.0, 1.0); }"


@pytest.mark.parametrize("dtype, components", [(np.uint8, 3), (np.uint8, 1), (np.float16, 4), (np.float32, 2)])
def test_mip_levels_are_means_and_no_driver_is_asked_for_them(ctx: moderngl.Context, monkeypatch: pytest.MonkeyPatch, dtype: type, components: int) -> None:
    """llvmpipe takes 80 ms for its first ones in a process."""
    monkeypatch.setattr(moderngl.Texture, "build_mipmaps", lambda *_: pytest.fail("the driver was asked"))
    values = (np.random.default_rng(3).random((24, 32, components)) * (200 if dtype is np.uint8 else 1)).astype(dtype)
    _ = ctx.error  # of what came before
    texture = ctx.texture((32, 24), components, values.tobytes(), dtype=f"f{values.itemsize}", alignment=1)
    mip_levels.build(ctx, texture, values)
    texture.filter = (moderngl.NEAREST_MIPMAP_NEAREST, moderngl.NEAREST)
    program = ctx.program(vertex_shader=WHOLE, fragment_shader=READ_LEVEL)
    for level, (width, height) in ((1, (16, 12)), (2, (8, 6)), (3, (4, 3)), (4, (2, 1)), (5, (1, 1))):
        target = ctx.framebuffer([ctx.texture((width, height), 4, dtype="f4")])
        target.use()
        texture.use()
        program["level"] = level
        ctx.vertex_array(program, []).render(moderngl.TRIANGLES, vertices=3)
        found = np.frombuffer(target.read(components=components, dtype="f4"), np.float32).reshape(height, width, components)
        covered = values if level < 4 else values[8:16]  # of three rows the middle one
        exact = covered.astype(float).reshape(height, covered.shape[0] // height, width, 32 // width, components).mean(axis=(1, 3))
        if dtype is np.uint8:  # halves go up, twice a level: a quarter to a half in the mean, one at most
            assert 0.0 <= (255.0 * found - exact).mean() < 0.6 * level and np.abs(255.0 * found - exact).max() < level + 1e-3
        else:
            np.testing.assert_allclose(found, exact, atol=1e-3)  # float16 has 11 bits, and each level is rounded
    assert ctx.error == "GL_NO_ERROR"
    texture.release()


def test_a_table_may_bring_its_own_levels(ctx: moderngl.Context) -> None:
    """Under them are means of the last."""
    levels = [np.full((8 >> k, 16 >> k, 1), 0.1 + 0.2 * k, np.float32) for k in range(3)]
    texture = ctx.texture((16, 8), 1, levels[0].tobytes(), dtype="f4")
    mip_levels.build(ctx, texture, levels[0], levels[1:])
    texture.filter = (moderngl.NEAREST_MIPMAP_NEAREST, moderngl.NEAREST)
    program = ctx.program(vertex_shader=WHOLE, fragment_shader=READ_LEVEL)
    target = ctx.framebuffer([ctx.texture((1, 1), 4, dtype="f4")])
    target.use()
    for level in range(5):
        texture.use()
        program["level"] = level
        ctx.vertex_array(program, []).render(moderngl.TRIANGLES, vertices=3)
        found = np.frombuffer(target.read(components=1, dtype="f4"), np.float32)
        assert found[0] == pytest.approx(0.1 + 0.2 * min(level, 2))
    texture.release()


@pytest.mark.parametrize("second", [(4, 4, 1), (8, 16, 1), (4, 8, 2)])
def test_a_level_of_another_size_is_refused_by_its_number(ctx: moderngl.Context, monkeypatch: pytest.MonkeyPatch, second: tuple[int, ...]) -> None:
    monkeypatch.setattr(star_index, "haze", lambda: (np.zeros((8, 16, 1), np.float32), np.zeros(second, np.float32)))
    catalogue_tables._function.cache_clear()
    own = replace(ORBIT, name="own_levels", make="blackhole_gl.rendering.star_index:haze", of=(), filter="mipmap")
    with pytest.raises(CatalogueError, match=r"mine.glsl: own_levels: .* made level 1 as float32 .*; allowed, with the filter mipmap, is float32 \(4, 8, 1\)"):
        Tables(ctx).of(declaring(own), Scene())
    catalogue_tables._function.cache_clear()


def test_a_table_is_made_anew_when_what_it_depends_on_changes_and_only_then(ctx: moderngl.Context) -> None:
    tables, near, far = Tables(ctx), Scene(), Scene().with_values({"camera.distance": 30.0})
    first = tables.of(declaring(ORBIT), near)["orbit_table"]
    assert tables.of(declaring(ORBIT), near.with_values({"camera.fov_deg": 10.0}))["orbit_table"] is first and tables.made == 1
    tables.of(declaring(replace(ORBIT, file="another.glsl")), near)
    assert tables.made == 1, "two plug-ins that declare the same table share it"
    again = tables.of(declaring(ORBIT), far)["orbit_table"]
    assert again is first and tables.made == 2, "the same texture holds the new values"
    np.testing.assert_array_equal(np.frombuffer(again.read(), np.float32).reshape(2, -1, 4), orbit_table.table(30.0))
    tables.release()


@pytest.mark.parametrize(
    "change, words",
    [
        ({"make": "blackhole_gl.physics.orbit_table:tabel"}, "mine.glsl: orbit_table: make: blackhole_gl.physics.orbit_table:tabel cannot be found"),
        ({"make": "blackhole_gl.physics.nowhere:table"}, "make: blackhole_gl.physics.nowhere:table cannot be found"),
        ({"make": "os:getcwd", "of": ()}, "make: got 'os:getcwd'; allowed is blackhole_gl.MODULE:NAME"),
        ({"of": ("camera.distanse",)}, r"of: got 'camera.distanse'; allowed are keys of a scene; did you mean camera.distance\?"),
        ({"of": ()}, "make: blackhole_gl.physics.orbit_table:table cannot be called with the 0 values of `of`: missing a required argument"),
        ({"make": "blackhole_gl.physics.orbit_table:CELLS"}, "make: blackhole_gl.physics.orbit_table:CELLS cannot be called"),
        ({"make": "blackhole_gl.physics.orbit_table:edge_tangent"}, r"edge_tangent made float64; allowed is an array \(rows, columns, 1 to 4\)"),
    ],
)
def test_a_declaration_that_makes_no_table_names_file_and_entry(ctx: moderngl.Context, change: dict, words: str) -> None:
    with pytest.raises(CatalogueError, match=words):
        Tables(ctx).of(declaring(replace(ORBIT, **change)), Scene())


def test_constants_have_to_be_whole_numbers() -> None:
    assert replace(ORBIT, constants="blackhole_gl.physics.orbit_table:CONSTANTS").defines() == {"ORBIT_CELL_BITS": 19, "ORBIT_FIRST_CELL": 1648}
    with pytest.raises(CatalogueError, match="mine.glsl: orbit_table: constants: blackhole_gl.physics.orbit_table:CELLS is no mapping"):
        replace(ORBIT, constants="blackhole_gl.physics.orbit_table:CELLS").defines()


def test_whatever_shipped_headers_name_is_there() -> None:
    declared = [made for slot in catalogue.SLOTS for plug_in in catalogue.plug_ins(slot).values() for made in (*plug_in.tables, *plug_in.numbers)]
    assert {type(made) for made in declared} == {Table, Number}
    for made in declared:
        assert (made.at(Scene(), 1.0) if isinstance(made, Number) else made.made(made.arguments(Scene()))) is not None
        if isinstance(made, Table):
            assert all(name.isidentifier() for name in made.defines())
