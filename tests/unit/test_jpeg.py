"""JPEG files: the preset inside, and what is said of files that are not ours."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest
from PIL import Image

from blackhole_gl.output import jpeg, xmp
from blackhole_gl.scene import presets

TEXT = 'title = "Grüße, r_s ☾"\n[hole]\nspin = 0.5\n'


@pytest.fixture
def pixels() -> np.ndarray:
    """Smooth colours, so that what packing loses stays small."""
    across, along = np.meshgrid(np.linspace(0, 255, 64), np.linspace(0, 255, 32))
    return np.stack([across, along, 255 - across], axis=-1).astype(np.uint8)


@pytest.mark.parametrize("text", [TEXT, TEXT + 20_000 * "# long ☾\n"], ids=["short", "in pieces"])
def test_pixels_text_and_metadata_come_back(text: str, pixels: np.ndarray, tmp_path: Path) -> None:
    path = tmp_path / "new folder" / "a.jpg"
    jpeg.write(path, pixels, text, xmp.panorama((64, 32)))
    assert jpeg.read_scene_text(path) == text
    with Image.open(path) as shown:
        assert shown.format == "JPEG" and b"equirectangular" in shown.info["xmp"]
        # Quality 95 leaves smooth colours within 4 levels of 255.
        assert np.abs(np.asarray(shown.convert("RGB")).astype(int) - pixels).max() <= 4
    before = path.read_bytes()
    jpeg.write(path, pixels, text, xmp.panorama((64, 32)))
    assert path.read_bytes() == before, "equal input gives equal bytes"


def test_a_picture_is_a_preset(pixels: np.ndarray, tmp_path: Path) -> None:
    scene = presets.load(["kerr"], {"hole.spin": 0.25})
    for name in ("a.jpg", "b.JPEG"):
        jpeg.write(tmp_path / name, pixels, presets.picture_text(scene, 2.0, tmp_path))
        assert presets.load([str(tmp_path / name)]) == scene and presets.read(tmp_path / name).time == 2.0


@pytest.mark.parametrize(
    "change, words",
    [
        (lambda data: b"PNG" + data, "not a JPEG"),
        (lambda data: data[:30], "it ends early"),
        (lambda data: data.replace("☾".encode(), b"\xff\xff\xff"), "not UTF-8"),
        (lambda data: data.replace(b"blackhole_gl.scene", b"blackhole_gl.other"), "carries no preset"),
    ],
)
def test_other_files_are_refused_with_a_sentence(change, words: str, pixels: np.ndarray, tmp_path: Path) -> None:
    path = tmp_path / "a.jpg"
    jpeg.write(path, pixels, TEXT)
    path.write_bytes(change(path.read_bytes()))
    with pytest.raises(presets.PresetError, match=words):
        presets.load([str(path)])
