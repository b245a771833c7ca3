"""A picture of any size, made between the window's frames: it is what `render` writes, and what is held of it does not grow with its height."""

from __future__ import annotations

import tracemalloc
from pathlib import Path
from typing import Any

import numpy as np
import pytest

from blackhole_gl.app.still import TILE, Order, Still
from blackhole_gl.output import png
from blackhole_gl.rendering import still_files, stills
from blackhole_gl.rendering.frame import Renderer
from blackhole_gl.scene import presets


class _Lent:
    """The suite's renderer, which lives on when a picture gives its own back."""

    def __init__(self, renderer: Renderer):
        self._renderer = renderer

    def __getattr__(self, name: str) -> Any:
        return getattr(self._renderer, name)

    def release(self) -> None:
        pass


def _made(renderer: Renderer, order: Order) -> None:
    still = Still(_Lent(renderer), order)
    try:
        while not still.is_over:
            still.advance()
        assert still.result() == f"Saved {order.path}" and still.share == 1.0
    finally:
        still.close()


@pytest.mark.parametrize("values", [{}, {"post.labels": True}], ids=["as it is", "with labels"])
def test_a_picture_from_the_window_is_what_render_writes(values: dict[str, object], renderer: Renderer, tmp_path: Path) -> None:
    """Labels are drawn on all of it; without any it goes band by band."""
    scene, size = presets.load(["kerr"], values), (300, 170)
    _made(renderer, Order(scene, 3.0, size, 2, tmp_path / "window.png"))
    for _ in still_files.write(renderer, tmp_path / "render.png", scene, 3.0, size, 2, TILE):
        pass
    assert np.array_equal(png.read(tmp_path / "window.png"), png.read(tmp_path / "render.png"))
    assert presets.load([str(tmp_path / "window.png")]) == scene


def test_what_is_held_of_a_picture_does_not_grow_with_its_height(renderer: Renderer, tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(stills, "_BAND_PIXELS", 1)  # bands as low as they can be
    held = []
    for height in (3072, 6144):
        tracemalloc.start()
        try:
            _made(renderer, Order(presets.load(["kerr"]), 0.0, (1024, height), 1, tmp_path / f"{height}.png"))
            held.append(tracemalloc.get_traced_memory()[1])
        finally:
            tracemalloc.stop()
    # Strips that wait to be packed are more or fewer as threads have it, by 3 MB here; all of the higher picture would be 9 MB more.
    print(held)
    assert held[1] - held[0] < 0.5 * 3072 * 1024 * 3
