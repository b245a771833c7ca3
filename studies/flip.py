"""ꟻLIP: how different two pictures look when they alternate on a screen.

LDR-ꟻLIP after Andersson, Nilsson, Akenine-Möller, Oskarsson, Åström and Fairchild, "ꟻLIP: A Difference Evaluator for Alternating Images",
Proc. ACM Comput. Graph. Interact. Tech. 3(2), 2020; the section numbers below are that paper's. The authors' own package has no build for the newest
Pythons and takes three times as long; tests hold this one to its figures.
"""

from __future__ import annotations

import math

import numpy as np

PIXELS_PER_DEGREE = 67.0
"""The paper's viewing condition: a 0.7 m wide screen of 3840 pixels, seen from 0.7 m."""

_TO_XYZ = np.array([[0.4123908, 0.3575843, 0.1804808], [0.2126390, 0.7151687, 0.0721923], [0.0193308, 0.1191948, 0.9505322]], np.float32)  # sRGB, D65
_FROM_XYZ = np.linalg.inv(_TO_XYZ)
_WHITE = _TO_XYZ.sum(axis=1)

# §4.1.1, Table 1: contrast sensitivity as sums of Gaussians (a, b), for luminance, red–green and blue–yellow.
_SENSITIVITY = (((1.0, 0.0047),), ((1.0, 0.0053),), ((34.1, 0.04), (13.5, 0.025)))
_EDGE_WIDTH = 0.082  # degrees, §4.2
_COLOUR_EXPONENT, _FEATURE_EXPONENT = 0.7, 0.5  # q_c, q_f
_KNEE, _AT_KNEE = 0.4, 0.95  # p_c, p_t, §4.1.3


def flip(reference: np.ndarray, test: np.ndarray, pixels_per_degree: float = PIXELS_PER_DEGREE) -> np.ndarray:
    """The error map of two pictures, float32 (height, width), 0 (the same) to 1.

    Args:
        reference, test: (height, width, 3) uint8 sRGB.
        pixels_per_degree: of the observer's visual field.

    Raises:
        ValueError: the pictures differ in shape, or are none.
    """
    if reference.shape != test.shape or reference.ndim != 3 or reference.shape[2] != 3 or {reference.dtype, test.dtype} != {np.dtype(np.uint8)}:
        raise ValueError(
            f"two pictures of one shape (height, width, 3), uint8, are compared; got {reference.shape} {reference.dtype} and {test.shape} {test.dtype}"
        )
    opponent = [_opponent(_linear(picture)) for picture in (reference, test)]
    colour = _redistributed(_distance(*(_perceived(planes, pixels_per_degree) for planes in opponent)))
    reference_features, test_features = (_features((planes[0] + 16.0) / 116.0, pixels_per_degree) for planes in opponent)
    feature = np.maximum(*(np.abs(a - b) for a, b in zip(reference_features, test_features)))
    feature = np.minimum(feature / math.sqrt(2.0), 1.0) ** _FEATURE_EXPONENT
    return colour ** (1.0 - feature)


def _linear(picture: np.ndarray) -> np.ndarray:
    """Linear RGB in 0…1 as float32 (3, height, width)."""
    code = np.arange(256) / 255.0
    table = np.where(code <= 0.04045, code / 12.92, ((code + 0.055) / 1.055) ** 2.4).astype(np.float32)
    return np.moveaxis(table[picture], -1, 0)


def _mixed(matrix: np.ndarray, planes: np.ndarray) -> np.ndarray:
    return np.tensordot(matrix.astype(np.float32), planes, axes=1)


def _opponent(rgb: np.ndarray) -> np.ndarray:
    """YC_xC_z, the linear form of L*a*b*, in which light may be blurred."""
    x, y, z = _mixed(_TO_XYZ, rgb) / _WHITE[:, None, None]
    return np.stack([116.0 * y - 16.0, 500.0 * (x - y), 200.0 * (y - z)])


def _from_opponent(planes: np.ndarray) -> np.ndarray:
    y = (planes[0] + 16.0) / 116.0
    return _mixed(_FROM_XYZ, np.stack([y + planes[1] / 500.0, y, y - planes[2] / 200.0]) * _WHITE[:, None, None])


def _lab(rgb: np.ndarray) -> np.ndarray:
    """L*a*b* with chroma shrunk in the dark after Hunt."""
    t = _mixed(_TO_XYZ, rgb) / _WHITE[:, None, None]
    delta = 6.0 / 29.0
    x, y, z = np.where(t > delta**3, np.cbrt(t), t / (3.0 * delta * delta) + 4.0 / 29.0)
    light = 116.0 * y - 16.0
    return np.stack([light, 0.01 * light * 500.0 * (x - y), 0.01 * light * 200.0 * (y - z)])


def _perceived(planes: np.ndarray, pixels_per_degree: float) -> np.ndarray:
    """What the eye makes of a picture's colours: each opponent plane without what is too fine to be seen."""
    widest = max(b for gaussians in _SENSITIVITY for _, b in gaussians)
    radius = math.ceil(3.0 * math.sqrt(widest / (2.0 * math.pi**2)) * pixels_per_degree)
    x = np.arange(-radius, radius + 1) / pixels_per_degree
    blurred = []
    for plane, gaussians in zip(planes, _SENSITIVITY):
        kernels = [np.exp(-math.pi**2 * x * x / b) for _, b in gaussians]
        weights = np.array([a * math.sqrt(math.pi / b) * kernel.sum() ** 2 for (a, b), kernel in zip(gaussians, kernels)])
        parts = [_separable(plane, kernel / kernel.sum(), kernel / kernel.sum()) for kernel in kernels]
        blurred.append(sum(weight * part for weight, part in zip(weights / weights.sum(), parts)))
    return _lab(np.clip(_from_opponent(np.stack(blurred).astype(np.float32)), 0.0, 1.0))


def _distance(a: np.ndarray, b: np.ndarray) -> np.ndarray:
    """HyAB, §4.1.2."""
    return np.abs(a[0] - b[0]) + np.hypot(a[1] - b[1], a[2] - b[2])


def _redistributed(distance: np.ndarray) -> np.ndarray:
    """Colour distance to 0…1: small ones get most of the range, §4.1.3."""
    green, blue = (_lab(np.array(rgb, np.float32).reshape(3, 1, 1)) for rgb in ((0, 1, 0), (0, 0, 1)))
    largest = float(_distance(green, blue)[0, 0]) ** _COLOUR_EXPONENT
    raised, knee = distance**_COLOUR_EXPONENT, _KNEE * largest
    return np.where(raised < knee, _AT_KNEE / knee * raised, _AT_KNEE + (raised - knee) / (largest - knee) * (1.0 - _AT_KNEE))


def _features(luminance: np.ndarray, pixels_per_degree: float) -> tuple[np.ndarray, np.ndarray]:
    """Strength of edges and of points, §4.2."""
    sigma = 0.5 * _EDGE_WIDTH * pixels_per_degree
    radius = math.ceil(3.0 * sigma)
    x = np.arange(-radius, radius + 1, dtype=float)
    smooth = np.exp(-x * x / (2.0 * sigma * sigma))
    found = []
    for detector in (-x * smooth, (x * x / sigma**2 - 1.0) * smooth):
        detector = np.where(detector > 0.0, detector / detector[detector > 0.0].sum(), -detector / detector[detector < 0.0].sum())
        found.append(np.hypot(_separable(luminance, detector, smooth / smooth.sum()), _separable(luminance, smooth / smooth.sum(), detector)))
    return found[0], found[1]


def _separable(plane: np.ndarray, along_x: np.ndarray, along_y: np.ndarray) -> np.ndarray:
    """`plane` filtered with odd kernels; beyond its edge it goes on as it ends."""
    return _filtered(_filtered(plane, along_x).T, along_y).T


def _filtered(plane: np.ndarray, kernel: np.ndarray) -> np.ndarray:
    radius, width = len(kernel) // 2, plane.shape[1]
    padded = np.pad(plane, ((0, 0), (radius, radius)), mode="edge")
    total = np.zeros_like(plane)
    for shift, weight in enumerate(kernel.astype(np.float32)):
        total += weight * padded[:, shift : shift + width]
    return total
