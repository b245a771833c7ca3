"""Make `assets/blackbody.npy`: the colour of a black body against its temperature.

Each row is linear Rec. 709 (D65 white), scaled to luminance Y = 1, so that a shader multiplies it by whatever
luminance the scene asks for. Temperatures run from 1,000 K to 40,000 K, evenly spaced in log T; row k of n is at
`1000 · 40^(k/(n−1))` K.

Below about 1,900 K the colour lies outside the Rec. 709 triangle (blue is negative). The negative channel is set to
zero and the rest scaled back to Y = 1: the hue stays, a little saturation goes.

Planck's law, the CIE 1931 2° observer (1 nm, 360…830 nm) and the Rec. 709 matrix come from `colour-science`
(BSD-3-Clause); run `python tools/make_blackbody.py` with that package installed. The output is the same on every run.
"""

from pathlib import Path

import numpy as np

ROWS = 256
LOWEST_K = 1_000.0
HIGHEST_K = 40_000.0
TARGET = Path(__file__).resolve().parent.parent / "assets" / "blackbody.npy"


def temperatures() -> np.ndarray:
    """The table's temperatures in kelvin, shape (ROWS,), log-spaced."""
    return np.geomspace(LOWEST_K, HIGHEST_K, ROWS)


def blackbody_rgb(kelvin: np.ndarray) -> np.ndarray:
    """Linear Rec. 709 of black bodies at `kelvin` (n,), each with luminance 1; shape (n, 3), no negative value."""
    import colour

    observer = colour.MSDS_CMFS["CIE 1931 2 Degree Standard Observer"]
    metres = observer.wavelengths * 1e-9
    radiance = np.stack([colour.colorimetry.planck_law(metres, t) for t in kelvin])
    xyz = radiance @ observer.values
    xyz /= xyz[:, 1:2]
    space = colour.RGB_COLOURSPACES["ITU-R BT.709"]
    rgb = np.maximum(xyz @ space.matrix_XYZ_to_RGB.T, 0.0)
    return rgb / (rgb @ space.matrix_RGB_to_XYZ[1])[:, None]


def main() -> None:
    """Write the table."""
    np.save(TARGET, blackbody_rgb(temperatures()).astype(np.float32))


if __name__ == "__main__":
    main()
