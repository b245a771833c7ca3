"""The radius of an Einstein ring against the camera's distance: where light from straight behind the hole comes from. Far away, θ = √(2 r_s/D)."""

import numpy as np

import blackhole_gl as bh

for distance in (100.0, 300.0, 1000.0, 3000.0):
    scene = bh.load("schwarzschild", {"camera.distance": distance, "camera.inclination_deg": 90, "rays.model": "schwarzschild"})
    weak = np.sqrt(2.0 / distance)
    psi = np.linspace(0.9 * weak, 1.2 * weak, 2001)
    aside = bh.trace(scene, psi).direction[:, 1]  # the camera looks along −x; straight behind the hole, y = 0
    ring = np.interp(0.0, aside, psi)
    print(f"D = {distance:6.0f} r_s: {np.degrees(ring):.5f}°, {100 * (ring / weak - 1):+.2f} % of the weak-field law")
