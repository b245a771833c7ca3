"""The command line: ``blackhole-gl`` with view (the default), render, video, trace, curve, visibilities, profile, lightcurve, polarization, ring, plan, bench,
check, desktop and presets."""

from __future__ import annotations

import sys
from contextlib import nullcontext
from pathlib import Path
from typing import Annotated, TextIO

from . import VERSION
from .arguments import Argument, Option, Program
from .asked import AnyFile, Backend, Lengths, Named, Presets, Settings, asked_for, refuse_unmet, renderer_by, scene_of, size_of, tell_warnings, time_of, unit_of
from .films import video
from .output import streams
from .output.files import refuse_unwritable, write_whole
from .output.progress import Progress
from .research import curve, lightcurve, polarization, profile, ring, trace, visibilities
from .scene import Scene, SceneError, catalogue
from .scene import presets as preset_files
from .scene.schema import nearest

_LAYERS = (".exr", ".fits", ".npz")
_SUITES = ("frames", "weiskopf")
_FLAGS = ("--measure", "--float64", "--euler", "--no-euler", "--any-file", "--flux", "--keep-frames")  # options that no value follows


def main() -> None:
    """Runs the command line; mistakes end in one sentence and exit status 2."""
    from .glsl.compose import ShaderError
    from .rendering.context import ContextError

    streams.prepare()
    try:
        run(sys.argv[1:])
        sys.stdout.flush()
    except KeyboardInterrupt:
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
                _refuse_mistyped(argument)
                break  # the first of the presets: what follows is a preset, too
            value_follows = False
        else:
            value_follows = not value_follows and argument not in _FLAGS and "=" not in argument
    return ["view", *arguments]


def _refuse_mistyped(word: str) -> None:
    """Refuses what is like a command's name and no preset's: the options of a command would be told as unknown to view.

    Raises:
        ValueError: it is so.
    """
    meant = nearest(word, COMMANDS)
    if meant and not Path(word).suffix and word not in (info.name for info in preset_files.available()):
        raise ValueError(f"no command and no preset is called {word!r}{meant}")


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
    begins = time_of(time, preset)
    if not (preset or set_) and (last := _last_scene()):
        scene, begins = last[0], last[1] if time is None else begins
    else:
        scene, preset = scene_of(preset, set_, any_file), preset or list(preset_files.DEFAULT_PRESETS)
    if not display_present():
        out = Path("blackhole.png").resolve()
        print("There is no display (DISPLAY is not set; under Wayland, XWayland sets it), so no window can be opened.")
        print("Rendering the scene to a picture instead …", flush=True)
        _render(scene, (1280, 720), begins, out, scene.rays.in_stills, "auto")
        print(f"Written: {out}")
        return
    from .app import window

    window.run(scene, preset_names=preset, any_file=any_file, time=begins, size=size_of(size) if size else None)


def render(
    out: Annotated[
        Path | None, Option("--out", "-o", help="The PNG or .jpg to write, its scene inside; - is standard output. Or .exr, .fits, .npz: radiance with layers.")
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
    linear: Annotated[bool, Option("--linear", help="A PNG of linear radiance, 16 bits a channel, of which 65535 stands for a radiance of 8.")] = False,
    flux: Annotated[bool, Option("--flux", help="Print its flux, and what finer steps and pixels change in it. --out may then be left out.")] = False,
    dask: Annotated[str | None, Option(metavar="ADDRESS", help="Have the cluster draw its tiles whose scheduler is there, tcp://….", default="none")] = None,
    backend: Backend = "auto",
) -> None:
    """Render a picture without a window. The same scene, time and size give the same file."""
    scene, preset = asked_for(names, preset, set_, any_file)
    if out is None and not flux:
        raise SceneError("--out", "missing; allowed is the PNG to write, or - for standard output; it may be left out with --flux")
    if out is not None:
        refuse_unwritable(out, (".png", ".jpg", ".jpeg", *_LAYERS), "a picture")
    if dask is not None and (out is None or out.suffix.lower() in _LAYERS):
        got = "no picture" if out is None else f"{out.suffix}, whose layers are measured here"
        raise SceneError("--dask", f"got {got}; allowed is --out with a PNG or .jpg")
    refuse_unmet(scene, set_)
    if out is not None:
        if linear and out.suffix.lower() not in ("", ".png"):
            raise SceneError("--linear", f"got {out.suffix}; allowed is .png, and .exr, .fits and .npz hold linear radiance anyway")
        _render(scene, size_of(size), time_of(time, preset), out, supersample or scene.rays.in_stills, backend, linear=linear, dask=dask)
    if flux:
        _print_flux(scene, size_of(size), time_of(time, preset), backend, sys.stderr if out == Path("-") else sys.stdout)


def plan(
    names: Named = None,
    preset: Presets = None,
    set_: Settings = None,
    any_file: AnyFile = False,
    measure: Annotated[bool, Option("--measure", help="Measure error and cost here and now beside the predictions.")] = False,
    backend: Backend = "auto",
) -> None:
    """Say how a scene's rays are traced, why, and what error and cost to expect. A tolerance that cannot be met is refused."""
    from . import planning
    from .planning import choice

    scene, _ = asked_for(names, preset, set_, any_file)
    chosen, made = choice.choose(scene), planning.plan(scene)
    moving = choice.refinement(chosen.scene)
    print(f"method     {made.method}")
    print(f"steps      at most {made.max_steps}, {made.evaluations_per_step} evaluations each")
    print(f"crossings  {made.orders} orders")
    if chosen.chosen is not None:
        print(f"predicted  {chosen.chosen.error_px:.2g} px at 99 % of the pixels, {chosen.chosen.cost:.3g} flat frames")
    if moving is not None:
        print(f"  refined  {moving}")
    if measure:
        from .measure.prediction import measured, measured_refined

        renderer = renderer_by(backend)
        found = measured(renderer, scene)
        print(f"measured   {found.error_px:.2g} px at 99 % of the pixels, {found.cost:.3g} flat frames")
        if made.refine_px or moving is not None:
            print(f"  refined  {measured_refined(renderer, scene)}")
    for reason in made.reasons:
        print(f"  - {reason}")
    for warning in made.warnings:
        print(f"  ! {warning}")
    refuse_unmet(scene, set_)


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
    scene = scene_of(preset, set_, any_file)
    if json is not None:
        refuse_unwritable(json, (".json",), "JSON")
    sizes = [size_of(text) for text in size] if size else benching.SIZES
    renderer = renderer_by(backend)
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


def desktop(
    action: Annotated[str | None, Argument(help="install, or remove.")] = None,
) -> None:
    """Put the viewer into the menus of a Linux desktop, and have it open scene files called *.blackhole.toml; or take it out again."""
    from .desktop import install, remove

    if action not in ("install", "remove"):
        raise ValueError(f"desktop: got {action or 'nothing'}; allowed is install or remove")
    changed = install() if action == "install" else remove()
    for path in changed:
        print(f"{'Written' if action == 'install' else 'Removed'}: {path}")
    if not changed:
        print("There was nothing to remove.")


def presets(
    name: Annotated[str | None, Argument(help="Show this preset's values as TOML.")] = None,
    lengths: Lengths = "r_s",
) -> None:
    """List the presets, or show one."""
    if name is not None:
        print(preset_files.dumps(scene_of([name], None, any_file=True), full=True, unit=unit_of(lengths)), end="")
        return
    group = ""
    for info in preset_files.available():
        if info.group != group:
            group = info.group
            print(f"{group}:")
        print(f"  {info.name:20} {info.title}")


def _last_scene() -> tuple[Scene, float] | None:
    """The scene that the last window showed and its time, where the user has such kept; what stands in the way is told."""
    from .app import kept

    path = kept.last_scene_file()
    if not path.is_file():
        return None
    try:
        return scene_of([str(path)], None, any_file=True), float(preset_files.read(path).time or 0.0)
    except SceneError as error:
        print(f"blackhole-gl: the last scene is left out: {error}", file=sys.stderr)
        return None


def _render(
    scene: Scene, size: tuple[int, int], time: float, out: Path, samples: int, backend: str, *, linear: bool = False, dask: str | None = None
) -> None:
    if out.suffix.lower() in _LAYERS:
        _render_layers(scene, size, time, out, samples, backend)
        return
    from . import still_cluster
    from .rendering import still_files

    tell_warnings(scene)
    renderer = renderer_by(backend)
    with nullcontext() if dask is None else still_cluster.spreading(renderer, dask):
        if linear:
            still_files.write_linear(renderer, out, scene, time, size, samples)
            return
        with Progress("rendering") as progress:
            for share in still_files.write(renderer, out, scene, time, size, samples):
                progress(share)


def _render_layers(scene: Scene, size: tuple[int, int], time: float, out: Path, samples: int, backend: str) -> None:
    from . import layers

    tell_warnings(scene)
    layers.write(out, layers.measured(renderer_by(backend), scene, time, size, samples), scene, time)


def _print_flux(scene: Scene, size: tuple[int, int], time: float, backend: str, file: TextIO) -> None:
    from .measure import flux

    with Progress("measuring") as progress:
        found = flux.measured(renderer_by(backend), scene, time, size, progress)
    print(found, file=file)


PROGRAM = Program(
    "blackhole-gl",
    "Black holes in real time, with an error bar. Without a command: view.",
    VERSION,
    (view, render, video, trace, curve, visibilities, profile, lightcurve, polarization, ring, plan, bench, check, desktop, presets),
)
COMMANDS = tuple(command.__name__ for command in PROGRAM.commands)
