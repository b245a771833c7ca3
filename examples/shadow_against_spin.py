"""How wide and how high the shadow is, in M, against the spin: from far away, in the plane of the equator."""

import numpy as np

import blackhole_gl as bh

for spin in (0.0, 0.5, 0.9, 0.998):
    scene = bh.load("kerr", {"hole.spin": spin, "camera.distance": np.inf, "camera.inclination_deg": 90})
    edge = bh.critical_curve(scene)
    aside = 0.5 * (edge.alpha.max() + edge.alpha.min())
    print(f"a* = {spin:5.3f}: {np.ptp(edge.alpha):.4f} M wide, {np.ptp(edge.beta):.4f} M high, its middle {aside:.4f} M aside")
