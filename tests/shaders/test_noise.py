"""Gradient noise: its gradients are as good as random, its deviation is what layers reckon with."""

from __future__ import annotations

import numpy as np
import pytest

from tests.shaders.harness import Piece

SIDE = 512

GRADIENTS = """#version 330 core
#defines
#blocks
#include "common/noise.glsl"
uniform ivec2 first;
uniform int seed;
out vec4 o;
void main() {
    ivec2 place = first + ivec2(gl_FragCoord.xy);
    o = vec4(lattice_gradient(lattice_word(ivec3(place, 0), uint(seed))), 0.0, 1.0);
}
"""

NOISE = """#version 330 core
#defines
#blocks
#include "common/noise.glsl"
uniform float edges;
uniform vec2 from, step;
out vec4 o;
void main() {
    vec2 place = from + step * (gl_FragCoord.xy - 0.5);
    o = vec4(ring_noise(place.x, edges, place.y, 5u));
}
"""


def _piece(ctx, tmp_path, text: str) -> Piece:
    path = tmp_path / "noise.frag"
    path.write_text(text)
    return Piece(ctx, path)


@pytest.mark.parametrize("first, seed", [((-20, -7), 1), ((-300, 100), 6483), ((-50, -500), 16370)])
def test_gradients_of_the_lattice_are_as_good_as_random(ctx, tmp_path, first: tuple[int, int], seed: int) -> None:
    """Of 512² points the two components correlate at no distance by more than 0.02.

    Random numbers: 0.002 in the mean, 0.0097 for the largest of 512² distances.
    """
    drawn = _piece(ctx, tmp_path, GRADIENTS).set(first=first, seed=seed).draw((SIDE, SIDE))[..., :2]
    parts = [(drawn[..., k] - drawn[..., k].mean()) / drawn[..., k].std() for k in range(2)]
    np.testing.assert_allclose(drawn.std(axis=(0, 1)), 2.0**32 / np.sqrt(12.0), rtol=0.01)
    spectra = [np.fft.fft2(part) for part in parts]
    for i, j in ((0, 0), (1, 1), (0, 1)):
        correlation = np.fft.ifft2(spectra[i] * np.conj(spectra[j])).real / SIDE**2
        if i == j:
            correlation[0, 0] = 0.0
        assert np.abs(correlation).max() < 0.02


def test_deviation_and_range(ctx, tmp_path) -> None:
    """The layers' mean of 1 rests on the deviation (NOISE_DEVIATION of disks/turbulence.glsl). 3 %: a quarter of a million draws, one in four independent."""
    drawn = _piece(ctx, tmp_path, NOISE).set(edges=1009.0, **{"from": (0.0, -200.0), "step": (0.71 / 1009.0, 0.71)}).draw((SIDE, SIDE))[..., 0]
    assert drawn.std() == pytest.approx(0.24, rel=0.03)
    assert abs(drawn.mean()) < 0.005
    assert np.abs(drawn).max() < 1.0


@pytest.mark.parametrize("edges", [1.0, 2.0, 5.0, 61.0])
def test_it_repeats_with_each_turn_and_has_no_steps(ctx, tmp_path, edges: float) -> None:
    """Also where the turn is negative. A step of 1/500 edge changes it by no more than its steepest slope: 0.02 is four times that."""
    piece, step = _piece(ctx, tmp_path, NOISE), 1.0 / (SIDE - 1)
    turned = [piece.set(edges=edges, **{"from": (first, -3.3), "step": (step, 0.07)}).draw((SIDE, SIDE))[..., 0] for first in (-2.0, 0.0, 1.0)]
    np.testing.assert_allclose(turned[1], turned[0], atol=1e-4)  # float32 of the turn
    np.testing.assert_allclose(turned[2], turned[0], atol=1e-4)
    np.testing.assert_allclose(turned[0][:, -1], turned[0][:, 0], atol=1e-4)
    fine = piece.set(edges=edges, **{"from": (-0.5, -3.3), "step": (1.0 / (500.0 * edges), 0.002)}).draw((SIDE, SIDE))[..., 0]
    assert max(np.abs(np.diff(fine, axis=axis)).max() for axis in (0, 1)) < 0.02
