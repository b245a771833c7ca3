"""Gradient noise: its gradients are as good as random, its deviation is what layers reckon with."""

from __future__ import annotations

import numpy as np
import pytest

from tests.shaders.harness import Piece

SIDE = 64

GRADIENTS = """#version 330 core
#defines
#blocks
#include "common/noise.glsl"
uniform ivec3 first;
uniform int seed;
out vec4 o;
void main() {
    int at = int(gl_FragCoord.x) + 512 * int(gl_FragCoord.y);
    o = vec4(lattice_gradient(lattice_word(first + ivec3(at & 63, (at >> 6) & 63, at >> 12), uint(seed))), 1.0);
}
"""

NOISE = """#version 330 core
#defines
#blocks
#include "common/noise.glsl"
uniform float scale;
out vec4 o;
void main() {
    o = vec4(simplex_noise(vec3(gl_FragCoord.xy * scale, 0.37 * gl_FragCoord.y), 5u));
}
"""


def _piece(ctx, tmp_path, text: str) -> Piece:
    path = tmp_path / "noise.frag"
    path.write_text(text)
    return Piece(ctx, path)


@pytest.mark.parametrize("first, seed", [((-20, -7, -30), 1), ((-30, -30, 100), 6483), ((-50, -50, -50), 16370)])
def test_gradients_of_the_lattice_are_as_good_as_random(ctx, tmp_path, first: tuple[int, int, int], seed: int) -> None:
    """Of 64³ points no two components correlate at any distance by more than 0.02. Random numbers: 0.002 in the mean, 0.0097 for the largest of 64³ distances."""
    drawn = _piece(ctx, tmp_path, GRADIENTS).set(first=first, seed=seed).draw((512, 512))[..., :3].reshape(SIDE, SIDE, SIDE, 3)
    parts = [(drawn[..., k] - drawn[..., k].mean()) / drawn[..., k].std() for k in range(3)]
    np.testing.assert_allclose(drawn.std(axis=(0, 1, 2)), 2.0**32 / np.sqrt(12.0), rtol=0.01)
    spectra = [np.fft.fftn(part) for part in parts]
    for i in range(3):
        for j in range(i, 3):
            correlation = np.fft.ifftn(spectra[i] * np.conj(spectra[j])).real / SIDE**3
            if i == j:
                correlation[0, 0, 0] = 0.0
            assert np.abs(correlation).max() < 0.02


def test_deviation_and_range(ctx, tmp_path) -> None:
    """The layers' mean of 1 rests on the deviation (NOISE_DEVIATION of disks/turbulence.glsl). 3 %: a quarter of a million draws, one in four independent."""
    drawn = _piece(ctx, tmp_path, NOISE).set(scale=0.71).draw((512, 512))[..., 0]
    assert drawn.std() == pytest.approx(0.24, rel=0.03)
    assert abs(drawn.mean()) < 0.005
    assert np.abs(drawn).max() < 1.0
