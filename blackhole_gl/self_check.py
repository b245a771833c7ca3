"""What works on this machine and what does not, each with the line that mends it."""

from __future__ import annotations

import os
import sys
from collections.abc import Iterator
from dataclasses import dataclass

import moderngl
import numpy as np

from . import listed_rays
from .render import context
from .render.frame import Renderer
from .scene import presets

# The self test's own rays: 24 × 12 over the middle of the picture. The bound is the float32 floor of rays that keep 1 % away from
# the critical curve, with a margin of 10 for drivers whose arithmetic is coarser than IEEE.
_BOUND = 5e-5


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
    """Looks at everything, one finding after the other. The viewer needs EGL or OSMesa, float targets and a true self test."""
    ctx = None
    for backend, line in (("egl", context.INSTALL_LINE), ("osmesa", context.OSMESA_LINE)):
        try:
            made = context.create_headless(backend)
        except context.ContextError as error:
            yield Finding(backend, False, f"{error}" if line in str(error) else f"{error}. On Debian or Ubuntu: {line}")
            continue
        yield Finding(backend, True, context.describe(made))
        ctx = ctx or made
        if ctx is made:
            yield from _with_context(made)
    yield _window()


def good_enough(found: list[Finding]) -> bool:
    """Whether pictures can be made: one way to a context, float targets, and a self test within its bound."""
    by_name = {finding.name: finding.works for finding in found}
    return bool((by_name.get("egl") or by_name.get("osmesa")) and by_name.get("float targets") and by_name.get("self test"))


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
    try:
        from .app import window
    except ImportError as error:
        again = f"Install the package's dependencies again: pip install blackhole-gl; on Debian or Ubuntu also: {context.INSTALL_LINE}"
        return Finding("window", False, f"{error}. {again}")
    if not display_present():
        return Finding("window", None, "no display (DISPLAY is not set; Wayland serves through XWayland, which sets it): the viewer writes a picture instead")
    return Finding("window", window is not None, "a display is there, and the window libraries load")


def display_present() -> bool:
    """Whether a window can be opened: always taken as yes but on Linux and the BSDs, where the environment tells.

    The window library in imgui-bundle speaks X11 only; under Wayland, XWayland sets DISPLAY.
    """
    return sys.platform in ("win32", "darwin") or bool(os.environ.get("DISPLAY"))
