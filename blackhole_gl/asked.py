"""What commands are asked for in the same words: their scene, its time, a size, a renderer; and what is said of a scene before it is drawn."""

from __future__ import annotations

import re
import sys
from typing import TYPE_CHECKING, Annotated, TypeVar

from .arguments import Argument, Option
from .scene import Scene, SceneError, lengths
from .scene import presets as preset_files

if TYPE_CHECKING:
    from .rendering.frame import Renderer

_Number = TypeVar("_Number", int, float)

Named = Annotated[
    list[str] | None,
    Argument(metavar="[PRESET]...", help="Presets, as with --preset; those given with --preset are layered over them."),
]
Presets = Annotated[
    list[str] | None,
    Option(
        "--preset",
        "-p",
        help="A preset's name, a TOML file, or a picture made by this program. Repeatable: physics + look + quality.",
        default="kerr",
    ),
]
Settings = Annotated[
    list[str] | None,
    Option("--set", "-s", metavar="KEY=VALUE", help="Override one value, e.g. disk.outer_radius=12; lists as in TOML. Repeatable."),
]
AnyFile = Annotated[bool, Option("--any-file", help="Let presets and pictures open files outside their own folders, too.")]
Lengths = Annotated[str, Option(help=f"Unit of all lengths: {' or '.join(lengths.UNITS)}; r_s = 2 M.")]
OneUnit = Annotated[
    str | None,
    Option(help="One unit for all lengths, also those given: r_s or M, r_s = 2 M.", default="radii in r_s, places on the screen and momenta in M"),
]
Backend = Annotated[str, Option(help="How to get a GL context without a window: auto, egl or osmesa.", variable="BLACKHOLE_GL_BACKEND")]


def scene_of(names: list[str] | None, assignments: list[str] | None, any_file: bool) -> Scene:
    """The scene of presets `names`, layered, with `assignments` over them; former names and what is skipped are told.

    Raises:
        SceneError: there is no such preset, or it or an assignment has a mistake.
    """
    for former, present in preset_files.renamed(names or ()).items():
        print(f"blackhole-gl: the preset {former} is now called {present}; `blackhole-gl presets` lists the levels of quality", file=sys.stderr)
    scene = preset_files.load(names or preset_files.DEFAULT_PRESETS, preset_files.parse_assignments(assignments or ()), any_file=any_file)
    for sentence in preset_files.skipped(names or (), any_file=any_file):
        print(f"blackhole-gl: {sentence}", file=sys.stderr)
    return scene


def asked_for(names: list[str] | None, preset: list[str] | None, assignments: list[str] | None, any_file: bool) -> tuple[Scene, list[str]]:
    """`scene_of` the presets given by name alone and with --preset, which are layered over them; and all of those.

    Raises:
        SceneError: as there.
    """
    layered = [*(names or ()), *(preset or ())]
    return scene_of(layered, assignments, any_file), layered


def before_drawing(scene: Scene, assignments: list[str] | None) -> None:
    """`refuse_unmet` and `tell_warnings`."""
    refuse_unmet(scene, assignments)
    tell_warnings(scene)


def refuse_unmet(scene: Scene, assignments: list[str] | None) -> None:
    """A tolerance below the floor is an error where it was given by hand; that of a preset only earns a warning, so that any camera gives a picture.

    Raises:
        SceneError: it is below the floor.
    """
    from .planning import choice

    made = choice.choose(scene)
    if not made.meets and "rays.tolerance" in preset_files.parse_assignments(assignments or ()):
        text = f"{scene.rays.tolerance:g} px cannot be met in this scene; the floor of what was measured here is {made.floor_px:.2g} px"
        raise SceneError("rays.tolerance", text)


def tell_warnings(scene: Scene) -> None:
    """Says what makes the picture worse than the scene asks."""
    from .planning import plan as make_plan

    for warning in make_plan(scene).warnings:
        print(f"blackhole-gl: {warning}", file=sys.stderr)


def time_of(time: float | None, names: list[str] | None) -> float:
    """The time asked for, or that of the last among the presets that has one, as pictures and saved scenes have."""
    if time is not None:
        return time
    timed = preset_files.last_timed(names or ())
    return float(timed.time or 0.0) if timed else 0.0


def size_of(text: str) -> tuple[int, int]:
    """(width, height) of ``1280x720``.

    Raises:
        ValueError: not of that form, or not 1…32768 pixels each.
    """
    match = re.fullmatch(r"(\d{1,6})[x×](\d{1,6})", text.strip())
    size = (int(match[1]), int(match[2])) if match else (0, 0)
    if not all(1 <= side <= 32768 for side in size):
        raise ValueError(f"--size: got {text!r}; allowed is WIDTHxHEIGHT, each 1 to 32768, e.g. 1280x720")
    return size


def unit_of(text: str) -> str:
    """The unit of lengths that was asked for.

    Raises:
        ValueError: there is none such.
    """
    if text not in lengths.UNITS:
        raise ValueError(f"--lengths: got {text!r}; allowed is one of {', '.join(lengths.UNITS)}")
    return text


def numbers_of(text: str, kind: type[_Number], name: str) -> list[_Number]:
    """The numbers in ``3,5.5``, none in empty text.

    Raises:
        ValueError: not of that form.
    """
    try:
        return [kind(part) for part in text.split(",")] if text.strip() else []
    except ValueError:
        what = "whole numbers" if kind is int else "numbers"
        raise ValueError(f"{name}: got {text!r}; allowed are {what} with commas between them, e.g. {'0,1' if kind is int else '3,5.5'}") from None


def renderer_by(backend: str) -> Renderer:
    """A renderer without a window.

    Raises:
        ContextError: there is no such way on this machine.
    """
    from .rendering.context import create_headless
    from .rendering.frame import Renderer

    return Renderer(create_headless(backend))
