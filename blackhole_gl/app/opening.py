"""The platform that windows are opened on, and whether it opens one that can be drawn in."""

from __future__ import annotations

from imgui_bundle import hello_imgui  # noqa: F401  before glfw: on Linux the first GLFW that is loaded is the one used

# isort: split
import glfw
import moderngl

from ..rendering import context

_LEAST = (3, 3)  # the OpenGL that the shaders need


class WindowError(context.ContextError):
    """The window cannot be opened; the text says why and what mends it."""


def open_platform(null_platform: bool) -> str:
    """Starts GLFW and opens a hidden window for a moment, so that the reason is known where one cannot be; the window's library keeps it to itself.

    Args:
        null_platform: no display at all: GLFW's null platform on EGL.

    Returns:
        Renderer and version, for people.

    Raises:
        WindowError: no display, or no OpenGL 3.3.
    """
    if null_platform:
        glfw.init_hint(glfw.PLATFORM, glfw.PLATFORM_NULL)
    said = context.hear_glfw(glfw)
    if not glfw.init():
        reason = said[-1] if said else "GLFW does not start"
        raise WindowError(f"no window can be opened: {reason}. Without a display, use `blackhole-gl render`; under Wayland, install xwayland.")
    try:
        described = _hidden_window(null_platform)
    except Exception as error:  # whatever a driver or a loader of its functions says
        reason = said[-1] if said else str(error)
        raise WindowError(
            f"no window with OpenGL {_LEAST[0]}.{_LEAST[1]} can be opened: {reason}. A newer graphics driver is needed, or Mesa's software renderer "
            "(on Linux: LIBGL_ALWAYS_SOFTWARE=1 blackhole-gl); `blackhole-gl render` may work without."
        ) from None
    glfw.default_window_hints()
    _platform_hints(null_platform)
    return described


def _platform_hints(null_platform: bool) -> None:
    if null_platform:
        glfw.window_hint(glfw.CONTEXT_CREATION_API, glfw.EGL_CONTEXT_API)


def _hidden_window(null_platform: bool) -> str:
    _platform_hints(null_platform)
    for hint, value in (
        (glfw.VISIBLE, False),
        (glfw.CONTEXT_VERSION_MAJOR, _LEAST[0]),
        (glfw.CONTEXT_VERSION_MINOR, _LEAST[1]),
        (glfw.OPENGL_PROFILE, glfw.OPENGL_CORE_PROFILE),
        (glfw.OPENGL_FORWARD_COMPAT, True),
    ):
        glfw.window_hint(hint, value)
    window = glfw.create_window(16, 16, "", None, None)
    if not window:
        raise WindowError("the driver gives no reason")
    try:
        glfw.make_context_current(window)
        made = moderngl.create_context(require=100 * _LEAST[0] + 10 * _LEAST[1])
        described = context.describe(made)
        made.release()  # with one left, moderngl finds no other of EGL's
        return described
    finally:
        glfw.destroy_window(window)
