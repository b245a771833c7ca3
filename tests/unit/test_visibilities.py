"""Visibilities against closed forms: a Gaussian, a thin ring, a pair of points; where north and east are; and files that other programs read."""

from __future__ import annotations

import csv
from pathlib import Path

import numpy as np
import pytest
from astropy.io import fits
from astropy.wcs import WCS
from scipy.special import j0

from blackhole_gl import research
from blackhole_gl.measure import visibilities
from blackhole_gl.measure.visibilities import SkyPicture
from blackhole_gl.physics import angular_size
from blackhole_gl.rendering.frame import Renderer
from blackhole_gl.scene import presets

UAS = angular_size.MICROARCSECOND
U = np.array([0.0, 1.3e9, -4.0e9, 7.5e9, 2.0e9])
V = np.array([0.0, -2.1e9, 3.0e9, 0.4e9, 0.0])


def picture_of(light: np.ndarray, pixel_uas: float = 0.5) -> SkyPicture:
    return SkyPicture(light / light.sum(), pixel_uas * UAS)


def about(size: int, pixel_uas: float) -> tuple[np.ndarray, np.ndarray]:
    """East and north of pixels' middles, in radians."""
    along = (np.arange(size) - 0.5 * (size - 1)) * pixel_uas * UAS
    return -along[None, :], -along[:, None]


def test_a_gaussians_visibility_is_a_gaussian() -> None:
    east, north = about(257, 0.5)
    sigma, place = 8.0 * UAS, (5.0 * UAS, -3.0 * UAS)
    light = np.exp(-0.5 * ((east - place[0]) ** 2 + (north - place[1]) ** 2) / sigma**2)
    found = visibilities.of(picture_of(light), U, V)
    expected = np.exp(-2.0 * (np.pi * sigma) ** 2 * (U**2 + V**2)) * np.exp(-2j * np.pi * (U * place[0] + V * place[1]))
    # The sum over a smooth function's samples errs by its tail beyond the picture's edge, exp(−0.5·(59/8)²) = 2e-12, alone.
    assert np.abs(found.value - expected).max() < 1e-10
    assert found.amplitude[0] == pytest.approx(1.0, abs=1e-12) and found.phase[2] == pytest.approx(np.angle(expected[2]), abs=1e-6)


def test_a_thin_rings_visibility_is_bessels_function() -> None:
    size, pixel, radius, width = 512, 0.25, 21.0 * UAS, 0.5 * UAS
    east, north = about(size, pixel)
    light = np.exp(-0.5 * ((np.hypot(east, north) - radius) / width) ** 2)
    found = visibilities.of(picture_of(light, pixel), U, V)
    q = 2.0 * np.pi * np.hypot(U, V)
    # Of a ring of width σ: J0(qr) exp(−q²σ²/2) to order σ²/r² = 6e-4 of what is left of it.
    expected = j0(q * radius) * np.exp(-0.5 * (q * width) ** 2)
    assert np.abs(found.value - expected).max() < 6e-4
    zero = 2.404825557695773 / (2.0 * np.pi * radius)
    assert visibilities.of(picture_of(light, pixel), zero, 0.0).amplitude < 1e-3


def test_a_pair_of_points_beats_and_closes() -> None:
    light = np.zeros((64, 64))
    light[20, 10], light[40, 50] = 3.0, 1.0
    east, north = about(64, 0.5)
    places = [(east[0, 10], north[20, 0]), (east[0, 50], north[40, 0])]
    u, v = np.stack([U, V, -U - V], -1), np.stack([V, -U, U - V], -1)
    found = visibilities.of(picture_of(light), u, v)
    expected = sum(share * np.exp(-2j * np.pi * (u * x + v * y)) for share, (x, y) in zip((0.75, 0.25), places))
    assert np.abs(found.value - expected).max() < 1e-12
    assert np.allclose(found.closure_phases(), np.angle(expected[:, 0] * expected[:, 1] * expected[:, 2]), atol=1e-12)
    moved = visibilities.of(picture_of(np.roll(light, (7, -5), (0, 1))), u, v)
    assert np.allclose(moved.closure_phases(), found.closure_phases(), atol=1e-9), "closure phases know no place"
    assert not np.allclose(moved.phase, found.phase, atol=0.1)
    with pytest.raises(ValueError, match="do not add up to 0"):
        visibilities.of(picture_of(light), u + 1e8, v).closure_phases()
    with pytest.raises(ValueError, match="three to a triangle"):
        visibilities.of(picture_of(light), U, V).closure_phases()
    with pytest.raises(ValueError, match="finite u and v"):
        visibilities.of(picture_of(light), np.nan, 0.0)


def test_many_baselines_are_taken_in_parts(monkeypatch: pytest.MonkeyPatch) -> None:
    picture = picture_of(np.random.default_rng(1).random((9, 12)))
    whole = visibilities.of(picture, U, V).value
    monkeypatch.setattr(visibilities, "_AT_ONCE", 2)
    assert np.array_equal(visibilities.of(picture, U, V).value, whole)
    assert visibilities.of(picture, np.empty((0, 3)), 0.0).value.shape == (0, 3)


@pytest.fixture(scope="module")
def measured(renderer: Renderer) -> SkyPicture:
    return visibilities.sky_picture(renderer, presets.load(["m87_eht"]), 0.0, (80, 60))


def test_a_scenes_picture_has_its_angles_and_the_roll_is_the_position_angle(renderer: Renderer, measured: SkyPicture) -> None:
    scene = presets.load(["m87_eht"])
    assert measured.light.sum() == pytest.approx(1.0) and measured.light.shape == (60, 80)
    assert measured.pixel * 60 == pytest.approx(angular_size.picture_height_uas(scene.camera, scene.source) * UAS, rel=1e-12)
    # A quarter turn more puts what was north to the east: (u, v) to (v, −u) brings it back. Square pictures turn without a border's effect.
    for roll, (u, v) in ((0.0, (U, V)), (90.0, (V, -U))):
        turned = scene.with_values({"camera.roll_deg": roll, "rays.edges": 1})
        found = visibilities.of(visibilities.sky_picture(renderer, turned, 0.0, (60, 60)), u, v).value
        if roll == 0.0:
            upright = found
    # Half floats of the light, and rays that a turn moves by rounding.
    assert np.abs(found - upright).max() < 2e-3 < np.abs(upright[1:3]).min()


def test_a_picture_of_the_whole_sky_is_no_plane_one(renderer: Renderer) -> None:
    for key, value in (("camera.projection", "equirectangular"), ("post.view", "order")):
        with pytest.raises(ValueError, match=f"{key}: got"):
            visibilities.sky_picture(renderer, presets.load(["kerr"], {key: value}), 0.0, (64, 32))


def test_fits_is_such_as_ehtim_reads(renderer: Renderer, measured: SkyPicture, tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    """Its reader takes the primary image, NAXIS1 and 2, CDELT1 and 2 in degrees, OBSRA and OBSDEC, FREQ, MJD, OBJECT, and BUNIT, and turns rows upside down."""
    monkeypatch.setattr(research, "renderer_by", lambda backend: renderer)
    research.visibilities(names=["m87_eht"], sky=tmp_path / "x.fits", flux=0.6, at="187.7059,12.3911", size="80x60")
    with fits.open(tmp_path / "x.fits") as file:
        header, data = file[0].header, file[0].data
        assert data.ndim == 2 and (header["NAXIS1"], header["NAXIS2"], header["BUNIT"]) == (80, 60, "JY/PIXEL")
        assert data.sum() == pytest.approx(0.6) and np.allclose(data[::-1], 0.6 * measured.light)
        assert (header["OBSRA"], header["OBSDEC"], header["FREQ"], header["MJD"]) == (187.7059, 12.3911, 230e9, 0.0)
        assert np.radians(abs(header["CDELT1"])) == pytest.approx(measured.pixel) and header["CDELT1"] < 0.0 < header["CDELT2"]
        middle = WCS(header).pixel_to_world(39.5, 29.5)
        assert (middle.ra.deg, middle.dec.deg) == pytest.approx((187.7059, 12.3911), abs=1e-12)
        assert file[1].data.ndim == 1, "which that reader passes over"
        assert presets.parse(file["SCENE"].data.tobytes().decode()).values["hole.spin"] == 0.94


def test_lists_come_back_with_what_was_measured(renderer: Renderer, measured: SkyPicture, tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(research, "renderer_by", lambda backend: renderer)
    (tmp_path / "uv.csv").write_text("u,v,pair\n1e9,2e9,AA-LM\n-3e9,1e9,AA-SP\n")
    (tmp_path / "tri.csv").write_text("u1,v1,u2,v2\n1e9,2e9,-3e9,1e9\n")
    given = {"names": ["m87_eht"], "size": "80x60", "flux": 0.5}
    research.visibilities(tmp_path / "a.csv", baselines=tmp_path / "uv.csv", **given)
    research.visibilities(tmp_path / "b.csv", triangles=tmp_path / "tri.csv", **given)
    single, (triangle,) = (list(csv.DictReader((tmp_path / name).open())) for name in ("a.csv", "b.csv"))
    expected = visibilities.of(measured, [1e9, -3e9, 2e9], [2e9, 1e9, -3e9])
    assert [row["pair"] for row in single] == ["AA-LM", "AA-SP"]
    assert [float(row["amplitude"]) for row in single] == pytest.approx(list(0.5 * expected.amplitude[:2]))
    assert [float(row["phase_deg"]) for row in single] == pytest.approx(list(np.degrees(expected.phase[:2])))
    assert [float(triangle[f"amplitude{k}"]) for k in (1, 2, 3)] == pytest.approx(list(0.5 * expected.amplitude))
    assert float(triangle["closure_phase_deg"]) == pytest.approx(np.degrees(expected.closure_phases()))


def test_what_cannot_be_is_told(tmp_path: Path) -> None:
    (tmp_path / "uv.csv").write_text("u,w\n1e9,2e9\n")
    (tmp_path / "good.csv").write_text("u,v\n1e9,2e9\n")
    out = tmp_path / "x.csv"
    wrong = (
        ({"baselines": tmp_path / "uv.csv", "out": out}, "column v is missing; this option needs u,v, the file has u,w"),
        ({"baselines": tmp_path / "good.csv"}, "allowed is --out with one of --baselines"),
        ({"out": out}, "allowed is --out with one of --baselines"),
        ({"baselines": tmp_path / "good.csv", "triangles": tmp_path / "good.csv", "out": out}, "allowed is --out with one of"),
        ({"sky": tmp_path / "x.png"}, "got the suffix .png; FITS is written"),
        ({"sky": tmp_path / "x.fits", "at": "12"}, "--at: got '12'; allowed are right ascension and declination"),
    )
    for given, words in wrong:
        with pytest.raises(ValueError) as told:
            research.visibilities(names=["m87_eht"], **given)
        assert words in str(told.value)
    assert sorted(path.name for path in tmp_path.iterdir()) == ["good.csv", "uv.csv"]
