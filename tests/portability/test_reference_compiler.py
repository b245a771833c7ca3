"""Every program passes Khronos's reference compiler, which takes GLSL 330 core by its word where drivers are lenient.

The compiler is Debian's package glslang-tools. Where it is missing these tests fail with the line that installs it: a skip would hide it.
"""

from __future__ import annotations

import re
import shutil
import subprocess
from collections.abc import Mapping, Sequence
from pathlib import Path

import pytest

from blackhole_gl.glsl.carried import MOST_INPUTS
from blackhole_gl.glsl.live import live_words
from blackhole_gl.rendering import uniforms
from blackhole_gl.resources import shaders_dir
from tests.portability.every_program import collect, collect_methods
from tests.sampled import sampled

COMPILER = "glslangValidator"
MISSING = f"{COMPILER} is missing. Install it, then run the test again: sudo apt-get install -y --no-install-recommends glslang-tools"

Texts = Mapping[tuple[str, str], str]


@pytest.fixture(scope="module", params=sampled([3, 1], [3]), ids=lambda every: "all" if every == 1 else f"one in {every}")
def programs(request: pytest.FixtureRequest) -> Texts:
    """Of each shader file one in so many of what it is asked for, which is twenty seconds of composing when it is all."""
    return collect(every=request.param)


def complaints(texts: Sequence[tuple[str, str]], folder: Path) -> list[str]:
    """What the reference compiler says against `texts`, (suffix, GLSL) pairs: number of the text, line, message, and the line itself."""
    compiler = shutil.which(COMPILER)
    if compiler is None:
        pytest.fail(MISSING, pytrace=False)
    names = []
    for number, (suffix, text) in enumerate(texts):
        names.append(f"{number:04}.{suffix}")
        (folder / names[-1]).write_text(text, encoding="utf-8")
    done = subprocess.run([compiler, *names], cwd=folder, capture_output=True, text=True, timeout=100)
    found, current = [], 0
    for line in done.stdout.splitlines():
        if line.strip() in names:
            current = names.index(line.strip())
        elif error := re.match(r"(?:ERROR|WARNING): \d+:(\d+): (.*)", line):
            found.append(f"{current}: {error[2]}: {texts[current][1].splitlines()[int(error[1]) - 1].strip()}")
    assert done.returncode == 0 or found, f"{COMPILER} failed and named no place:\n{done.stdout[-2000:]}{done.stderr}"
    return found


@pytest.mark.glslang
def test_every_program_passes_the_reference_compiler(programs: Texts, tmp_path: Path) -> None:
    check(programs, tmp_path)


@pytest.mark.slow
@pytest.mark.glslang
def test_so_does_every_pair_of_integrator_and_step_control_with_every_model(tmp_path: Path) -> None:
    check(collect_methods(), tmp_path)


def check(programs: Texts, folder: Path) -> None:
    fragments = {fragment: name for (_, fragment), name in programs.items()}
    vertices = {vertex: name for (vertex, _), name in programs.items()}
    names = [*fragments.values(), *vertices.values()]
    found = complaints([*(("frag", text) for text in fragments), *(("vert", text) for text in vertices)], folder)
    told = [f"{names[int(line.partition(':')[0])]}: {line.partition(': ')[2]}" for line in found]
    assert not told, "\n".join(told[:20])


@pytest.mark.glslang
@pytest.mark.parametrize("line", ["float x = fma(1.0, 2.0, 3.0);", "int k = 1.0;", "float half = 0.5f; int half = 1;", "double d = 1.0;"])
def test_what_is_not_glsl_330_is_refused(line: str, tmp_path: Path) -> None:
    """Guards the test above against a compiler that takes all."""
    found = complaints([("frag", f"#version 330 core\nout vec4 colour;\nvoid main() {{\n{line}\ncolour = vec4(1.0);\n}}\n")], tmp_path)
    assert found and found[0].endswith(line)


def test_the_programs_are_all_that_the_shaders_hold(programs: Texts) -> None:
    """A new pass has to be named in every_program.py."""
    drawn = {path.relative_to(shaders_dir()).as_posix() for path in shaders_dir().rglob("*.frag")}
    assert drawn == {name.partition(" for ")[0] for name in programs.values()}


def test_what_the_vertex_shader_hands_on_is_what_the_fragment_shader_takes(programs: Texts) -> None:
    """Each text is compiled alone above; this is what linking them would add."""
    for (vertex, fragment), name in programs.items():
        given, taken = (re.findall(rf"^((?:flat |smooth |noperspective )?){way} (.*)$", text, re.M) for way, text in (("out", vertex), ("in", fragment)))
        assert given == taken, name


def test_whatever_a_program_runs_with_is_carried_to_it(programs: Texts) -> None:
    """What finds no room is fetched anew at every use, which once cost the disk's shader a fifth of its time (docs/llvmpipe.md, uniforms).

    There is more than fits in two places: a disk of many layers, or a moving frame's, which besides its own numbers takes what the refined map is read by; and
    rays marched through media, which take the rays' numbers and the matter's. Even there nothing is left out while an input is free.
    """
    numbers = {name for block in uniforms.blocks() for name, _ in block.members}
    for (_, fragment), name in programs.items():
        carried = set(re.findall(r"^#define (\w+) .*\bcarried_\d", fragment, re.M))
        text = re.sub(r"uniform \w+ \{.*?\};", "", fragment, flags=re.S)
        left_out = numbers & live_words(text.splitlines(), {}).run - carried
        crowded = name.startswith(("shade_matter.frag", "transfer.frag")) and f"flat in vec4 carried_{MOST_INPUTS - 1};" in fragment
        assert not left_out or crowded, name


def test_every_text_asks_for_330_core_in_its_first_line(programs: Texts) -> None:
    assert all(text.startswith("#version 330 core\n") for pair in programs for text in pair)
