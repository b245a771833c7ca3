"""The scattering atmosphere against Chandrasekhar's printed table (1960, table XXIV)."""

from __future__ import annotations

import numpy as np

from blackhole_gl.physics import scattering_atmosphere

# cosine, radiance for unit flux, polarized per cent
PRINTED = np.array([(0.0, 0.41441, 11.713), (0.1, 0.52397, 7.448), (0.3, 0.70029, 4.041), (0.5, 0.86637, 2.252), (0.8, 1.10931, 0.682), (1.0, 1.26938, 0.0)])


def test_limb_darkening_and_polarization_are_those_of_the_printed_table() -> None:
    """The last printed digits, and one more for c, which is printed with five."""
    rise, radiance, per_cent = PRINTED.T
    np.testing.assert_allclose(scattering_atmosphere.limb(rise), radiance, atol=2e-5)
    np.testing.assert_allclose(100.0 * scattering_atmosphere.degree(rise), per_cent, atol=1.5e-3)
