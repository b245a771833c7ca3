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
from blackhole_gl.physics import angular_size, observer, projection
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


def test_depth_is_that_of_what_is_seen_first(renderer: Renderer) -> None:
    """Where space is flat a ray meets the disk's plane and a ball where a straight line does: one before the disk, one behind it, one half through."""
    balls = {"near": (6.0, -4.0, 1.0), "behind": (0.0, 5.0, -2.5), "through": (2.0, 6.0, 0.0)}
    values: dict = {"rays.lensing": False, "camera.inclination_deg": 60.0, "camera.fov_deg": 50.0, "hole.spin": 0.0}
    for name, place in balls.items():
        values |= {f"things.{name}.kind": "sphere", f"things.{name}.radius": 1.5, **{f"things.{name}.{axis}": x for axis, x in zip("xyz", place)}}
    scene = presets.load(["kerr"], values)
    found = layers.measured(renderer, scene, 0.0, SIZE)
    seen = observer.observe(scene)
    ways = projection.directions(scene.camera, SIZE, _middles()).reshape(-1, 3) @ np.stack([seen.n, seen.e_theta, seen.e_phi])
    begin, nearest = scene.camera.distance * seen.n, np.full(len(ways), np.inf)
    plane = -begin[2] / ways[:, 2]
    r = np.linalg.norm(begin + plane[:, None] * ways, axis=-1)
    nearest[(plane > 0.0) & (found.order.ravel() == 0)] = plane[(plane > 0.0) & (found.order.ravel() == 0)]
    assert np.all((r < scene.disk.outer_radius + 1e-3)[found.order.ravel() == 0])
    for place in balls.values():
        along, apart = ways @ (np.array(place) - begin), np.sum((np.array(place) - begin) ** 2)
        under = along**2 - apart + 1.5**2
        nearest = np.where(under > 0.0, np.minimum(nearest, along - np.sqrt(np.maximum(under, 0.0))), nearest)
    depth = found.depth.ravel()
    both = np.isfinite(depth) & np.isfinite(nearest)
    assert both.sum() > 300 and (np.isfinite(depth) != np.isfinite(nearest)).mean() < 0.01  # a ray that grazes a ball
    assert np.quantile(np.abs(depth - nearest)[both], 0.99) < 1e-3


def test_depth_from_infinity_is_told_from_the_plane_through_the_hole(renderer: Renderer) -> None:
    far = {"camera.distance": float("inf"), "camera.field_m": 50.0, "camera.inclination_deg": 60.0}
    scene = presets.load(["kerr"], {"rays.lensing": False, "hole.spin": 0.0, **far})
    found = layers.measured(renderer, scene, 0.0, SIZE)
    shows = found.order == 0
    nearer = -found.r * np.cos(found.phi) * np.sin(np.radians(60.0))  # the camera looks along −x from above
    assert shows.sum() > 100 and np.allclose(found.depth[shows], nearer[shows], atol=1e-4)
    assert found.depth[shows].min() < -5.0 and found.depth[shows].max() > 5.0


def _middles() -> np.ndarray:
    return np.stack(np.meshgrid(np.arange(SIZE[0]) + 0.5, SIZE[1] - 0.5 - np.arange(SIZE[1])), axis=-1)


def test_openexr_is_read_by_another_library(scene: Scene, made: layers.Layers, tmp_path: Path) -> None:
    layers.write(tmp_path / "x.exr", made, scene, 2.0)
    with av.open(str(tmp_path / "x.exr")) as container:
        planes = next(container.decode(video=0)).to_ndarray(format="gbrpf32le")
    assert np.array_equal(planes, made.radiance)
    again = OpenEXR.File(str(tmp_path / "x.exr"))
    assert np.array_equal(again.channels()["g.V"].pixels, made.g, equal_nan=True)
    assert np.array_equal(again.channels()["Z"].pixels, made.depth, equal_nan=True)
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
        for name in ("radiance", "fate", "order", "r", "phi", "g", "depth"):
            assert np.array_equal(file[name], getattr(made, name), equal_nan=name not in ("fate", "order"))
        assert presets.parse(str(file["scene"])).time == 2.0


def test_what_is_not_installed_is_named(scene: Scene, made: layers.Layers, tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setitem(__import__("sys").modules, "OpenEXR", None)
    with pytest.raises(layers.LayersError, match=r"pip install 'blackhole-gl\[exr\]'"):
        layers.write(tmp_path / "x.exr", made, scene, 2.0)
    assert not (tmp_path / "x.exr").exists()
