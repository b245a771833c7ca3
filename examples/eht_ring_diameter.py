"""The critical curve of M87* beside the ring that the Event Horizon Telescope measured in 2019, 42 ± 3 µas across."""

import numpy as np

import blackhole_gl as bh

for spin in (0.0, 0.5, 0.94):
    scene = bh.load("m87_eht", {"hole.spin": spin})
    right, up = bh.critical_curve(scene).in_uas(scene)
    across = np.hypot(right - right.mean(), up - up.mean()).mean() * 2
    print(f"a* = {spin:4.2f}: the critical curve is {across:.1f} µas across, {100 * across / 42:.0f} % of the ring")
