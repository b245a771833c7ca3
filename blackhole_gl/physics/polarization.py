"""Polarization of light from matter in the plane of a hole, seen by any observer: no transport, but Walker and Penrose's constant (float64).

A vector f that is carried along light k in Kerr, at right angles to it, keeps (M = 1, Boyer–Lindquist; Walker & Penrose 1970, as in Himwich et al. 2020)

    κ = (r − i a cos θ) { (k^t f^r − k^r f^t) + a sin²θ (k^r f^φ − k^φ f^r) − i sin θ [(r²+a²)(k^φ f^θ − k^θ f^φ) − a (k^t f^θ − k^θ f^t)] }

which is linear in f and blind to a multiple of k in it. So it is formed at the emitter and solved for f at the observer. Vectors are told here in the frame of
zero angular momentum (ZAMO; Bardeen, Press & Teukolsky 1972), as (t, r, θ, φ); the azimuth is never divided by sin θ, so that the axis is a place like others.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from ..shapes import Float
from . import plunging
from .observer import Observer
from .relativity import orbital_frequency

Array = np.ndarray


@dataclass(frozen=True)
class MagneticField:
    """A field in the frame of the matter, by its parts along the axis, outwards and along the orbit (counter-clockwise seen from +z). Only ratios matter."""

    vertical: float = 1.0
    radial: float = 0.0
    toroidal: float = 0.0

    @property
    def local(self) -> Float[Array, " 3"]:
        """Unit vector (3,) in (r, θ, φ).

        Raises:
            ValueError: there is no field.
        """
        vector = np.array([self.radial, -self.vertical, self.toroidal])
        size = float(np.linalg.norm(vector))
        if not size > 0.0:
            raise ValueError("the magnetic field has no direction: its vertical, radial and toroidal parts are all 0")
        return vector / size


@dataclass(frozen=True)
class PolarizedLight:
    """Light that leaves matter polarized: arrays (…).

    Attributes:
        constant: κ of its direction of polarization, a unit vector across the light, in units of the light's energy at infinity; complex.
        sine: of the angle between light and field in the frame of the matter.
        rise: cosine of the angle between the light and the plane's normal there, 0…1.
        g: E_infinity/E_emitter.
    """

    constant: Array
    sine: Float[Array, "*rays"]
    rise: Float[Array, "*rays"]
    g: Float[Array, "*rays"]


@dataclass(frozen=True)
class _Zamo:
    """The frame of zero angular momentum at places (r in M, θ) round a hole of spin `spin`."""

    spin: float
    r: Float[Array, "*at"] | float
    cosine: float
    sine: float

    @property
    def sigma(self) -> Float[Array, "*at"] | float:
        return self.r**2 + (self.spin * self.cosine) ** 2

    @property
    def delta(self) -> Float[Array, "*at"] | float:
        return self.r * (self.r - 2.0) + self.spin**2

    @property
    def big_a(self) -> Float[Array, "*at"] | float:
        return (self.r**2 + self.spin**2) ** 2 - self.delta * (self.spin * self.sine) ** 2

    @property
    def lapse(self) -> Float[Array, "*at"] | float:
        return np.sqrt(self.sigma * self.delta / self.big_a)

    @property
    def omega(self) -> Float[Array, "*at"] | float:
        """dφ/dt of the frame."""
        return 2.0 * self.spin * self.r / self.big_a

    @property
    def ring(self) -> Float[Array, "*at"] | float:
        """√g_φφ over sin θ."""
        return np.sqrt(self.big_a / self.sigma)

    def constant(self, k: Float[Array, "*rays 4"], f: Float[Array, "*rays 4"]) -> Array:
        """κ (…) of a vector `f` (…, 4) along light `k` (…, 4), both in this frame; complex."""
        (k_t, k_r, k_theta, k_phi), (f_t, f_r, f_theta, f_phi) = self._coordinate(k), self._coordinate(f)
        a, sine = self.spin, self.sine
        real = (k_t * f_r - k_r * f_t) + a * sine * (k_r * f_phi - k_phi * f_r)
        imaginary = (self.r**2 + a * a) * (k_phi * f_theta - k_theta * f_phi) - a * sine * (k_t * f_theta - k_theta * f_t)
        return (self.r - 1j * a * self.cosine) * (real - 1j * imaginary)

    def _coordinate(self, v: Float[Array, "*rays 4"]) -> tuple[Array, Array, Array, Array]:
        """v^t, v^r, v^θ and sin θ v^φ."""
        time = v[..., 0] / self.lapse
        around = v[..., 3] / self.ring + self.omega * self.sine * time
        return time, v[..., 1] * np.sqrt(self.delta / self.sigma), v[..., 2] / np.sqrt(self.sigma), around


def boosted(v: Float[Array, "*at 4"], velocity: Float[Array, "*at 3"]) -> Float[Array, "*at 4"]:
    """Components (…, 4) in a frame that moves at `velocity` (…, 3) in that of `v` (…, 4), its axes not turned; c = 1."""
    gamma = 1.0 / np.sqrt(1.0 - np.sum(velocity**2, axis=-1, keepdims=True))
    along = np.sum(velocity * v[..., 1:], axis=-1, keepdims=True)
    time = gamma * (v[..., :1] - along)
    return np.concatenate([time, v[..., 1:] + velocity * (gamma * gamma / (gamma + 1.0) * along - gamma * v[..., :1])], axis=-1)


def circular_velocity(r: Float[Array, "*at"], spin: float, orbit: str) -> Float[Array, "*at 3"]:
    """Velocity (…, 3) in (r, θ, φ) of matter on circular orbits at r (r_s) in the plane, in the frame of zero angular momentum."""
    zamo = _Zamo(spin, 2.0 * r, 0.0, 1.0)
    around = (0.5 * orbital_frequency(r, spin, orbit) - zamo.omega) * zamo.ring / zamo.lapse
    return np.stack([np.zeros_like(around), np.zeros_like(around), around], axis=-1)


def falling_velocity(r: Float[Array, "*at"], spin: float, orbit: str) -> Float[Array, "*at 3"]:
    """The same of matter that falls in from the innermost stable orbit; NaN outside of it."""
    matter, zamo = plunging.four_velocity(r, spin, orbit), _Zamo(spin, 2.0 * r, 0.0, 1.0)
    around = (matter.around / matter.time - zamo.omega) * zamo.ring / zamo.lapse
    inwards = matter.radial / matter.time * np.sqrt(zamo.sigma / zamo.delta) / zamo.lapse
    return np.stack([inwards, np.zeros_like(around), around], axis=-1)


def emitted(
    r: Float[Array, "*rays"],
    momentum: Float[Array, "*rays 3"],
    velocity: Float[Array, "*rays 3"],
    field: Float[Array, " 3"],
    spin: float,
) -> PolarizedLight:
    """Light polarized at right angles to itself and to a field, as synchrotron light is: f ∝ k × B in the frame of the matter.

    Args:
        r: where it leaves the plane, in r_s.
        momentum: covariant (k_r, k_θ, k_φ) of the light with E = 1, M = 1.
        velocity: of the matter, in (r, θ, φ) of the frame of zero angular momentum there.
        field: unit vector in (r, θ, φ) of the frame of the matter.
    """
    zamo = _Zamo(spin, 2.0 * r, 0.0, 1.0)
    local = (1.0 - zamo.omega * momentum[..., 2]) / zamo.lapse, momentum[..., 0] * np.sqrt(zamo.delta / zamo.sigma), momentum[..., 1] / np.sqrt(zamo.sigma)
    k = np.stack([*local, momentum[..., 2] / zamo.ring], axis=-1)
    seen = boosted(k, velocity)
    across = np.cross(seen[..., 1:] / seen[..., :1], field)
    sine = np.linalg.norm(across, axis=-1)
    with np.errstate(invalid="ignore", divide="ignore"):  # along the field there is no direction, and no light
        unit = across / sine[..., None]
    f = boosted(np.concatenate([np.zeros_like(unit[..., :1]), unit], axis=-1), -velocity)
    return PolarizedLight(zamo.constant(k, f), sine, np.abs(seen[..., 2]) / seen[..., 0], 1.0 / seen[..., 0])


def arriving(observer: Observer, directions: Float[Array, "*rays 3"], constant: Array) -> Float[Array, "*rays 3"]:
    """The direction of polarization of light that comes from local `directions` (…, 3) with the constant κ (…): unit vectors (…, 3) in (r, θ, φ).

    Directions are those of `observer.local_directions`, or of `parallel_rays` for a far observer, for whom Himwich et al. 2020 give the solution.
    """
    spin, sine = observer.spin, float(np.hypot(observer.n[0], observer.n[1]))
    if observer.w == 0.0:
        up, nu = -directions[..., 1], -(directions[..., 2] + spin * sine)
        aside, upwards = up * constant.imag - nu * constant.real, up * constant.real + nu * constant.imag
        vector = np.stack([np.zeros_like(up), -upwards, aside], axis=-1)
        return vector / np.linalg.norm(vector, axis=-1, keepdims=True)
    ahead = directions / np.linalg.norm(directions, axis=-1, keepdims=True)
    right, above = across(ahead, np.array([0.0, -1.0, 0.0]))
    zamo = _Zamo(spin, 1.0 / observer.w, float(observer.n[2]), sine)
    to_zamo = observer.zamo * np.array([1.0, -1.0, -1.0, -1.0]) * np.array([[1.0], [-1.0], [-1.0], [-1.0]])  # of what moves along a vector, as light along −n

    def of(vector: Float[Array, "*rays 3"], time: float) -> Float[Array, "*rays 4"]:
        return np.concatenate([np.full_like(vector[..., :1], time), vector], axis=-1) @ to_zamo.T

    k = of(-ahead, 1.0)
    first, second = zamo.constant(k, of(right, 0.0)), zamo.constant(k, of(above, 0.0))
    # Two real equations, c₁ first + c₂ second = κ, by Cramer's rule.
    c = np.stack([(constant * second.conj()).imag, (first * constant.conj()).imag], axis=-1) / (first * second.conj()).imag[..., None]
    c = c / np.linalg.norm(c, axis=-1, keepdims=True)
    return c[..., :1] * right + c[..., 1:] * above


def across(ahead: Float[Array, "*rays 3"], upwards: Float[Array, " 3"]) -> tuple[Float[Array, "*rays 3"], Float[Array, "*rays 3"]]:
    """Right and up on a sky, unit vectors (…, 3) across the unit vectors `ahead` (…, 3), up being nearest to `upwards`, which none of them is along."""
    above = upwards - np.sum(ahead * upwards, axis=-1, keepdims=True) * ahead
    above = above / np.linalg.norm(above, axis=-1, keepdims=True)
    return np.cross(ahead, above), above


def position_angle(observer: Observer, directions: Float[Array, "*rays 3"], vectors: Float[Array, "*rays 3"]) -> Float[Array, "*rays"]:
    """Angle (…) of polarization `vectors` (…, 3) as `arriving` gives them: from up on the picture counter-clockwise, −π/2 … π/2, as astronomers count it."""
    right, above = _on_the_picture(observer, directions)
    aside, up = np.sum(vectors * right, axis=-1), np.sum(vectors * above, axis=-1)
    return np.arctan(np.divide(-aside, up, out=np.full_like(up, np.inf), where=up != 0.0))


def direction_of(observer: Observer, directions: Float[Array, "*rays 3"], angle: Float[Array, "*rays"]) -> Float[Array, "*rays 3"]:
    """The unit vectors (…, 3) across `directions` that have position `angle` (…): the inverse of `position_angle`."""
    right, above = _on_the_picture(observer, directions)
    return np.cos(angle)[..., None] * above - np.sin(angle)[..., None] * right


def _on_the_picture(observer: Observer, directions: Float[Array, "*rays 3"]) -> tuple[Float[Array, "*rays 3"], Float[Array, "*rays 3"]]:
    """Right and up on the picture, across the light from `directions`."""
    ahead = directions / np.linalg.norm(directions, axis=-1, keepdims=True)
    if observer.w == 0.0:
        ahead = np.broadcast_to(np.array([-1.0, 0.0, 0.0]), directions.shape)
    return across(ahead, -observer.look[:, 1])
