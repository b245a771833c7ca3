"""What works on this machine and what does not, each with the line that mends it."""

from __future__ import annotations

import os
import sys
from collections.abc import Iterator
from concurrent.futures import BrokenExecutor
from dataclasses import dataclass, replace

import moderngl
import numpy as np

from . import listed_rays
from .rendering import context
from .rendering.frame import Renderer
from .scene import presets
from .worker import Worker

# The self test's own rays: 24 × 12 over the middle of the picture. The bound is the float32 floor of rays that keep 1 % away from
# the critical curve, with a margin of 10 for drivers whose arithmetic is coarser than IEEE.
_BOUND = 5e-5
_WINDOW_S = 30.0  # longer than a window takes to open on any machine


@dataclass(frozen=True)
class Finding:
    """One thing looked at.

    Attributes:
        name: what.
        works: whether it does; None where it is only a fact.
        text: what was found, and the line that mends it.
    """

    name: str
    works: bool | None
    text: str


def findings() -> Iterator[Finding]:
    """Looks at everything, one finding after the other. All that is needed is one way to draw without a window, float targets, a true self test, and a
    window where there is a display: the other way to draw without one is only a fact where it does not work."""
    ways = [_way(backend, line) for backend, line in (("egl", context.INSTALL_LINE), ("osmesa", context.OSMESA_LINE))]
    working = [made for _, made in ways if made is not None]
    for finding, _ in ways:
        yield replace(finding, works=None, text=f"not needed, and not there: {finding.text}") if working and not finding.works else finding
    if working:
        yield from _with_context(working[0])
    yield _window()


def _way(backend: str, line: str) -> tuple[Finding, moderngl.Context | None]:
    try:
        made = context.create_headless(backend)
    except context.ContextError as error:
        return Finding(backend, False, f"{error}" if line in str(error) else f"{error}. On Debian or Ubuntu: {line}"), None
    return Finding(backend, True, context.describe(made)), made


def _with_context(ctx: moderngl.Context) -> Iterator[Finding]:
    yield Finding("renderer", None, context.describe(ctx))
    try:
        target = ctx.framebuffer([ctx.texture((4, 4), 4, dtype="f4") for _ in range(3)])
        target.release()
        yield Finding("float targets", True, "three RGBA32F targets at once")
    except moderngl.Error as error:
        yield Finding("float targets", False, f"{error}. A newer graphics driver, or Mesa's software renderer, is needed")
        return
    yield self_test(Renderer(ctx))


def self_test(renderer: Renderer) -> Finding:
    """Traces rays of the default preset by shader and by the float64 twin and compares where they end."""
    scene = presets.load(["kerr", "reference"])
    psi, chi = np.meshgrid(np.linspace(0.02, 0.6, 12), np.linspace(-np.pi, np.pi, 24, endpoint=False))
    rays = np.stack([psi.ravel(), chi.ravel()], axis=1)
    by_shader = listed_rays.trace_by_shader(renderer, scene, rays)
    by_twin = listed_rays.trace_by_reference(scene, rays)
    wrong = int((by_shader.fate != by_twin.fate).sum())
    error = np.linalg.norm(by_shader.direction - by_twin.direction, axis=1)
    worst = float(np.nanquantile(error, 0.99))
    text = f"{len(rays)} rays against the float64 twin: {wrong} wrong fates, escape direction within {worst:.1e} rad at 99 %"
    return Finding("self test", wrong == 0 and worst <= _BOUND, text)


def _window() -> Finding:
    """Opens a hidden window as the viewer does, in a process of its own: here another GLFW may have been loaded, and a driver may end the process."""
    if not display_present():
        return Finding("window", None, "no display (DISPLAY is not set; Wayland serves through XWayland, which sets it): the viewer writes a picture instead")
    worker = Worker()
    try:
        return worker.submit(_try_out).result(timeout=_WINDOW_S)
    except TimeoutError:
        return Finding("window", False, f"none has opened within {_WINDOW_S:g} s: the display or its driver does not answer")
    except BrokenExecutor:
        again = "On Linux, Mesa may draw instead: LIBGL_ALWAYS_SOFTWARE=1 blackhole-gl"
        return Finding("window", False, f"opening one ends the whole process: the graphics driver fails. {again}")
    finally:
        worker.close()


def _try_out() -> Finding:
    """What is found in the other process. Errors stay there: to know their types, this one would have to load the window's libraries."""
    try:
        from .app import runner
    except ImportError as error:
        again = f"Install the package's dependencies again: pip install blackhole-gl; on Debian or Ubuntu also: {context.INSTALL_LINE}"
        return Finding("window", False, f"{error}. {again}")
    try:
        return Finding("window", True, f"opens: {runner.try_out()}")
    except Exception as error:  # whatever stands in the way of a window is what this is to tell
        return Finding("window", False, str(error) or type(error).__name__)


def display_present() -> bool:
    """Whether a window can be opened: always taken as yes but on Linux and the BSDs, where the environment tells.

    The window library in imgui-bundle speaks X11 only; under Wayland, XWayland sets DISPLAY.
    """
    return sys.platform in ("win32", "darwin") or bool(os.environ.get("DISPLAY"))
