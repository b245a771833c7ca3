"""By how much a hole bends light, against the impact parameter; beside Einstein's 2 r_s/b. The camera is at infinity."""

import numpy as np

import blackhole_gl as bh

scene = bh.load("schwarzschild", {"camera.distance": np.inf, "camera.inclination_deg": 90})
impact_m = np.array([5.5, 6.0, 8.0, 12.0, 30.0, 100.0])  # M = r_s/2
out = bh.trace(scene, alpha=impact_m, beta=0.0).direction
bent = np.degrees(-np.arctan2(out[:, 1], -out[:, 0])) % 360
for b, angle in zip(impact_m, bent):
    print(f"b = {b:5.1f} M: bent by {angle:8.4f}°, weak field {np.degrees(4 / b):8.4f}°")
