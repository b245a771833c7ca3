"""Both ways to draw without a display, each in a process of its own, and whether they agree."""

from __future__ import annotations

import os
import subprocess
import sys
from pathlib import Path

import moderngl
import numpy as np
import pytest

from blackhole_gl.rendering import context

TRACE = """
import sys
import numpy as np
from blackhole_gl.scene import presets
from blackhole_gl.rendering.context import create_headless, describe
from blackhole_gl.rendering.frame import Renderer

ctx = create_headless()
renderer = Renderer(ctx)
renderer.render(presets.load(["kerr"]), 3.5, (64, 36))
hits = renderer.hits()
np.savez(sys.argv[1], fate=hits.fate, direction=hits.direction, crossing=hits.crossing, picture=renderer.read_rgb8())
print(describe(ctx))
"""


def run(code: str, backend: str, *arguments: str | Path) -> subprocess.CompletedProcess[str]:
    environment = {key: value for key, value in os.environ.items() if key not in ("DISPLAY", "WAYLAND_DISPLAY")}
    environment[context.ENVIRONMENT] = backend
    return subprocess.run([sys.executable, "-c", code, *map(str, arguments)], env=environment, capture_output=True, text=True, timeout=120)


@pytest.fixture(scope="module")
def frames(tmp_path_factory: pytest.TempPathFactory) -> dict[str, dict[str, np.ndarray]]:
    """What each backend found, by its name."""
    found = {}
    for backend in context.BACKENDS:
        path = tmp_path_factory.mktemp("backends") / f"{backend}.npz"
        done = run(TRACE, backend, path)
        assert done.returncode == 0, f"{backend}: {done.stderr}"
        assert "OpenGL" in done.stdout
        with np.load(path) as stored:
            found[backend] = dict(stored)
    return found


@pytest.mark.osmesa
def test_both_backends_find_the_same_hits(frames: dict[str, dict[str, np.ndarray]]) -> None:
    """The same shaders on two drivers: rounding may differ, and rays near the critical curve magnify it."""
    egl, osmesa = frames["egl"], frames["osmesa"]
    assert np.mean(egl["fate"] != osmesa["fate"]) < 2e-3
    same = egl["fate"] == osmesa["fate"]
    apart = np.linalg.norm(egl["direction"] - osmesa["direction"], axis=-1)[same]
    assert np.quantile(apart, 0.98) < 1e-5
    difference = np.abs(egl["picture"].astype(int) - osmesa["picture"].astype(int))
    assert np.mean(difference) < 1.0 and np.mean(difference > 8) < 0.01


def test_egl_draws(frames_of_egl: dict[str, np.ndarray]) -> None:
    assert frames_of_egl["picture"].shape == (36, 64, 3)
    assert np.all(frames_of_egl["fate"] > 0)


@pytest.fixture(scope="module")
def frames_of_egl(tmp_path_factory: pytest.TempPathFactory) -> dict[str, np.ndarray]:
    path = tmp_path_factory.mktemp("egl") / "egl.npz"
    done = run(TRACE, "egl", path)
    assert done.returncode == 0, done.stderr
    with np.load(path) as stored:
        return dict(stored)


# GLFW refuses a way to make contexts that it does not know, as it does one whose library is not there.
WITHOUT_OSMESA = """
import glfw
from blackhole_gl.rendering import context

glfw.OSMESA_CONTEXT_API = 0x1234
try:
    context.create_headless()
except context.ContextError as error:
    print(error)
"""


def test_where_there_is_no_osmesa_the_error_says_so_and_nothing_else_does() -> None:
    done = run(WITHOUT_OSMESA, "osmesa")
    assert done.returncode == 0 and "OSMesa cannot be loaded: Invalid context creation API" in done.stdout
    assert done.stderr == ""


def test_an_unknown_backend_is_refused(monkeypatch: pytest.MonkeyPatch) -> None:
    with pytest.raises(ValueError, match="backend: got 'metal'; allowed is one of auto, egl, osmesa"):
        context.create_headless("metal")
    monkeypatch.setenv(context.ENVIRONMENT, "metal")
    with pytest.raises(ValueError, match="'metal'"):
        context.create_headless()


def test_without_any_library_the_error_has_the_line_that_installs_one(monkeypatch: pytest.MonkeyPatch) -> None:
    def missing(*_):
        raise RuntimeError("libEGL.so.1 not found")

    for maker in ("_egl", "_osmesa"):
        monkeypatch.setattr(context, maker, missing)
    monkeypatch.delenv(context.ENVIRONMENT, raising=False)
    with pytest.raises(context.ContextError) as caught:
        context.create_headless("auto")
    assert "libEGL.so.1 not found" in str(caught.value)
    assert context.INSTALL_LINE in str(caught.value) and context.OSMESA_LINE in str(caught.value)


def test_a_second_context_in_a_test_process_fails_where_it_is_made(ctx: moderngl.Context) -> None:
    """It would corrupt the heap (tests/conftest.py)."""
    with pytest.raises(pytest.fail.Exception, match="a second GL context in one process"):
        context.create_headless()
