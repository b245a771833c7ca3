"""Fit the rational functions of `shaders/common/colour.glsl`: the colour of a black body against its temperature.

The colour is linear Rec. 709 (D65 white), scaled to luminance Y = 1, so that a shader multiplies it by whatever luminance the scene asks for.
Below about 1,900 K it lies outside the Rec. 709 triangle (blue is negative). The negative channel is set to zero and the rest scaled back to
Y = 1: the hue stays, a little saturation goes.

With t in 1,000 K, 1 to 40, red and blue are each (a t² + b t + c)/(t² + d t + e), blue no less than 0, and green is what luminance 1 leaves. The
ten numbers are those with the least largest error, in chromaticities x, y (×400) and in grey levels of red and blue (×1/2).

Planck's law, the CIE 1931 2° observer (1 nm, 360…830 nm) and the Rec. 709 matrix come from `colour-science` (BSD-3-Clause). Run
`python tools/fit_blackbody.py` with that package and SciPy installed: it prints the numbers and how well they fit.
"""

import colour
import numpy as np
from scipy.optimize import least_squares

KELVIN = np.geomspace(1_000.0, 40_000.0, 256)
T = KELVIN * 1e-3
SPACE = colour.RGB_COLOURSPACES["ITU-R BT.709"]
LUMINANCE = np.array([0.2126729, 0.7151522, 0.0721750])  # of the primaries, to seven digits
ROUNDS = 200


def blackbody_rgb(kelvin: np.ndarray) -> np.ndarray:
    """Linear Rec. 709 of black bodies at `kelvin` (n,), each with luminance 1; shape (n, 3), no negative value."""
    observer = colour.MSDS_CMFS["CIE 1931 2 Degree Standard Observer"]
    metres = observer.wavelengths * 1e-9
    radiance = np.stack([colour.colorimetry.planck_law(metres, t) for t in kelvin])
    xyz = radiance @ observer.values
    xyz /= xyz[:, 1:2]
    rgb = np.maximum(xyz @ SPACE.matrix_XYZ_to_RGB.T, 0.0)
    return rgb / (rgb @ SPACE.matrix_RGB_to_XYZ[1])[:, None]


def ratio(numbers: np.ndarray) -> np.ndarray:
    """(a t² + b t + c)/(t² + d t + e) at all temperatures."""
    a, b, c, d, e = numbers
    return ((a * T + b) * T + c) / ((T + d) * T + e)


def colours(numbers: np.ndarray) -> np.ndarray:
    """What the shader makes of the ten numbers, (n, 3)."""
    red, blue = ratio(numbers[:5]), np.maximum(ratio(numbers[5:]), 0.0)
    return np.stack([red, (1.0 - LUMINANCE[0] * red - LUMINANCE[2] * blue) / LUMINANCE[1], blue], -1)


def chromaticity(rgb: np.ndarray) -> np.ndarray:
    xyz = rgb @ SPACE.matrix_RGB_to_XYZ.T
    return xyz[:, :2] / xyz.sum(-1, keepdims=True)


def grey_levels(rgb: np.ndarray) -> np.ndarray:
    """Roughly what a screen shows of them, 255 being white."""
    return 255.0 * np.maximum(rgb, 0.0) ** 0.45


def errors(numbers: np.ndarray, exact: np.ndarray) -> np.ndarray:
    found = colours(numbers)
    return np.hstack([400.0 * (chromaticity(found) - chromaticity(exact)), 0.5 * (grey_levels(found) - grey_levels(exact))[:, ::2]])


def first_guess(channel: np.ndarray) -> np.ndarray:
    """Least squares of the ratio times its denominator, linear in the numbers."""
    there = channel > 0.0
    t, value = T[there], channel[there]
    terms = np.stack([t**2, t, np.ones_like(t), -value * t, -value], -1) / t[:, None] ** 2
    return np.linalg.lstsq(terms, value, rcond=None)[0]


def _weighted_errors(numbers: np.ndarray, weights: np.ndarray, exact: np.ndarray) -> np.ndarray:
    return (weights * errors(numbers, exact)).ravel()


def fitted(exact: np.ndarray) -> np.ndarray:
    """The ten numbers of least largest error: least squares, in which what errs most weighs more and more."""
    numbers = np.concatenate([first_guess(exact[:, 0]), first_guess(exact[:, 2])])
    weights, best = np.ones((len(exact), 4)), numbers
    for _ in range(ROUNDS):
        numbers = least_squares(_weighted_errors, numbers, x_scale=np.abs(numbers), args=(weights, exact)).x
        size = np.abs(errors(numbers, exact))
        if size.max() < np.abs(errors(best, exact)).max():
            best = numbers
        weights *= 0.5 + 0.5 * np.sqrt(size / size.max())
        weights /= weights.max()
    return best


def main() -> None:
    """Print the numbers and their errors."""
    exact = blackbody_rgb(KELVIN)
    numbers = np.array([float(f"{number:.6g}") for number in fitted(exact)])
    for name, (a, b, c, d, e) in zip(("red", "blue"), numbers.reshape(2, 5)):
        print(f"{name}: (({a} * t + {b}) * t + {c}) / ((t + {d}) * t + {e})")
    found = colours(numbers)
    print(
        "largest errors: chromaticity",
        np.abs(chromaticity(found) - chromaticity(exact)).max(),
        "grey levels",
        np.abs(grey_levels(found) - grey_levels(exact)).max(0),
    )


if __name__ == "__main__":
    main()
