"""The command line as people type it, and what goes in and out of it as text."""

from __future__ import annotations

import csv
import io
import itertools
import os
import re
import shlex
import shutil
import subprocess
import sys
from pathlib import Path

import pytest

from blackhole_gl import cli
from blackhole_gl.output import files, streams
from blackhole_gl.scene import presets

ROOT = Path(__file__).resolve().parents[2]
PNG = b"\x89PNG\r\n\x1a\n"
SMALL = ["--preset", "draft", "--size", "32x18"]
ENCODINGS = {
    "utf-8": {"PYTHONIOENCODING": "utf-8"},
    "cp1252": {"PYTHONIOENCODING": "cp1252"},
    "cp437": {"PYTHONIOENCODING": "cp437"},
    "C": {"LC_ALL": "C", "PYTHONCOERCECLOCALE": "0", "PYTHONUTF8": "0"},
}


def run(folder: Path, *arguments: str, **environment: str) -> subprocess.CompletedProcess[bytes]:
    hidden = ("DISPLAY", "WAYLAND_DISPLAY", "PYTHONIOENCODING")
    known = {name: value for name, value in os.environ.items() if name not in hidden}
    known |= {"PYTHONPATH": str(ROOT), "BLACKHOLE_GL_CONFIG_DIR": str(folder / "config"), "XDG_DATA_HOME": str(folder / "data"), **environment}
    return subprocess.run([sys.executable, "-m", "blackhole_gl", *arguments], env=known, cwd=folder, capture_output=True, timeout=200)


@pytest.mark.parametrize("encoding", ENCODINGS)
def test_no_listing_fails_for_a_character(tmp_path: Path, encoding: str) -> None:
    done = run(tmp_path, "plan", "--preset", "kerr", **ENCODINGS[encoding])
    assert done.returncode == 0, done.stderr
    read_back = done.stdout.decode("utf-8" if encoding == "C" else encoding)
    assert ("κ" if encoding in ("utf-8", "C") else "kappa") in read_back


def test_what_no_encoding_has_is_spelled_out() -> None:
    assert streams.spelled("κ = 0.5, 3 × 4, Δ ≤ 2°, r²") == "kappa = 0.5, 3 x 4, Delta <= 2 deg, r2"


@pytest.mark.parametrize("encoding", ["utf-8", "utf-8-sig", "utf-16"])
def test_presets_and_ray_lists_of_other_editors_are_read(tmp_path: Path, encoding: str) -> None:
    from blackhole_gl import listed_rays

    preset, rays = tmp_path / "mine.toml", tmp_path / "rays.csv"
    preset.write_bytes('title = "Loch, κ"\r\n[hole]\r\nspin = 0.25\r\n'.encode(encoding))
    rays.write_bytes("psi,chi\r\n0.5,1\r\n".encode(encoding))
    scene = presets.load([preset])
    assert scene.hole.spin == 0.25
    assert listed_rays.read(rays, scene).values.tolist() == [[0.5, 1.0]]


def test_what_a_newer_version_has_is_told_and_the_rest_is_used(tmp_path: Path) -> None:
    (tmp_path / "new.toml").write_text("[hole]\nspin = 0.25\ncharge = 0.1\n")
    done = run(tmp_path, "trace", "new.toml", "--float64", "--rays", "/dev/null", "-o", "-")
    assert done.returncode == 2, "an empty list is refused"
    assert done.stderr.decode().startswith("blackhole-gl: new.toml, line 3: hole.charge: skipped, for this version has no such key")
    shown = run(tmp_path, "presets", "new.toml")
    assert shown.returncode == 0 and b"spin = 0.25" in shown.stdout and shown.stderr.count(b"hole.charge: skipped") == 1
    mistyped = run(tmp_path, "plan", "-s", "hole.spni=0.5")
    assert mistyped.returncode == 2 and b"--set: hole.spni: no such key; did you mean hole.spin?" in mistyped.stderr


def test_presets_of_former_names_open_with_a_note_and_steps_longer_than_asked_are_told(tmp_path: Path) -> None:
    done = run(tmp_path, "plan", "gargantua_s1", "low")
    assert done.returncode == 0
    assert b"the preset low is now called blackholegpu_low" in done.stderr
    assert b"! steps are 3.87 times longer than asked" in done.stdout


SKY = """/*---
label = "Grey"
summary = "One brightness everywhere."
source = "own"
slot = "sky"
[parameters.level]
default = 0.5
range = [0.0, 1.0]
help = "How bright."
---*/
vec3 sky_radiance(vec3 direction, vec3 right, vec3 up, float energy) { return vec3(sky_grey_level); }
"""


@pytest.mark.parametrize("used", [False, True])
def test_a_picture_opens_where_the_users_plug_ins_are_not(tmp_path: Path, used: bool) -> None:
    skies = tmp_path / "config" / "shaders" / "skies"
    skies.mkdir(parents=True)
    (skies / "grey.glsl").write_bytes(b"\xef\xbb\xbf" + SKY.encode())
    (skies / "gone.glsl").symlink_to(skies / "nowhere.glsl")
    done = run(tmp_path, "render", "kerr", *SMALL, "-o", "x.png", *(["-s", "sky.model=grey"] if used else []))
    told = f"blackhole-gl: left out: {skies / 'gone.glsl'}: cannot be read: "
    assert done.returncode == 0 and done.stderr.decode().startswith(told) and done.stderr.count(b"\n") == 1, done.stderr
    shown = run(tmp_path, "presets", "x.png", BLACKHOLE_GL_CONFIG_DIR=str(tmp_path / "elsewhere"))
    if used:
        assert shown.returncode == 2 and b"sky.model: got 'grey'; allowed is one of" in shown.stderr
    else:
        assert shown.returncode == 0 and shown.stderr == b""


@pytest.mark.parametrize("name", ["-", "/dev/stdout"])
def test_a_picture_goes_to_standard_output_and_nothing_else(tmp_path: Path, name: str) -> None:
    done = run(tmp_path, "render", "kerr", *SMALL, "-o", name)
    assert done.returncode == 0 and done.stdout.startswith(PNG) and done.stdout.endswith(b"IEND\xaeB`\x82"), done.stderr
    assert list(tmp_path.iterdir()) == []


def test_traced_rays_go_to_standard_output_with_their_own_columns_behind(tmp_path: Path) -> None:
    (tmp_path / "rays.csv").write_text("tag,psi,chi\nedge on,0.1,2\n,0.5,1\n")
    done = run(tmp_path, "trace", "schwarzschild", "--rays", "rays.csv", "-o", "-", "--float64")
    assert done.returncode == 0, done.stderr
    rows = list(csv.DictReader(io.StringIO(done.stdout.decode())))
    assert list(rows[0])[0] == "fate" and list(rows[0])[-3:] == ["tag", "psi", "chi"]
    assert [(row["tag"], row["psi"]) for row in rows] == [("edge on", "0.1"), ("", "0.5")]


def test_an_output_that_cannot_be_written_is_told_by_its_own_name_and_before(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(cli, "renderer_by", lambda backend: pytest.fail("it was rendered first"))
    (tmp_path / "file").touch()
    for out, error in ((tmp_path, OSError), (tmp_path / "file" / "x.png", OSError), (tmp_path / "x.gif", ValueError)):
        with pytest.raises(error) as told:
            cli.render(out=out, preset=["kerr"], size="32x18")
        assert str(out) in str(told.value)
        assert ".part" not in str(told.value)


def test_what_fails_while_it_is_written_has_the_name_that_was_asked_for(tmp_path: Path) -> None:
    (tmp_path / "file").touch()
    with pytest.raises(OSError) as told:
        files.write_whole(tmp_path / "file" / "x.png", b"")
    assert told.value.filename == str(tmp_path / "file" / "x.png")


@pytest.mark.parametrize(
    "typed, meant",
    [
        ("", "view"),
        ("--preset kerr", "view --preset kerr"),
        ("-p kerr -s hole.spin=0.5", "view -p kerr -s hole.spin=0.5"),
        ("kerr", "view kerr"),
        ("picture.png high", "view picture.png high"),
        ("--preset kerr render -o x.png", "render --preset kerr -o x.png"),
        ("--preset=kerr plan", "plan --preset=kerr"),
        ("--float64 trace --rays r.csv", "trace --float64 --rays r.csv"),
        ("view kerr", "view kerr"),
        ("--version", "--version"),
        ("--help", "--help"),
    ],
)
def test_options_stand_where_people_type_them(typed: str, meant: str) -> None:
    assert cli._with_command(typed.split()) == meant.split()


@pytest.mark.parametrize("typed, meant", [("rendr kerr -o x.png", "render"), ("vidoe", "video"), ("preset", "presets"), ("kerr2", "kerr")])
def test_a_mistyped_command_is_told_as_one(typed: str, meant: str) -> None:
    with pytest.raises(ValueError, match=rf"no (command and no )?preset is called '{typed.split()[0]}'; did you mean {meant}\b"):
        cli.run(typed.split())


def test_a_reader_that_goes_is_no_mistake(tmp_path: Path) -> None:
    """As with `blackhole-gl presets | head -1`."""
    command = [sys.executable, "-m", "blackhole_gl", "presets"]
    with subprocess.Popen(command, cwd=tmp_path, env={**os.environ, "PYTHONPATH": str(ROOT)}, stdout=subprocess.PIPE, stderr=subprocess.PIPE) as writer:
        writer.stdout.close()
        assert (writer.stderr.read(), writer.wait()) == (b"", 1)


def test_an_interrupt_says_nothing(monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]) -> None:
    def interrupted(words: list[str]) -> None:
        raise KeyboardInterrupt

    monkeypatch.setattr(cli, "run", interrupted)
    with pytest.raises(SystemExit) as ended:
        cli.main()
    assert (ended.value.code, capsys.readouterr().err) == (130, "")


def test_presets_are_named_without_an_option(tmp_path: Path) -> None:
    assert run(tmp_path, "render", "kerr", "-s", "hole.spin=0.5", *SMALL, "-o", "x.png").returncode == 0
    (tmp_path / "mine.toml").write_text(presets.dumps(presets.from_png(tmp_path / "x.png")))
    for name in ("x.png", "mine.toml"):
        (tmp_path / "blackhole.png").unlink(missing_ok=True)
        done = run(tmp_path, name, "low")  # a view, which writes a picture where there is no display
        assert done.returncode == 0, done.stderr
        assert presets.from_png(tmp_path / "blackhole.png").hole.spin == 0.5
    assert run(tmp_path, "--version").stdout.startswith(b"blackhole-gl ")


COMMAND = re.compile(r"^(?: {4}|```sh\n)?(?:\.venv/bin/)?(blackhole-gl(?: [^#`\n]*)?)|`(blackhole-gl(?: [^`\n]*)?)`", re.MULTILINE)
PAGES = (ROOT / "README.md", *(ROOT / "docs").glob("*.md"))
LINES = sorted({(found[1] or found[2]).strip() for page in PAGES for found in COMMAND.finditer(page.read_text(encoding="utf-8"))})
# Named in a sentence, as the command that it is, and without what the command needs.
ONLY_NAMED = ("blackhole-gl render", "blackhole-gl video", "blackhole-gl video --path", "blackhole-gl trace", "blackhole-gl trace --float64")


def arguments_of(line: str) -> list[str]:
    return cli._with_command(shlex.split(line)[1:])


QUICK_COMMANDS = ("render", "trace", "curve", "desktop", "polarization", "profile", "plan", "presets", "visibilities", "--version")
LONG_COMMANDS = ("view", "bench", "check", "video")
RUN = [line for line in LINES if line not in ONLY_NAMED and "NAME" not in line]
QUICK = [line for line in RUN if arguments_of(line)[0] in QUICK_COMMANDS]
# Those about kinds of the reader's are run by tests/shaders/test_extending.py.
LONG = [line for line in RUN if arguments_of(line)[0] in LONG_COMMANDS and not re.search("graticule|moon|haze|whirl", line)]
LISTS = {"rays.csv": "psi,chi\n0.5,1\n", "uv.csv": "u,v\n1e9,2e9\n", "triangles.csv": "u1,v1,u2,v2\n1e9,2e9,3e9,0\n"}  # that these lines read
LOCALES = ("utf-8", "cp1252", "C")
# Run each time: the others are slow tests.
SAMPLE = {
    ("blackhole-gl --preset kerr --preset draft", "cp1252"),
    ("blackhole-gl video kerr --seconds 4 -o turning.mp4", "cp1252"),
    ("blackhole-gl check", "C"),
    *zip(QUICK, itertools.cycle(LOCALES)),
}


def in_all_locales(lines: list[str]) -> list:
    return [pytest.param(*case, marks=() if case in SAMPLE else pytest.mark.slow) for case in itertools.product(lines, LOCALES)]


def test_the_documents_have_command_lines() -> None:
    assert len(LINES) > 20 and {arguments_of(line)[0] for line in QUICK} == set(QUICK_COMMANDS)
    assert {arguments_of(line)[0] for line in LONG} == set(LONG_COMMANDS) and {line for line, _ in SAMPLE} <= {*LONG, *QUICK}


@pytest.mark.parametrize("line", [line for line in LINES if line not in ONLY_NAMED])
def test_every_command_line_of_the_documents_is_understood(line: str) -> None:
    """Parsed only, those too that open a window or are about kinds which the reader is to write."""
    words = arguments_of(line)
    if words != ["--version"]:
        assert cli.PROGRAM.parsed(words)[0].__name__ == words[0]


def _small(arguments: list[str]) -> str:
    """Of 18 rows, and of the shape that the line has: pictures all round have shapes of their own."""
    shape = arguments[arguments.index("--size") + 1] if "--size" in arguments else "16x9"
    width, height = map(int, shape.split("x"))
    return f"{18 * width // height}x18"


@pytest.mark.parametrize("line, encoding", in_all_locales(QUICK))
def test_command_lines_that_open_no_window_run_as_they_are(tmp_path: Path, line: str, encoding: str) -> None:
    """But for the size of pictures, which are drawn small."""
    for name, content in LISTS.items():
        (tmp_path / name).write_text(content)
    arguments = shlex.split(line)[1:]
    if arguments_of(line)[0] == "visibilities":
        arguments += ["--size", "32x32"]
    if arguments_of(line)[0] == "render":
        if "--supersample" in arguments:
            arguments[arguments.index("--supersample") + 1] = "1"
        arguments += ["--size", _small(arguments)]
    done = run(tmp_path, *arguments, **ENCODINGS[encoding])
    assert done.returncode == 0 and b"Traceback" not in done.stderr, done.stderr


@pytest.fixture(scope="module")
def picture(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """A picture that we have saved."""
    folder = tmp_path_factory.mktemp("picture")
    assert run(folder, "render", "m87_like", *SMALL, "-o", "x.png").returncode == 0
    return folder / "x.png"


@pytest.mark.parametrize("line, encoding", in_all_locales(LONG))
def test_long_command_lines_run_too(tmp_path: Path, picture: Path, line: str, encoding: str) -> None:
    """Views where there is no display, so that they write a picture; timings of small ones, once each, and films of a few."""
    for name in re.findall(r"(?<==)\S+\.jpg|\S+\.png", line):
        shutil.copy(picture, tmp_path / name)  # whatever the name says: what a file is, its content tells
    for name in re.findall(r"(?<=view )\S+\.mp4", line):
        assert run(tmp_path, "video", "--preset", "kerr", "--path", "dive", "--size", "32x18", "--fps", "1", "--seconds", "1", "--out", name).returncode == 0
    arguments = ["bench", "--size", "32x18", "--rounds", "1", "--no-euler"] if arguments_of(line)[0] == "bench" else shlex.split(line)[1:]
    if arguments_of(line)[0] == "video":
        arguments = [str(ROOT / word) if word.startswith("examples/") else word for word in arguments] + ["--size", "32x18", "--fps", "1", "--seconds", "2"]
    done = run(tmp_path, *arguments, **ENCODINGS[encoding])
    assert done.returncode == 0 and b"Traceback" not in done.stderr, done.stderr


def test_what_make_and_python_are_asked_for_in_the_documents_is_there() -> None:
    targets = re.findall(r"^([a-z-]+):", (ROOT / "Makefile").read_text(encoding="utf-8"), re.MULTILINE)
    asked = set()
    for page in (*PAGES, ROOT / "CONTRIBUTING.md"):
        text = page.read_text(encoding="utf-8")
        asked |= set(re.findall(r"(?:`|^ {4}|^)(?:[A-Z_]+=\S+ )*(make|python)( -m)? ([a-z][\w./-]*)", text, re.MULTILINE))
    assert len(asked) > 10
    for program, module, what in sorted(asked):
        if program == "make":
            assert what in targets, f"make {what}"
        else:
            place = ROOT / (what.replace(".", "/") if module else what)
            assert place.is_file() or place.with_suffix(".py").is_file() or (place / "__main__.py").is_file(), what
