"""A picture, what its rays met, and how they were traced. Writes first_picture.png, which the viewer opens again."""

import blackhole_gl as bh

scene = bh.load("kerr", {"hole.spin": 0.7, "camera.inclination_deg": 75})
bh.save("first_picture.png", scene, (640, 360))
hits = bh.hits(scene, (640, 360))
captured = (hits.fate == bh.Fate.CAPTURED).mean()
g = hits.g[hits.g > 0]
print(f"{bh.plan(scene).method}: {100 * captured:.2f} % of the rays fall in; g runs from {g.min():.3f} to {g.max():.3f} on the disk's plane")
