"""Light of matter that moves in any way in Kerr or in flat space: its frequency shift, by the metric in Boyer and Lindquist's coordinates (float64).

Places and velocities are as rays tell them: x = r (sin θ cos φ, sin θ sin φ, cos θ) in r_s, v = dx/dt with c = 1, off the axis. Inside M = 1.
"""

from __future__ import annotations

import numpy as np

from ..shapes import Float


def own_time_squared(
    place: Float[np.ndarray, "*points 3"], velocity: Float[np.ndarray, "*points 3"], spin: float, mass: float = 1.0
) -> Float[np.ndarray, "*points"]:
    """(dτ/dt)² of matter at `place` with `velocity`: −g_μν dx^μ/dt dx^ν/dt; negative where nothing can move so. `mass` 0 and `spin` 0: flat space."""
    r, sine, cosine = _spherical(place)
    rate = _rates(place, velocity)
    sigma, delta = r * r + (spin * cosine) ** 2, r * r - 2.0 * mass * r + spin * spin
    g_tt, g_tphi = -(1.0 - 2.0 * mass * r / sigma), -2.0 * mass * spin * r * sine**2 / sigma
    g_phiphi = sine**2 * (r * r + spin * spin + 2.0 * mass * r * (spin * sine) ** 2 / sigma)
    return -(g_tt + 2.0 * g_tphi * rate[2] + g_phiphi * rate[2] ** 2 + sigma / delta * rate[0] ** 2 + sigma * rate[1] ** 2)


def emitted_shift(
    place: Float[np.ndarray, "*points 3"],
    velocity: Float[np.ndarray, "*points 3"],
    momentum: Float[np.ndarray, "*points 3"],
    spin: float,
    mass: float = 1.0,
) -> Float[np.ndarray, "*points"]:
    """E_infinity/E_emitter of light with the covariant `momentum` (k_r, k_θ, k_φ), E = 1, that leaves matter at `place` with `velocity`."""
    rate = _rates(place, velocity)
    seen = 1.0 - sum(momentum[..., k] * rate[k] for k in range(3))
    return np.sqrt(own_time_squared(place, velocity, spin, mass)) / seen


def _spherical(place: Float[np.ndarray, "*points 3"]) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """r in M, sin θ and cos θ."""
    r = 2.0 * np.linalg.norm(place, axis=-1)
    return r, 2.0 * np.hypot(place[..., 0], place[..., 1]) / r, 2.0 * place[..., 2] / r


def _rates(place: Float[np.ndarray, "*points 3"], velocity: Float[np.ndarray, "*points 3"]) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """dr/dt, dθ/dt and dφ/dt with M = 1."""
    r, sine, cosine = _spherical(place)
    heading = place[..., :2] / np.hypot(place[..., 0], place[..., 1])[..., None]
    outward = np.sum(velocity[..., :2] * heading, axis=-1)
    around = velocity[..., 1] * heading[..., 0] - velocity[..., 0] * heading[..., 1]
    return sine * outward + cosine * velocity[..., 2], (cosine * outward - sine * velocity[..., 2]) / r, around / (r * sine)
