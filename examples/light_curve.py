"""The light of a hot spot on its orbit: the sum of the picture, over one turn of it. Light is taken as instantaneous."""

import numpy as np

import blackhole_gl as bh

scene = bh.load(["kerr", "smooth"], {"disk.hot_spot": True, "disk.hot_spot.brightness": 20.0, "hole.spin": 0.5})
turn = 2 * np.pi * (np.sqrt(2) * scene.get("disk.hot_spot.radius") ** 1.5 + 0.5 * 0.5)  # of a circular geodesic, in r_s/c
light = np.array([bh.radiance(scene, (96, 54), time).sum() for time in np.linspace(0.0, turn, 12, endpoint=False)])
for share, value in zip(np.linspace(0, 1, 12, endpoint=False), light / light.mean()):
    print(f"{share:4.2f} of the orbit: {value:.3f} {'#' * round(20 * value)}")
