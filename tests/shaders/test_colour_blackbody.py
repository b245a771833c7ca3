"""The colours of black bodies against numbers that do not come from the script that fitted them."""

from __future__ import annotations

import hashlib
import re

import numpy as np
import pytest

from blackhole_gl.resources import assets_dir
from tests.shaders.harness import Piece

# Linear Rec. 709 to XYZ (ITU-R BT.709 primaries, D65).
TO_XYZ = np.array([[0.4124564, 0.3575761, 0.1804375], [0.2126729, 0.7151522, 0.0721750], [0.0193339, 0.1191920, 0.9503041]])


def fitted_observer(nm: np.ndarray) -> np.ndarray:
    """CIE 1931 2° colour matching functions by the Gaussian fits of Wyman, Sloan & Shirley (2013); (n, 3)."""

    def lobe(peak: float, below: float, above: float) -> np.ndarray:
        return np.exp(-0.5 * ((nm - peak) * np.where(nm < peak, below, above)) ** 2)

    x = 0.362 * lobe(442.0, 0.0624, 0.0374) + 1.056 * lobe(599.8, 0.0264, 0.0323) - 0.065 * lobe(501.1, 0.0490, 0.0382)
    y = 0.821 * lobe(568.8, 0.0213, 0.0247) + 0.286 * lobe(530.9, 0.0613, 0.0322)
    z = 1.217 * lobe(437.0, 0.0845, 0.0278) + 0.681 * lobe(459.0, 0.0385, 0.0725)
    return np.stack([x, y, z], -1)


def planck_chromaticity(kelvin: float) -> np.ndarray:
    """(x, y) by Planck's law and the fitted observer."""
    nm = np.arange(360.0, 831.0)
    radiance = nm**-5.0 / np.expm1(1.4387769e7 / (nm * kelvin))
    xyz = radiance @ fitted_observer(nm)
    return xyz[:2] / xyz.sum()


@pytest.fixture(scope="module")
def colours(ctx, tmp_path_factory):
    """Temperatures (K) → linear Rec. 709 by the shader's own fit."""
    path = tmp_path_factory.mktemp("colour") / "colour.frag"
    path.write_text(
        '#version 330 core\n#include "common/colour.glsl"\nuniform sampler2D kelvins;\nout vec4 o;\n'
        "void main() { o = vec4(blackbody_colour(texelFetch(kelvins, ivec2(gl_FragCoord.xy), 0).r), 1.0); }\n"
    )

    def run(kelvins) -> np.ndarray:
        kelvins = np.asarray(kelvins, float)
        piece = Piece(ctx, path).table("kelvins", kelvins.reshape(1, -1, 1), nearest=True)
        return piece.draw((len(kelvins), 1))[0, :, :3].astype(float)

    return run


def chromaticity(rgb: np.ndarray) -> np.ndarray:
    xyz = rgb @ TO_XYZ.T
    return xyz[..., :2] / xyz.sum(-1, keepdims=True)


def test_published_chromaticities(colours) -> None:
    """CIE illuminant A (Planck at 2,856 K), and points of the Planckian locus as tabled by the CIE.

    5e-4: tables give four digits, and the fit is good to 2e-4.
    """
    published = {2856.0: (0.4476, 0.4074), 4000.0: (0.3805, 0.3768), 6500.0: (0.3135, 0.3237), 10000.0: (0.2807, 0.2884)}
    np.testing.assert_allclose(chromaticity(colours(list(published))), list(published.values()), atol=5e-4)


def test_against_planck_and_a_fitted_observer(colours) -> None:
    """An independent sum over Planck's law. 6e-3: the fit of the observer is good to about 1 %."""
    kelvins = np.geomspace(2000.0, 38_000.0, 24)
    expected = np.array([planck_chromaticity(t) for t in kelvins])
    np.testing.assert_allclose(chromaticity(colours(kelvins)), expected, atol=6e-3)


def test_luminance_is_one_and_nothing_is_negative(colours) -> None:
    found = colours(np.geomspace(100.0, 1e6, 500))
    np.testing.assert_allclose(found @ TO_XYZ[1], 1.0, atol=2e-4)  # the shader's numbers have six digits
    assert found.min() >= 0.0


def test_outside_the_fit_its_ends_answer(colours) -> None:
    found = colours([0.0, -5.0, 500.0, 1000.0, 40_000.0, 1e9])
    np.testing.assert_array_equal(found[:3], found[[3, 3, 3]])
    np.testing.assert_array_equal(found[4], found[5])


def test_assets_are_the_ones_on_record() -> None:
    """SOURCES.md says of every asset where it comes from, and its checksum."""
    record = (assets_dir() / "SOURCES.md").read_text(encoding="utf-8")
    for path in assets_dir().iterdir():
        if path.suffix in {".npy", ".npz"}:
            row = next(line for line in record.splitlines() if line.startswith(f"| {path.name} |"))
            assert re.findall(r"[0-9a-f]{64}", row)[-1] == hashlib.sha256(path.read_bytes()).hexdigest(), path.name
