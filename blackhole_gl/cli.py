"""The command line: ``blackhole-gl`` with view (the default), render, trace, profile, polarization, ring, plan, bench, check and presets."""

from __future__ import annotations

import cmath
import math
import re
import sys
from pathlib import Path
from typing import Annotated, TextIO

from . import VERSION
from .arguments import Argument, Option, Program
from .output import streams
from .output.files import refuse_unwritable, write_whole
from .output.progress import Progress
from .scene import Scene, SceneError, catalogue
from .scene import presets as preset_files

_SUITES = ("frames", "weiskopf")
_FLAGS = ("--measure", "--float64", "--euler", "--no-euler", "--any-file", "--flux")  # options that no value follows

Named = Annotated[
    list[str] | None,
    Argument(metavar="[PRESET]...", help="Presets, as with --preset; those given with --preset are layered over them."),
]
Presets = Annotated[
    list[str] | None,
    Option(
        "--preset",
        "-p",
        help="A preset's name, a TOML file, or a PNG made by this program. Repeatable: physics + look + quality.",
        default="kerr",
    ),
]
Settings = Annotated[
    list[str] | None,
    Option("--set", "-s", metavar="KEY=VALUE", help="Override one value, e.g. disk.outer_radius=12; lists as in TOML. Repeatable."),
]
AnyFile = Annotated[bool, Option("--any-file", help="Let presets and pictures open files outside their own folders, too.")]
Backend = Annotated[str, Option(help="How to get a GL context without a window: auto, egl or osmesa.", variable="BLACKHOLE_GL_BACKEND")]


def main() -> None:
    """Runs the command line; mistakes end in one sentence and exit status 2."""
    from .glsl.compose import ShaderError
    from .render.context import ContextError

    streams.prepare()
    try:
        run(sys.argv[1:])
        sys.stdout.flush()
    except KeyboardInterrupt:
        print("Aborted.", file=sys.stderr)
        sys.exit(130)
    except BrokenPipeError:
        streams.give_up_output()
        sys.exit(1)
    except OSError as error:
        print(f"blackhole-gl: {error.filename}: {error.strerror}" if error.filename else f"blackhole-gl: {error}", file=sys.stderr)
        sys.exit(2)
    except (SceneError, ShaderError, ContextError, ValueError) as error:
        print(f"blackhole-gl: {error}", file=sys.stderr)
        sys.exit(2)


def run(words: list[str]) -> None:
    """Does what `words` ask for.

    Raises:
        SystemExit: they are no command, or ask for help; or a check failed.
        SceneError, ShaderError, ContextError, ValueError, OSError: what the command cannot do, in one sentence.
    """
    command, values = PROGRAM.parsed(_with_command(words))
    for mistake in catalogue.mistakes():
        print(f"blackhole-gl: left out: {mistake}", file=sys.stderr)
    command(**values)


def _with_command(arguments: list[str]) -> list[str]:
    """`arguments` with the command in front: one that options stand before, or view where none is named."""
    value_follows = False
    for place, argument in enumerate(arguments):
        if argument in ("-h", "--help", "--version") and place == 0:
            return arguments
        if argument in COMMANDS and not value_follows:
            return [argument, *arguments[:place], *arguments[place + 1 :]]
        if not argument.startswith("-"):
            if not value_follows:
                break  # the first of the presets: what follows is a preset, too
            value_follows = False
        else:
            value_follows = not value_follows and argument not in _FLAGS and "=" not in argument
    return ["view", *arguments]


def view(
    names: Named = None,
    preset: Presets = None,
    set_: Settings = None,
    any_file: AnyFile = False,
    size: Annotated[str | None, Option(help="Width × height of the window.", default="that of the last one, or 1280x800")] = None,
    time: Annotated[float | None, Option(help="Scene time in r_s/c to begin at. When not given: a saved scene's, or 0.")] = None,
) -> None:
    """Open the viewer. Without a display: write a picture and say where."""
    from .self_check import display_present

    preset = [*(names or ()), *(preset or ())]
    begins = _time(time, preset)
    if not (preset or set_) and (last := _last_scene()):
        scene, begins = last[0], last[1] if time is None else begins
    else:
        scene, preset = _scene(preset, set_, any_file), preset or list(preset_files.DEFAULT_PRESETS)
    if not display_present():
        out = Path("blackhole.png").resolve()
        print("There is no display (DISPLAY is not set; under Wayland, XWayland sets it), so no window can be opened.")
        print("Rendering the scene to a picture instead …", flush=True)
        _render(scene, (1280, 720), begins, out, scene.rays.in_stills, "auto")
        print(f"Written: {out}")
        return
    from .app import window

    window.run(scene, preset_names=preset, any_file=any_file, time=begins, size=_size(size) if size else None)


def render(
    out: Annotated[
        Path | None, Option("--out", "-o", help="The PNG to write. It carries its whole scene. - is standard output.")
    ] = None,
    names: Named = None,
    preset: Presets = None,
    set_: Settings = None,
    any_file: AnyFile = False,
    size: Annotated[str, Option(help="Width × height in pixels.")] = "1280x720",
    time: Annotated[float | None, Option(help="Scene time in r_s/c. When not given: that of a saved picture or scene, or 0.")] = None,
    supersample: Annotated[
        int | None, Option(least=1, most=16, help="Rays a pixel along each axis. When not given: as the scene's quality has it.")
    ] = None,
    flux: Annotated[bool, Option("--flux", help="Print its flux, and what finer steps and pixels change in it. --out may then be left out.")] = False,
    backend: Backend = "auto",
) -> None:
    """Render a picture without a window. The same scene, time and size give the same file."""
    preset = [*(names or ()), *(preset or ())]
    scene = _scene(preset, set_, any_file)
    if out is None and not flux:
        raise SceneError("--out", "missing; allowed is the PNG to write, or - for standard output; it may be left out with --flux")
    if out is not None:
        refuse_unwritable(out, (".png",), "a PNG picture")
    _refuse_unmet(scene, set_)
    if out is not None:
        _render(scene, _size(size), _time(time, preset), out, supersample or scene.rays.in_stills, backend)
    if flux:
        _print_flux(scene, _size(size), _time(time, preset), backend, sys.stderr if out == Path("-") else sys.stdout)


def trace(
    rays: Annotated[Path, Option(help="CSV with columns psi,chi (radians), or alpha,beta (M) with camera.distance=inf.")],
    out: Annotated[Path, Option("--out", "-o", help="The CSV to write, a row a ray. - is standard output.")],
    names: Named = None,
    preset: Presets = None,
    set_: Settings = None,
    any_file: AnyFile = False,
    float64: Annotated[bool, Option("--float64", help="Use the NumPy float64 reference instead of the shader.")] = False,
    backend: Backend = "auto",
) -> None:
    """Trace listed rays through the shader that pictures use.

    psi is the angle from the direction to the hole's centre, chi the angle on the screen from right (+e_φ) towards up (north).
    """
    from . import listed_rays

    preset = [*(names or ()), *(preset or ())]
    scene = _scene(preset, set_, any_file)
    refuse_unwritable(out, (".csv", ".txt"), "CSV")
    listed = listed_rays.read(rays, scene)
    _refuse_unmet(scene, set_)
    if float64:
        found = listed_rays.trace_by_reference(scene, listed.rays)
    else:
        _tell_warnings(scene)
        found = listed_rays.trace_by_shader(_renderer(backend), scene, listed.rays)
    listed_rays.write(out, found, 17 if float64 else 9, listed)


def profile(
    out: Annotated[Path, Option("--out", "-o", help="The CSV to write, a row a bin of g = E_infinity/E_emitter. - is standard output.")],
    names: Named = None,
    preset: Presets = None,
    set_: Settings = None,
    any_file: AnyFile = False,
    emissivity: Annotated[float, Option(least=-5.0, most=10.0, help="q of the line's power, r^-q.")] = 3.0,
    bins: Annotated[int, Option(least=10, most=2000, help="Bins between the least g and the largest.")] = 200,
    backend: Backend = "auto",
) -> None:
    """Write the profile of a narrow line from the whole disk, of each order of image, and say what share of the light each has."""
    from .measure import line_profile

    preset = [*(names or ()), *(preset or ())]
    scene = _scene(preset, set_, any_file)
    refuse_unwritable(out, (".csv", ".txt"), "CSV")
    line_profile.refuse(scene)
    _refuse_unmet(scene, set_)
    _tell_warnings(scene)
    found = line_profile.measure(_renderer(backend), scene, index=emissivity, bins=bins)
    write_whole(out, found.as_csv().encode())
    for name, share in zip(line_profile.ORDERS, found.shares, strict=True):
        print(f"{name:12} {100.0 * share:.3g} % of the light", file=sys.stderr)
    print(f"mean g       {found.mean:.4f}", file=sys.stderr)


def polarization(
    out: Annotated[Path, Option("--out", "-o", help="The NumPy archive to write: I, Q and U of each pixel, top row first. - is standard output.")],
    names: Named = None,
    preset: Presets = None,
    set_: Settings = None,
    any_file: AnyFile = False,
    size: Annotated[str, Option(help="Width × height in pixels.")] = "640x360",
) -> None:
    """Write how the light of the disk is polarized, pixel by pixel, and say how much of it is, along what, and beta_2."""
    from .measure import polarization_maps

    preset = [*(names or ()), *(preset or ())]
    scene = _scene(preset, set_, any_file)
    refuse_unwritable(out, (".npz",), "a NumPy archive")
    with Progress("polarization") as progress:
        found = polarization_maps.measure(scene, _size(size), progress)
    write_whole(out, found.as_npz())
    share, angle = found.net
    print(f"polarized    {100.0 * found.mean_share:.3g} % of the light, {100.0 * share:.3g} % of all together, along {angle:.2f}°", file=sys.stderr)
    print(f"beta_2       {abs(found.beta_2):.4f}, phase {math.degrees(cmath.phase(found.beta_2)):.2f}°", file=sys.stderr)


def ring(
    names: Named = None,
    preset: Presets = None,
    set_: Settings = None,
    any_file: AnyFile = False,
    size: Annotated[str, Option(help="Width × height in pixels of the picture that is measured.")] = "600x600",
    time: Annotated[float | None, Option(help="Scene time in r_s/c. When not given: that of a saved picture or scene, or 0.")] = None,
    backend: Backend = "auto",
) -> None:
    """Measure the ring in a picture: diameter, width, asymmetry and beta_2, of the light as it comes and through the scene's beam."""
    from .measure import ring as ring_measure

    preset = [*(names or ()), *(preset or ())]
    scene = _scene(preset, set_, any_file)
    ring_measure.refuse(scene)
    _refuse_unmet(scene, set_)
    _tell_warnings(scene)
    found = ring_measure.measure(_renderer(backend), scene, _time(time, preset), _size(size))
    print(ring_measure.text(found, scene), end="")


def plan(
    names: Named = None,
    preset: Presets = None,
    set_: Settings = None,
    any_file: AnyFile = False,
    measure: Annotated[bool, Option("--measure", help="Measure error and cost here and now beside the predictions.")] = False,
    backend: Backend = "auto",
) -> None:
    """Say how a scene's rays are traced, why, and what error and cost to expect. A tolerance that cannot be met is refused."""
    from . import plan as planning

    preset = [*(names or ()), *(preset or ())]
    scene = _scene(preset, set_, any_file)
    chosen, made = planning.choice.choose(scene), planning.plan(scene)
    moving = planning.choice.refinement(chosen.scene)
    print(f"method     {made.method}")
    print(f"steps      at most {made.max_steps}, {made.evaluations_per_step} evaluations each")
    print(f"crossings  {made.orders} orders")
    if chosen.chosen is not None:
        print(f"predicted  {chosen.chosen.error_px:.2g} px at 99 % of the pixels, {chosen.chosen.cost:.3g} flat frames")
    if moving is not None:
        print(f"  refined  {moving}")
    if measure:
        from .measure.prediction import measured, measured_refined

        renderer = _renderer(backend)
        found = measured(renderer, scene)
        print(f"measured   {found.error_px:.2g} px at 99 % of the pixels, {found.cost:.3g} flat frames")
        if made.refine_px or moving is not None:
            print(f"  refined  {measured_refined(renderer, scene)}")
    for reason in made.reasons:
        print(f"  - {reason}")
    for warning in made.warnings:
        print(f"  ! {warning}")
    _refuse_unmet(scene, set_)


def bench(
    names: Named = None,
    preset: Presets = None,
    set_: Settings = None,
    any_file: AnyFile = False,
    size: Annotated[list[str] | None, Option(help="Width × height in pixels. Repeatable.", default="640x360 to 3840x2160; 800x600")] = None,
    rounds: Annotated[int, Option(least=1, most=100, help="Frames of each kind; medians are taken.")] = 5,
    suite: Annotated[str, Option(help="frames, or weiskopf: spheres in four ray models with each acceleration, as measured in 2004.")] = "frames",
    json: Annotated[Path | None, Option(help="Also write everything as JSON.")] = None,
    euler: Annotated[bool, Option(help="Also time 300 Euler steps, the yardstick E.")] = True,
    backend: Backend = "auto",
) -> None:
    """Time whole frames and their parts on this machine: methods, still and moving, over picture sizes."""
    from json import dumps

    from .measure import bench as benching
    from .measure import weiskopf
    if suite not in _SUITES:
        raise SceneError("--suite", f"got {suite!r}; allowed is one of {', '.join(_SUITES)}")
    preset = [*(names or ()), *(preset or ())]
    if suite == "weiskopf" and (preset or set_ or len(size or ()) > 1):
        raise SceneError("--suite", "weiskopf has scenes of its own and one size; allowed beside it are --size once, --rounds, --json and --backend")
    scene = _scene(preset, set_, any_file)
    if json is not None:
        refuse_unwritable(json, (".json",), "JSON")
    sizes = [_size(text) for text in size] if size else benching.SIZES
    renderer = _renderer(backend)
    found: benching.Bench | weiskopf.Suite
    with Progress("timing") as progress:
        if suite == "weiskopf":
            found = weiskopf.measure(renderer, sizes[0] if size else weiskopf.SIZE, rounds, progress)
        else:
            found = benching.measure(renderer, scene, sizes, rounds, euler, progress)
    print(weiskopf.text(found) if isinstance(found, weiskopf.Suite) else benching.text(found), end="")
    if json is not None:
        write_whole(json, (dumps(found.as_dict(), indent=1, ensure_ascii=False) + "\n").encode())


def check() -> None:
    """Say what works on this machine, and the line that mends what does not. Exit status 1 when anything does not."""
    from . import self_check

    all_well = True
    for finding in self_check.findings():
        mark = {True: "ok  ", False: "FAIL", None: "    "}[finding.works]
        print(f"{mark}  {finding.name:14} {finding.text}", flush=True)
        all_well &= finding.works is not False
    if not all_well:
        sys.exit(1)


def presets(
    name: Annotated[str | None, Argument(help="Show this preset's values as TOML.")] = None,
) -> None:
    """List the presets, or show one."""
    if name is not None:
        print(preset_files.dumps(_scene([name], None, any_file=True), full=True), end="")
        return
    group = ""
    for info in preset_files.available():
        if info.group != group:
            group = info.group
            print(f"{group}:")
        print(f"  {info.name:20} {info.title}")


def _scene(names: list[str] | None, assignments: list[str] | None, any_file: bool) -> Scene:
    for former, present in preset_files.renamed(names or ()).items():
        print(f"blackhole-gl: the preset {former} is now called {present}; `blackhole-gl presets` lists the levels of quality", file=sys.stderr)
    scene = preset_files.load(names or preset_files.DEFAULT_PRESETS, preset_files.parse_assignments(assignments or ()), any_file=any_file)
    for sentence in preset_files.skipped(names or (), any_file=any_file):
        print(f"blackhole-gl: {sentence}", file=sys.stderr)
    return scene


def _last_scene() -> tuple[Scene, float] | None:
    """The scene that the last window showed and its time, where the user has such kept; what stands in the way is told."""
    from .app import kept

    path = kept.last_scene_file()
    if not path.is_file():
        return None
    try:
        return _scene([str(path)], None, any_file=True), float(preset_files.read(path).time or 0.0)
    except SceneError as error:
        print(f"blackhole-gl: the last scene is left out: {error}", file=sys.stderr)
        return None


def _refuse_unmet(scene: Scene, assignments: list[str] | None) -> None:
    """A tolerance below the floor is an error where it was given by hand; that of a preset only earns a warning, so that any camera gives a picture."""
    from .plan import choice

    made = choice.choose(scene)
    if not made.meets and "rays.tolerance" in preset_files.parse_assignments(assignments or ()):
        text = f"{scene.rays.tolerance:g} px cannot be met in this scene; the floor of what was measured here is {made.floor_px:.2g} px"
        raise SceneError("rays.tolerance", text)


def _tell_warnings(scene: Scene) -> None:
    from .plan import plan as make_plan

    for warning in make_plan(scene).warnings:
        print(f"blackhole-gl: {warning}", file=sys.stderr)


def _time(time: float | None, names: list[str] | None) -> float:
    """The time asked for, or that of the last among the presets that has one, as pictures and saved scenes have."""
    if time is not None:
        return time
    timed = preset_files.last_timed(names or ())
    return float(timed.time or 0.0) if timed else 0.0


def _size(text: str) -> tuple[int, int]:
    """(width, height) of ``1280x720``.

    Raises:
        ValueError: not of that form, or not 1…16384 pixels each.
    """
    match = re.fullmatch(r"(\d{1,6})[x×](\d{1,6})", text.strip())
    size = (int(match[1]), int(match[2])) if match else (0, 0)
    if not all(1 <= side <= 16384 for side in size):
        raise ValueError(f"--size: got {text!r}; allowed is WIDTHxHEIGHT, each 1 to 16384, e.g. 1280x720")
    return size


def _renderer(backend: str):
    from .render.context import create_headless
    from .render.frame import Renderer

    return Renderer(create_headless(backend))


def _render(scene: Scene, size: tuple[int, int], time: float, out: Path, samples: int, backend: str) -> None:
    from .output import png
    from .render.annotation import annotated

    _tell_warnings(scene)
    renderer = _renderer(backend)
    with Progress("rendering") as progress:
        renderer.render_still(scene, time, size, samples, progress)
    pixels = annotated(renderer.read_rgb8(), scene, renderer.view_of(scene))
    png.write(out, pixels, preset_files.picture_text(scene, time, out.absolute().parent))


def _print_flux(scene: Scene, size: tuple[int, int], time: float, backend: str, file: TextIO) -> None:
    from .measure import flux

    with Progress("measuring") as progress:
        found = flux.measured(_renderer(backend), scene, time, size, progress)
    print(found, file=file)


PROGRAM = Program(
    "blackhole-gl",
    "Black holes in real time, with an error bar. Without a command: view.",
    VERSION,
    (view, render, trace, profile, polarization, ring, plan, bench, check, presets),
)
COMMANDS = tuple(command.__name__ for command in PROGRAM.commands)
