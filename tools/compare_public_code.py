"""Compares our rays with those of kerrz, a public code for Kerr light rays by elliptic functions that shares nothing with ours.

kerrz (F. Baker, GPL-3.0-or-later) is no part of this project and is not installed by it. Put it into a folder of its own:

    pip install --target FOLDER 'kerrz[py]'
    PYTHONPATH=FOLDER .venv/bin/python tools/compare_public_code.py

Writes docs/data/accuracy_outside.csv, which `blackhole-gl chart` puts into docs/accuracy.md.
"""

from __future__ import annotations

import csv
import math
import sys
from importlib.metadata import version
from pathlib import Path

import numpy as np

from blackhole_gl import listed_rays
from blackhole_gl.listed_rays import TracedRays
from blackhole_gl.measure.scenes import critical_radius
from blackhole_gl.rendering.context import create_headless
from blackhole_gl.rendering.frame import Renderer
from blackhole_gl.scene import presets

OUT = Path(__file__).resolve().parents[1] / "docs" / "data" / "accuracy_outside.csv"
# a*, inclination in degrees; kerrz takes any smaller spin for 0.001
HOLES = ((0.001, 80.0), (0.3, 30.0), (0.6, 60.0), (0.9, 17.0), (0.95, 75.0), (0.998, 85.0))
RAYS = 400
AWAY = 1e-2  # from the critical curve: nearer, what is compared is the rounding of the start
FAR = 1e9  # M: where kerrz's rays start and end; what is left of the way bends by less than 1e-8

Array = np.ndarray


def screen_rays(scene, count: int) -> Array:
    """(count, 2) α, β in M, uniform over a disc of 25 M, off the critical curve."""
    rng = np.random.default_rng(7)
    radius, chi = 25.0 * np.sqrt(rng.uniform(0.0, 1.0, 2 * count)), rng.uniform(-np.pi, np.pi, 2 * count)
    kept = np.abs(radius / critical_radius(scene, chi) - 1.0) > AWAY
    return np.stack([radius * np.cos(chi), radius * np.sin(chi)], axis=-1)[kept][:count]


def by_kerrz(spin: float, inclination_deg: float, rays: Array) -> dict[str, Array]:
    """First crossing (r in M, φ, g) and escape direction of each ray; NaN where there is none."""
    import kerrz_python as kerrz

    metric = kerrz.KerrMetric(M=1.0, a=spin)
    eye = kerrz.FourVector(r=FAR, theta=math.radians(inclination_deg))
    at_rest = kerrz.FourVector(t=1.0, r=0.0, theta=0.0, phi=0.0)
    found = {"r": np.full(len(rays), np.nan), "phi": np.full(len(rays), np.nan), "g": np.full(len(rays), np.nan), "direction": np.full((len(rays), 3), np.nan)}
    for i, (alpha, beta) in enumerate(rays):
        ray = kerrz.NullGeodesic.from_impact_parameters(metric, alpha, beta, eye)
        plane = ray.trace_to_angle(0.5 * math.pi)
        if plane.status == kerrz.Status.NONE and math.isfinite(plane.r):
            found["r"][i], found["phi"][i] = plane.r, plane.phi
            there = plane.to_four_vec()
            found["g"][i] = ray.energyshift(at_rest, there, kerrz.circular_orbit_velocity(metric, plane.r))
        found["direction"][i] = escape_direction(ray, math.hypot(alpha, beta))
    return found


def escape_direction(ray, impact: float) -> tuple[float, float, float]:
    """Where the ray goes: its place at the Mino time at which 1/r passes 0, by bisection; NaN when there is none within two turns."""
    low = 0.0
    for step in range(1, 200):
        high = step * 0.02 * 2.0 * math.pi / impact
        r = ray.at_mino_time(high).r
        if not math.isfinite(r) or 0.0 < r < 1.0:
            return (math.nan,) * 3
        if step > 1 and r < 0.0:
            break
        low = high
    else:
        return (math.nan,) * 3
    for _ in range(60):
        middle = 0.5 * (low + high)
        low, high = (middle, high) if ray.at_mino_time(middle).r > 0.0 else (low, middle)
    end = ray.at_mino_time(low)
    sine = math.sin(end.theta)
    return sine * math.cos(end.phi), sine * math.sin(end.phi), math.cos(end.theta)


def differences(ours: TracedRays, theirs: dict[str, Array]) -> dict[str, Array]:
    """Relative differences of r and g at the first crossing, and those of angles in radians; only where both have the quantity."""
    inner = 2.0 * ours.crossing_r[:, 0] < 40.0
    azimuths = [np.arctan2(direction[:, 1], direction[:, 0]) for direction in (ours.direction, theirs["direction"])]
    found = {
        "r": np.abs(2.0 * ours.crossing_r[:, 0] / theirs["r"] - 1.0)[inner],
        "phi": apart(ours.crossing_phi[:, 0], theirs["phi"])[inner],
        "g": np.abs(ours.crossing_g[:, 0] / theirs["g"] - 1.0)[inner],
        "escape theta": np.abs(np.arccos(ours.direction[:, 2]) - np.arccos(theirs["direction"][:, 2])),
        "escape phi": apart(*azimuths),
    }
    return {name: values[np.isfinite(values)] for name, values in found.items()}


def apart(a: Array, b: Array) -> Array:
    """Angle between two azimuths, whatever their branches."""
    return np.abs(np.exp(1j * a) - np.exp(1j * b))


def record(spin: float, inclination_deg: float, kind: str, found: dict[str, Array], code: str) -> list[str]:
    """One line of the table."""
    *spread, azimuth = found.values()
    cells = [f"{values.size}: {np.quantile(values, 0.99):.1e}, {values.max():.1e}" for values in spread]
    return [code, f"{spin:g}", f"{inclination_deg:g}", kind, *cells, f"{np.median(azimuth):.1e}; {np.mean(azimuth < 1e-5):.0%}"]


def main() -> int:
    """Compares, prints, and writes the table."""
    try:
        code = f"kerrz {version('kerrz')}"
        import kerrz_python  # noqa: F401  (here only to fail early)
    except ImportError:
        print(__doc__, file=sys.stderr)
        return 1
    renderer = Renderer(create_headless())
    records = []
    for spin, inclination in HOLES:
        changes = {"hole.spin": spin, "camera.distance": math.inf, "camera.inclination_deg": inclination}
        scene = presets.load(["kerr", "reference"], changes)
        rays = screen_rays(scene, RAYS)
        theirs = by_kerrz(spin, inclination, rays)
        for kind, ours in (("float64 twin", listed_rays.trace_by_reference(scene, rays)), ("shader", listed_rays.trace_by_shader(renderer, scene, rays))):
            records.append(record(spin, inclination, kind, differences(ours, theirs), code))
            print(*records[-1], sep="  ", flush=True)
    header = [
        "code",
        "a*",
        "inclination",
        "ours",
        "crossing r: rays, 99 %, worst",
        "crossing φ [rad]",
        "g",
        "escape θ [rad]",
        "escape φ: median [rad], share within 1e-5",
    ]
    OUT.parent.mkdir(parents=True, exist_ok=True)
    with open(OUT, "w", newline="", encoding="utf-8") as file:
        writer = csv.writer(file, lineterminator="\n")
        writer.writerow(header)
        writer.writerows(records)
    return 0


if __name__ == "__main__":
    sys.exit(main())
