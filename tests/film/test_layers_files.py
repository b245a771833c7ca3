"""Radiance and layers as files: other libraries read back what there was."""

from __future__ import annotations

from pathlib import Path

import av
import numpy as np
import OpenEXR
import pytest
from astropy.io import fits
from astropy.wcs import WCS

from blackhole_gl import layers, listed_rays
from blackhole_gl.physics import angular_size
from blackhole_gl.rendering.frame import Renderer
from blackhole_gl.scene import Scene, presets

SIZE = (48, 28)


@pytest.fixture(scope="module")
def scene() -> Scene:
    return presets.load(["m87_eht"], {"post.beam": False})


@pytest.fixture(scope="module")
def made(scene: Scene, renderer: Renderer) -> layers.Layers:
    return layers.measured(renderer, scene, 2.0, SIZE)


def test_layers_are_those_of_rays_through_the_pixels(scene: Scene, made: layers.Layers, renderer: Renderer) -> None:
    found = listed_rays.trace_by_shader(renderer, scene, listed_rays.pixel_rays(scene, SIZE).reshape(-1, 2))
    assert np.array_equal(made.fate.ravel(), found.fate)
    direct = made.order.ravel() == 0
    assert direct.sum() > 100 and (made.order < 0).any()
    assert np.array_equal(made.g.ravel()[direct], found.crossing_g[direct, 0].astype(np.float32))
    assert np.array_equal(np.isnan(made.r), made.order < 0)
    dark = made.radiance.sum(axis=-1) == 0.0
    assert np.all(made.order[dark] < 0), "the disk is seen where there is light"


def test_openexr_is_read_by_another_library(scene: Scene, made: layers.Layers, tmp_path: Path) -> None:
    layers.write(tmp_path / "x.exr", made, scene, 2.0)
    with av.open(str(tmp_path / "x.exr")) as container:
        planes = next(container.decode(video=0)).to_ndarray(format="gbrpf32le")
    assert np.array_equal(planes, made.radiance)
    again = OpenEXR.File(str(tmp_path / "x.exr"))
    assert np.array_equal(again.channels()["g.V"].pixels, made.g, equal_nan=True)
    assert presets.parse(again.header()["blackhole_gl.scene"]).over(Scene()).source == scene.source


def test_fits_has_the_skys_coordinates(scene: Scene, made: layers.Layers, tmp_path: Path) -> None:
    layers.write(tmp_path / "x.fits", made, scene, 2.0)
    with fits.open(tmp_path / "x.fits") as file:
        assert np.array_equal(file[0].data, np.moveaxis(made.radiance[::-1], -1, 0))
        assert np.array_equal(file["G"].data, made.g[::-1], equal_nan=True) and np.array_equal(file["ORDER"].data, made.order[::-1])
        sky = WCS(file["G"].header)
        low, high = (sky.pixel_to_world(0.5 * (SIZE[0] - 1), y) for y in (-0.5, SIZE[1] - 0.5))
        assert low.separation(high).to_value("uas") == pytest.approx(angular_size.picture_height_uas(scene.camera, scene.source), rel=1e-6)
        assert presets.parse(file["SCENE"].data.tobytes().decode()).over(Scene()).source == scene.source


def test_a_numpy_archive_holds_all_of_it(scene: Scene, made: layers.Layers, tmp_path: Path) -> None:
    layers.write(tmp_path / "x.npz", made, scene, 2.0)
    with np.load(tmp_path / "x.npz") as file:
        for name in ("radiance", "fate", "order", "r", "phi", "g"):
            assert np.array_equal(file[name], getattr(made, name), equal_nan=name not in ("fate", "order"))
        assert presets.parse(str(file["scene"])).time == 2.0


def test_what_is_not_installed_is_named(scene: Scene, made: layers.Layers, tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setitem(__import__("sys").modules, "OpenEXR", None)
    with pytest.raises(layers.LayersError, match=r"pip install 'blackhole-gl\[exr\]'"):
        layers.write(tmp_path / "x.exr", made, scene, 2.0)
    assert not (tmp_path / "x.exr").exists()
