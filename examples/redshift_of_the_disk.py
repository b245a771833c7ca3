"""How the disk's light is shifted, order by order: the spread of g over the pixels that show it."""

import numpy as np

import blackhole_gl as bh

scene = bh.load("kerr_0998_85")
hits = bh.hits(scene, (480, 270))
outer = scene.disk.outer_radius
for order, name in enumerate(("direct image", "first ring", "second ring")):
    on_disk = (hits.g[..., order] > 0) & (hits.crossing[..., order, 0] < outer)
    g = hits.g[..., order][on_disk]
    print(f"{name:12} {on_disk.sum():6} pixels, g from {g.min():.3f} to {g.max():.3f}, median {np.median(g):.3f}" if g.size else f"{name:12} no pixel")
