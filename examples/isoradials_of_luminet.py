"""Luminet's isoradials over his picture of 1979: circles of the disk's plane, by the direct image and by the first ring. Writes isoradials_of_luminet.png."""

import matplotlib

matplotlib.use("Agg")
import matplotlib.pyplot as plt

import blackhole_gl as bh

SIZE = (640, 360)
scene = bh.load("luminet_1979")
figure = plt.figure(figsize=(SIZE[0] / 100, SIZE[1] / 100), dpi=100)
axes = figure.add_axes((0, 0, 1, 1))
axes.imshow(bh.render(scene, SIZE), extent=(0, SIZE[0], SIZE[1], 0))
for curve in bh.isoradials(scene, [3.0, 5.0, 10.0], [0, 1], samples=256):
    axes.plot(*curve.in_pixels(scene, SIZE), color="cyan" if curve.order == 0 else "orange", linewidth=0.8)
axes.set_axis_off()
figure.savefig("isoradials_of_luminet.png")
print("isoradials_of_luminet.png")
