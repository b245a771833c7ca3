"""A GL context without a window: EGL first, OSMesa through GLFW's null platform second."""

from __future__ import annotations

import ctypes
import os
from typing import Any

import moderngl

BACKENDS = ("egl", "osmesa")
ENVIRONMENT = "BLACKHOLE_GL_BACKEND"
INSTALL_LINE = "apt-get install -y --no-install-recommends libegl1 libgl1"
OSMESA_LINE = "apt-get install -y --no-install-recommends libosmesa6"


# More than any machine has.
_MOST_DEVICES = 64

_first_made_in = 0
"""The process that made the first context of this one and of those it was forked from; 0 where there was none."""


class ContextError(RuntimeError):
    """No GL context could be made; the text says what was tried and the line that mends it."""


def create_headless(backend: str = "auto", device: int | None = None) -> moderngl.Context:
    """A GL 3.3 core context that needs no display, current in the thread that calls.

    Args:
        backend: ``egl``, ``osmesa`` or ``auto``; auto takes the environment variable BLACKHOLE_GL_BACKEND, or the first that works.
        device: which of `device_names`, by number; through EGL alone. The driver's first when None.

    Raises:
        ContextError: none could be made.
        ValueError: an unknown backend, or a device without EGL.
    """
    global _first_made_in
    chosen = os.environ.get(ENVIRONMENT, "auto") if backend == "auto" else backend
    if chosen not in (*BACKENDS, "auto"):
        raise ValueError(f"backend: got {chosen!r}; allowed is one of auto, {', '.join(BACKENDS)}")
    if device is not None:
        if chosen == "osmesa":
            raise ValueError(f"device: got {device}; osmesa draws on the processor alone, allowed with a device is egl")
        chosen = "egl"
    if forked_from_gl():
        raise ContextError("this process was forked from one that uses OpenGL, whose driver does not outlive a fork: start it by spawn, or exec")
    _first_made_in = os.getpid()
    failures = []
    for name in BACKENDS if chosen == "auto" else (chosen,):
        try:
            return _egl(device) if name == "egl" else _osmesa()
        except Exception as error:  # whatever a GL loader throws, the next way is tried and the reason is kept
            failures.append(f"{name}: {error}")
    raise ContextError(
        f"no OpenGL 3.3 context without a display could be made ({'; '.join(failures)}). "
        f"On Debian or Ubuntu: {INSTALL_LINE}, or for OSMesa: {OSMESA_LINE}"
    )


def forked_from_gl() -> bool:
    """Whether this process was forked from one that has used OpenGL: its driver's threads are not here, and the first picture would be waited for for ever."""
    return _first_made_in not in (0, os.getpid())


def device_names() -> tuple[str, ...]:
    """What the devices that EGL can draw on call themselves, by number, each with its own driver. Leaves the last of them current in the thread that calls.

    Raises:
        ContextError: there is none.
    """
    names: list[str] = []
    while len(names) < _MOST_DEVICES:
        try:
            made = create_headless("egl", len(names))
        except ContextError:
            if not names:
                raise
            break
        names.append(describe(made))
        made.release()
    return tuple(names)


def describe(ctx: moderngl.Context) -> str:
    """Renderer and version, for people."""
    return f"{ctx.info['GL_RENDERER']}, OpenGL {ctx.info['GL_VERSION']}"


def hear_glfw(glfw: Any) -> list[str]:
    """What the module `glfw` says of its errors from now on, the last at the end; left to itself it warns of them."""
    said: list[str] = []
    glfw.set_error_callback(lambda code, text: said.append(text.decode("utf-8", "replace")))
    return said


def _context(**settings: Any) -> moderngl.Context:
    return moderngl.create_context(require=330, **settings)


def _egl(device: int | None) -> moderngl.Context:
    chosen = {} if device is None else {"device_index": device}
    try:
        return _context(standalone=True, backend="egl", libgl="libGL.so.1", libegl="libEGL.so.1", **chosen)  # by name: to look for them runs ldconfig, twice
    except Exception:  # elsewhere they have other names
        return _context(standalone=True, backend="egl", **chosen)


class _GlfwLoader:
    """What moderngl asks of a context that GLFW made and keeps current."""

    def __init__(self, glfw, window):
        self._glfw, self._window = glfw, window

    def load_opengl_function(self, name: str) -> int:
        return ctypes.cast(self._glfw.get_proc_address(name), ctypes.c_void_p).value or 0

    def __enter__(self):
        self._glfw.make_context_current(self._window)
        return self

    def __exit__(self, *_):
        return None

    def release(self) -> None:
        self._glfw.destroy_window(self._window)


def _osmesa() -> moderngl.Context:
    import glfw  # only here: rendering through EGL loads no window library

    said = hear_glfw(glfw)
    glfw.init_hint(glfw.PLATFORM, glfw.PLATFORM_NULL)
    if not glfw.init():
        raise ContextError(": ".join(["GLFW's null platform does not start", *said[-1:]]))
    for hint, value in (
        (glfw.CONTEXT_CREATION_API, glfw.OSMESA_CONTEXT_API),
        (glfw.VISIBLE, False),
        (glfw.CONTEXT_VERSION_MAJOR, 3),
        (glfw.CONTEXT_VERSION_MINOR, 3),
        (glfw.OPENGL_PROFILE, glfw.OPENGL_CORE_PROFILE),
    ):
        glfw.window_hint(hint, value)
    window = glfw.create_window(16, 16, "", None, None)
    if not window:
        raise ContextError(": ".join(["OSMesa cannot be loaded", *said[-1:]]))
    glfw.make_context_current(window)
    return _context(context=_GlfwLoader(glfw, window))
