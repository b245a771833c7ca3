"""Shader files through the real driver: where a mistake is reported, and what stays on the screen meanwhile."""

from __future__ import annotations

import os
import shutil
from collections.abc import Iterable
from pathlib import Path

import moderngl
import numpy as np
import pytest

from blackhole_gl import planning
from blackhole_gl.glsl.compose import ShaderError
from blackhole_gl.output import cache
from blackhole_gl.rendering.frame import Renderer
from blackhole_gl.rendering.hit_map import HitMap
from blackhole_gl.rendering.inputs import FrameInputs
from blackhole_gl.rendering.programs import Programs
from blackhole_gl.resources import shaders_dir
from blackhole_gl.scene import Scene, catalogue, fields, presets
from tests.portability.every_program import pairs

SCENE = presets.load(["kerr"])
INPUTS = FrameInputs.whole(planning.plan(SCENE), 0.0, (18, 10))


@pytest.fixture
def copy(tmp_path: Path) -> Path:
    """A copy of the shaders that a test may spoil."""
    return Path(shutil.copytree(shaders_dir(), tmp_path / "shaders"))


def edit(path: Path, old: str, new: str) -> int:
    """Replaces `old`, which occurs, by `new`; returns its line. The file's time moves on whatever the clock's grain."""
    text = path.read_text(encoding="utf-8")
    assert old in text
    path.write_text(text.replace(old, new, 1), encoding="utf-8")
    later = path.stat().st_mtime_ns + 10**9
    os.utime(path, ns=(later, later))
    return text[: text.index(old)].count("\n") + 1


def test_a_mistake_names_the_authors_file_and_line(ctx: moderngl.Context, copy: Path) -> None:
    line = edit(copy / "ray_models" / "kerr.glsl", "float a = RAY_SPIN;", "float a = RAY_SPINN;")
    with pytest.raises(ShaderError, match="RAY_SPINN") as caught:
        Programs(ctx, copy).get("trace.frag", INPUTS)
    assert (caught.value.file, caught.value.line) == ("ray_models/kerr.glsl", line)


def test_a_mistake_after_switches_and_blocks_keeps_its_line(ctx: moderngl.Context, copy: Path) -> None:
    line = edit(copy / "trace.frag", "store_hits(trace_ray", "store_hit(trace_ray")
    with pytest.raises(ShaderError) as caught:
        Programs(ctx, copy).get("trace.frag", INPUTS)
    assert (caught.value.file, caught.value.line) == ("trace.frag", line)


def test_reload_takes_up_a_change_and_survives_a_mistake(ctx: moderngl.Context, copy: Path) -> None:
    programs = Programs(ctx, copy)
    good = programs.get("trace.frag", INPUTS)
    assert programs.reload() == [] and programs.get("trace.frag", INPUTS).serial == good.serial

    path = copy / "common" / "radial_mino.glsl"
    line = edit(path, "if (s.w <= 0.0) return ESCAPED;", "if (s.w <= 0.0) return ESCAPE;")
    (error,) = programs.reload()
    assert (error.file, error.line) == ("common/radial_mino.glsl", line) and "ESCAPE" in error.message
    assert programs.get("trace.frag", INPUTS).serial == good.serial, "the last good program goes on"
    assert [str(e) for e in programs.reload()] == [str(error)], "the mistake stands until it is mended"

    edit(path, "return ESCAPE;", "return CAPTURED;")
    assert programs.reload() == []
    changed = programs.get("trace.frag", INPUTS)
    assert changed.serial != good.serial


def test_texts_of_an_earlier_start_are_those_of_the_files_as_they_are(
    ctx: moderngl.Context, copy: Path, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(cache, "user_cache_dir", lambda: tmp_path / "cache")
    composed = []

    def text(root: Path) -> str:
        programs = Programs(ctx, root)
        anew = programs._composed_anew
        monkeypatch.setattr(programs, "_composed_anew", lambda *recipe: composed.append(recipe) or anew(*recipe))
        return programs._compose("trace.frag", programs._structure(INPUTS.plan), ()).fragment

    first = text(copy)
    elsewhere = Path(shutil.copytree(copy, tmp_path / "elsewhere"))
    assert text(copy) == text(elsewhere) == first and len(composed) == 1
    path = elsewhere / "common" / "radial_mino.glsl"
    seen = path.stat()
    edit(path, "return ESCAPED;", "return ESCAPER;")
    os.utime(path, ns=(seen.st_atime_ns, seen.st_mtime_ns))  # neither its time nor its size tells
    assert text(elsewhere) == first.replace("return ESCAPED;", "return ESCAPER;", 1) and len(composed) == 2
    edit(path, "return ESCAPER;", "return ESCAPED;")
    assert text(elsewhere) == first and len(composed) == 2


def test_a_file_that_changes_while_it_is_composed_is_not_kept(ctx: moderngl.Context, copy: Path, tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(cache, "user_cache_dir", lambda: tmp_path / "cache")
    programs = Programs(ctx, copy)
    programs.get("trace.frag", INPUTS)
    edit(copy / "post" / "bloom_up.frag", "void main()", "void main( )")
    programs.get("post/bloom_up.frag", INPUTS)  # not reloaded yet
    assert len(list((tmp_path / "cache" / "programs").iterdir())) == 1


def test_a_mistake_of_the_drivers_in_a_kept_text_names_its_place(ctx: moderngl.Context, copy: Path, tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(cache, "user_cache_dir", lambda: tmp_path / "cache")
    line = edit(copy / "trace.frag", "store_hits(trace_ray", "store_hit(trace_ray")
    for _ in range(2):
        with pytest.raises(ShaderError) as caught:
            Programs(ctx, copy).get("trace.frag", INPUTS)
        assert (caught.value.file, caught.value.line) == ("trace.frag", line)


def test_a_missing_include_is_reported_where_it_is_asked_for(ctx: moderngl.Context, copy: Path) -> None:
    programs = Programs(ctx, copy)
    programs.get("trace.frag", INPUTS)
    line = edit(copy / "trace.frag", '#include "common/hits.glsl"', '#include "common/hit.glsl"')
    (error,) = programs.reload()
    assert (error.file, error.line) == ("trace.frag", line)


def test_a_reloaded_shader_changes_the_picture_and_traces_anew(ctx: moderngl.Context, copy: Path) -> None:
    renderer = Renderer(ctx)
    renderer.programs = Programs(ctx, copy)
    renderer.hit_map = HitMap(ctx, renderer.programs, renderer.hit_map.tables)
    renderer.render(SCENE, 0.0, (18, 10))
    assert np.any(renderer.hits().fate == 1)
    edit(copy / "common" / "radial_mino.glsl", "if (s.w <= 0.0) return ESCAPED;", "if (s.w <= 0.0) return CAPTURED;")
    assert renderer.programs.reload() == []
    assert renderer.render(SCENE, 0.0, (18, 10)).traced
    assert np.all(renderer.hits().fate == 2)
    renderer.release()


def test_sliders_never_compile(renderer: Renderer, monkeypatch: pytest.MonkeyPatch) -> None:
    wide = {"disk.outer_radius": 20.0}  # its inner edge may then be as far out as it may be at all
    scene = presets.load(["kerr", "blackholegpu_medium"], {"rays.model": "kerr", **wide})  # a method stated in full
    renderer.render(scene, 0.0, (18, 10))
    compiled = []
    compose = renderer.programs._compose
    monkeypatch.setattr(renderer.programs, "_compose", lambda *recipe: compiled.append(recipe) or compose(*recipe))
    for key, item in fields().items():
        if item.kind in ("float", "int") and key not in ("rays.orders", "disk.tilt_deg"):  # structure: how many crossings, and whether the plane is level
            renderer.render(scene.with_values({key: item.high}), 0.0, (18, 10))
    assert compiled == []


@pytest.mark.parametrize("model", catalogue.keys("ray_model"))
def test_every_model_compiles_and_gives_every_ray_a_fate(renderer: Renderer, model: str) -> None:
    """By its own method. Each part is tried with every model of a hole by `test_method_pairs.py`, and here with one model of what is none."""
    own = "rk4", catalogue.plug_ins("ray_model")[model].traits.step_control or "radius"
    check_fates(renderer, model, pairs(model) if model == "lorenz" else [own])


@pytest.mark.slow
@pytest.mark.parametrize("model", [key for key, model in catalogue.plug_ins("ray_model").items() if model.traits.kind != "closed"])
def test_combinations_that_fit_compile_and_give_every_ray_a_fate(renderer: Renderer, model: str) -> None:
    check_fates(renderer, model, pairs(model, every_pair=True))


def check_fates(renderer: Renderer, model: str, methods: Iterable[tuple[str, str]]) -> None:
    """No pixel's ray is left without one, and there are rays of each."""
    for integrator, control in methods:
        changes = {"rays.model": model, "rays.integrator": integrator, "rays.step_control": control, "rays.max_steps": 4000, "camera.fov_deg": 15.0}
        renderer.render(SCENE.with_values(changes), 0.0, (24, 14))
        hits = renderer.hits()
        assert np.count_nonzero(hits.fate == 0) == 0, (integrator, control)
        assert np.all(np.isfinite(hits.direction)) and np.any(hits.fate == 1), (integrator, control)
        assert np.any(hits.fate == 2) or catalogue.plug_ins("ray_model")[model].traits.field, (integrator, control)


@pytest.mark.parametrize("key", [key for key, item in fields().items() if item.kind in ("switch", "choice")])
def test_every_option_draws(renderer: Renderer, key: str) -> None:
    item = fields()[key]
    for value in (False, True) if item.kind == "switch" else item.options:
        try:
            renderer.render(Scene().with_values({key: value}), 1.0, (18, 10))
        except ValueError as error:  # a refusal is a sentence that names the key
            assert key.split(".")[0] in str(error)
            continue
        assert np.all(np.isfinite(renderer.radiance())), value
