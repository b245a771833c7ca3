"""A display without a screen, for tests of what only a real window has: keyboards, scales."""

import contextlib
import ctypes
import os
import shutil
import subprocess

TOOLS = {"Xvfb": "xvfb", "setxkbmap": "x11-xkb-utils", "xdotool": "xdotool", "xprop": "x11-utils"}
_STARTS_S = 10.0
_CLIENT_MESSAGE = 33  # X.h


@contextlib.contextmanager
def opened(tools, size="1000x700", dpi=0):
    """Environment variables in which a window opens on a display of `size` pixels, which says that `dpi` of them are an inch, or nothing.

    `tools`: of `TOOLS`, which are needed.
    """
    missing = [tool for tool in tools if not shutil.which(tool)]
    assert not missing, f"{', '.join(missing)} is not there; on Debian: apt-get install {' '.join(TOOLS[tool] for tool in missing)}"
    reader, writer = os.pipe()
    command = ["Xvfb", "-displayfd", str(writer), "-noreset", "-screen", "0", f"{size}x24"]
    server = subprocess.Popen(command, pass_fds=[writer], stderr=subprocess.DEVNULL)
    os.close(writer)
    with os.fdopen(reader) as answer:
        environment = os.environ | {"DISPLAY": ":" + answer.readline().strip()}
        environment.pop("WAYLAND_DISPLAY", None)
        if dpi:
            said = ["-format", "RESOURCE_MANAGER", "8s", "-set", "RESOURCE_MANAGER", f"Xft.dpi: {dpi}\n"]
            subprocess.run(["xprop", "-root", *said], env=environment, check=True)
        yield environment
    server.terminate()
    server.wait(_STARTS_S)


class _ClientMessage(ctypes.Structure):
    """XClientMessageEvent of Xlib.h, filled up to the size of the union XEvent."""

    _fields_ = [
        ("type", ctypes.c_int), ("serial", ctypes.c_ulong), ("send_event", ctypes.c_int), ("display", ctypes.c_void_p), ("window", ctypes.c_ulong),
        ("message_type", ctypes.c_ulong), ("format", ctypes.c_int), ("data", ctypes.c_long * 5), ("rest", ctypes.c_long * 12),
    ]  # fmt: skip


def press_close_button(environment, title):
    """Asks the window of that title to close, as a window manager does when the button in its frame is pressed. Needs xdotool."""
    found = subprocess.run(["xdotool", "search", "--sync", "--name", title], env=environment, capture_output=True, text=True, check=True, timeout=30)
    x11 = ctypes.CDLL("libX11.so.6")
    x11.XOpenDisplay.restype, x11.XInternAtom.restype = ctypes.c_void_p, ctypes.c_ulong
    x11.XInternAtom.argtypes = [ctypes.c_void_p, ctypes.c_char_p, ctypes.c_int]
    x11.XSendEvent.argtypes = [ctypes.c_void_p, ctypes.c_ulong, ctypes.c_int, ctypes.c_long, ctypes.c_void_p]
    x11.XCloseDisplay.argtypes = [ctypes.c_void_p]
    display, window = x11.XOpenDisplay(environment["DISPLAY"].encode()), int(found.stdout.split()[0])
    protocols, delete = (x11.XInternAtom(display, name, 0) for name in (b"WM_PROTOCOLS", b"WM_DELETE_WINDOW"))
    message = _ClientMessage(_CLIENT_MESSAGE, window=window, message_type=protocols, format=32)
    message.data[0] = delete
    assert x11.XSendEvent(display, window, 0, 0, ctypes.byref(message))
    x11.XCloseDisplay(display)  # which sends what is still to be sent
