"""The light of a hot spot over one turn of it, as it is at one moment and as it arrives: light from behind the hole has a longer way."""

import numpy as np

import blackhole_gl as bh

values = {"disk.hot_spot": True, "disk.hot_spot.brightness": 20.0, "hole.spin": 0.5}
seen = {delayed: bh.lightcurve(bh.load(["kerr", "smooth"], values | {"rays.light_travel": delayed}), size=(96, 54)) for delayed in (False, True)}
for n in range(0, 96, 8):
    at_once, as_it_arrives = seen[False].relative[n], seen[True].relative[n]
    print(f"{seen[False].time[n]:6.2f} r_s/c: at once {at_once:.3f}, as it arrives {as_it_arrives:.3f} {'#' * round(20 * as_it_arrives)}")
peaks = [curve.time[np.argmax(curve.flux)] for curve in seen.values()]
print(f"brightest at {peaks[0]:.1f} r_s/c without delays and at {peaks[1]:.1f} with them")
