"""A dome master for a planetarium: half of the world as a disc, the hole 30° above the audience's horizon. Writes dome.png, 4096×4096 for a real dome."""

import numpy as np

import blackhole_gl as bh

side, tilt = 512, 60.0  # the zenith is 60° above what the camera looks at
scene = bh.load("kerr", {"camera.projection": "dome", "camera.dome_tilt_deg": tilt})
bh.save("dome.png", scene, (side, side))

row, column = np.nonzero(bh.hits(scene, (side, side)).fate == bh.Fate.CAPTURED)
right, down = column - (side - 1) / 2, row - (side - 1) / 2
zenith = 90 * np.hypot(right, down) / (side / 2)  # equidistant: degrees from the middle grow evenly up to the rim
print(f"the shadow reaches from {90 - zenith.max():.1f}° to {90 - zenith.min():.1f}° above the horizon; the camera looks {90 - tilt:.0f}° above it")
