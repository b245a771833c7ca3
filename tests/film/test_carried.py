"""Layers and films open again: the scene that they carry."""

from __future__ import annotations

from fractions import Fraction
from pathlib import Path

import numpy as np
import pytest

import blackhole_gl as bh
from blackhole_gl import film, layers
from blackhole_gl.output import carried
from blackhole_gl.physics.flight import Flight
from blackhole_gl.rendering.frame import Renderer
from blackhole_gl.scene import presets
from blackhole_gl.scene.presets import PresetError

SCENE = bh.load("schwarzschild", {"camera.distance": 17.0, "disk.enabled": False, "sky.enabled": False})


@pytest.mark.parametrize("suffix", [".npz", ".exr", ".fits"])
def test_layers_open_again(suffix: str, renderer: Renderer, tmp_path: Path) -> None:
    path = tmp_path / f"layers{suffix}"
    layers.write(path, layers.measured(renderer, SCENE, 3.5, (18, 10)), SCENE, 3.5)
    assert bh.load(path) == SCENE == presets.load([str(path)])
    last = presets.last_timed([path])
    assert last is not None and last.time == 3.5


@pytest.mark.parametrize("suffix", [".mp4", ".mov", ".mkv", ".webm"])
def test_a_film_opens_as_the_scene_that_it_begins_with(suffix: str, tmp_path: Path) -> None:
    made = film.Film(Flight(SCENE, start=2.0), fps=Fraction(30), count=2, size=(32, 18), samples=1, shutter_deg=0.0)
    path = tmp_path / f"film{suffix}"
    with film.packing_of(made, path, film.codec_of(path, None)) as pack:
        for _ in range(2):
            pack(np.zeros((18, 32, 3), np.uint8))
    assert bh.load(path) == SCENE


@pytest.mark.parametrize("suffix", sorted(carried.READERS))
def test_a_file_of_another_kind_is_told(suffix: str, tmp_path: Path) -> None:
    path = tmp_path / f"wrong{suffix}"
    for content in (b"", b"no such file\n" * 50):
        path.write_bytes(content)
        with pytest.raises(PresetError, match=f"wrong{suffix}: cannot be read as {suffix}: |wrong{suffix}: it carries no preset"):
            bh.load(path)
    with pytest.raises(PresetError, match="cannot be read: No such file"):
        bh.load(tmp_path / f"none{suffix}")


def test_layers_of_others_carry_no_preset(tmp_path: Path) -> None:
    np.savez(tmp_path / "others.npz", light=np.zeros(3))
    with pytest.raises(PresetError, match="it carries no preset; only .npz files that Blackhole GL wrote do"):
        bh.load(tmp_path / "others.npz")
    np.savez(tmp_path / "bomb.npz", scene=np.zeros(6_000_000, np.uint8))
    with pytest.raises(PresetError, match="carries no preset"):
        bh.load(tmp_path / "bomb.npz")
    np.savez(tmp_path / "objects.npz", scene=np.array({}, object), allow_pickle=True)
    with pytest.raises(PresetError, match="cannot be read as .npz"):
        bh.load(tmp_path / "objects.npz")
