"""Tries Kerr rays in closed form, in float32: how far off they are, and how many operations they take.

    python tools/try_closed_kerr.py [--nodes 4]

Nothing of the viewer uses this: it makes the figures of "Closed-form Kerr: tried and left out" in docs/performance.md. Polar motion:
Jacobi's cn as quotients of theta functions of small nome. Radial motion: Weierstrass' ℘ from the invariants of the quartic R(w),
no roots but one of its resolvent; the Mino time to infinity by Carlson's R_F after one halving that knows the sign of ℘'.
Dragging: Gauss–Legendre in Mino time over each piece between crossings. Rays to every scene of the chart whose hole is exact Kerr.
"""

from __future__ import annotations

import argparse
from dataclasses import dataclass, replace

import numpy as np

from blackhole_gl.listed_rays import TracedRays, local_vectors, unknown
from blackhole_gl.measure import errors, scenes
from blackhole_gl.physics import observer
from blackhole_gl.physics.relativity import horizon_radius

F = np.float32
_SLOW = {"divide", "sqrt", "arctan2", "arccos", "cos", "sin", "cbrt"}
_FREE = {"isnan", "isfinite", "logical_and", "logical_or", "absolute", "negative", "sign"}


class Counted(np.ndarray):
    """Floats of all rays that count what is done to them: `quick` (sums, products, comparisons, choices) and `slow`, per ray."""

    quick = 0
    slow = 0

    def __array_ufunc__(self, ufunc, method, *inputs, **kwargs):
        plain = [np.asarray(x) if isinstance(x, Counted) else x for x in inputs]
        if ufunc.__name__ not in _FREE:
            slow = ufunc.__name__ in _SLOW
            Counted.slow += slow
            Counted.quick += not slow
        return np.asarray(getattr(ufunc, method)(*plain, **kwargs)).view(Counted)


def counted(values) -> Counted:
    return np.asarray(values, F).view(Counted)


@dataclass
class Rays:
    """What rays start with, as the shader's RayStart, (N,) each; M = 1, the float64 frame rounded once."""

    a: float
    w: Counted
    w_rate: Counted
    n: list[Counted]
    n_rate: list[Counted]
    lam: Counted


def start(scene, local: np.ndarray) -> Rays:
    seen = observer.observe(scene)
    rows = np.hstack([np.ones((len(local), 1)), local]) @ seen.observer_map.T
    rates = rows[:, 1:] / rows[:, :1]
    n_rate = rates[:, 1:2] * seen.e_theta + rates[:, 2:] * seen.e_phi
    lam = -rates[:, 2] * np.hypot(seen.n[0], seen.n[1])
    full = np.ones(len(local))
    return Rays(seen.spin, counted(seen.w * full), counted(rates[:, 0]), [counted(x * full) for x in seen.n], [counted(n_rate[:, i]) for i in range(3)], counted(lam))


def pick(condition, yes, no) -> Counted:
    Counted.quick += 1
    return np.where(np.asarray(condition), np.asarray(yes), np.asarray(no)).astype(F).view(Counted)


class Radial:
    """w(τ) and the time to infinity, in units in which the angular momentum is one: x = w √k, s = τ √k."""

    def __init__(self, ray: Rays, k: Counted, eta: Counted):
        a = ray.a
        self.root = np.sqrt(np.maximum(k, F(0)) + F(1))
        i = F(1) / self.root
        self.c2, self.c3 = (F(a * a) - k) * i * i, F(3) * (k - F(a) * (F(2) * ray.lam - F(a))) * i * i * i
        self.c4 = F(-2 * a * a) * eta * i * i * i * i
        self.x, self.v = ray.w * self.root, ray.w_rate
        c2, c3, c4 = self.c2, self.c3, self.c4
        self.g2 = c2 * c2 * F(1 / 12) + F(0.5) * c4
        self.g3 = F(1 / 12) * c4 * c2 - F(1 / 216) * c2 * c2 * c2 - F(1 / 36) * c3 * c3
        self.series = [self.g2 * F(1 / 20), self.g3 * F(1 / 28)]
        for n in range(4, 14):
            pairs = sum(F(2) * self.series[j - 2] * self.series[n - j - 2] for j in range(2, (n + 1) // 2))
            middle = self.series[n // 2 - 2] * self.series[n // 2 - 2] if n % 2 == 0 else F(0)
            self.series.append((pairs + middle) * F(3 / ((2 * n + 1) * (n - 3))))
        x = self.x
        self.force = x * (c2 + x * (c3 + x * c4))
        self.d2, self.d3 = F(1 / 12) * (c2 + x * (F(2) * c3 + F(3) * c4 * x)), F(1 / 6) * (c3 + F(3) * c4 * x)

    def quartic(self, x):
        return F(1) + x * x * (self.c2 + x * (F(2 / 3) * self.c3 + x * F(0.5) * self.c4))

    def weierstrass(self, s):
        """℘ and ℘' at s: the series at half of it, and one duplication."""
        z = F(0.5) * s
        z2 = z * z
        inverse = F(1) / z
        p = d = counted(np.zeros_like(z))
        for order, c in reversed(list(enumerate(self.series))):
            p, d = c + z2 * p, F(2 * order + 2) * c + z2 * d
        p, d = inverse * inverse + z2 * p, F(-2) * inverse * inverse * inverse + z * d
        slope = (F(6) * p * p - F(0.5) * self.g2) / d
        doubled = F(0.25) * slope * slope - F(2) * p
        return doubled, slope * (p - doubled) - d

    def w_at(self, tau):
        """M/r after the Mino time τ, by Weierstrass' and Biermann's formula from the start."""
        p, d = self.weierstrass(tau * self.root)
        lift = p - self.d2
        step = (self.force * lift - self.v * d + self.v * self.v * self.d3) / (F(2) * lift * lift - F(0.25) * self.v * self.v * self.c4)
        return (self.x + step) / self.root

    def resolvent_root(self):
        """The largest real e of 4e³ = g₂e + g₃."""
        spread = self.g3 * self.g3 * F(1 / 64) - self.g2 * self.g2 * self.g2 * F(1 / 1728)
        radius = np.sqrt(np.maximum(self.g2, F(1e-20)) * F(1 / 12))
        angle = np.arccos(np.minimum(np.maximum(self.g3 / (F(8) * radius * radius * radius), F(-1)), F(1)))
        three = F(2) * radius * np.cos(angle * F(1 / 3))
        part = np.sqrt(np.maximum(spread, F(0)))
        one = np.cbrt(self.g3 * F(0.125) + pick(self.g3 < 0, -part, part))
        return pick(spread <= 0, three, one + self.g2 * F(1 / 12) / one)

    def halved_time(self, p, d):
        """The Mino time 0 … 2ω at which ℘ = p and ℘' = d."""
        e = self.resolvent_root()
        pair = np.sqrt(np.maximum(p * p + e * p + e * e - F(0.25) * self.g2, F(1e-20)))
        first = F(-0.5) * d / pair  # √(p − e), negative beyond ω: from ℘', for p − e has lost its digits there
        p = p + pair + first * np.sqrt(np.maximum(F(2) * p + e + F(2) * pair, F(0)))
        for _ in range(3):
            pair = np.sqrt(np.maximum(p * p + e * p + e * e - F(0.25) * self.g2, F(0)))
            p = p + pair + np.sqrt(np.maximum((p - e) * (F(2) * p + e + F(2) * pair), F(0)))
        i = F(1) / p
        e2, e3 = F(-0.25) * self.g2 * i * i, F(0.25) * self.g3 * i * i * i
        return F(16) * np.sqrt(i) * (F(1) - F(0.1) * e2 + F(1 / 14) * e3 + F(1 / 24) * e2 * e2) / self.root

    def time_to_infinity(self):
        x, v = self.x, self.v
        h = self.c2 + x * (F(2 / 3) * self.c3 + F(0.5) * x * self.c4)
        u = F(0.5) / (F(1) + np.maximum(v, F(0)))
        inward = -h * u + F(1 / 12) * self.c2, v * (F(2 / 3) * self.c3 + x * self.c4) * u - F(2) * h * self.force * u * u
        i = F(1) / np.maximum(x, F(1e-6))
        outward = (F(1) - v) * F(0.5) * i * i + F(1 / 12) * self.c2, v * (F(1) - v) * i * i * i + F(0.5) * self.force * i * i
        return self.halved_time(*(pick(v > 0, a, b) for a, b in zip(inward, outward)))

    def time_to(self, w_end):
        """The Mino time to an inward place w_end, for rays that have no turning point before."""
        y = F(w_end) * self.root
        x, v, end = self.x, self.v, np.sqrt(np.maximum(self.quartic(F(w_end) * self.root), F(0)))
        mixed = x * x * y * y * F(0.5) * self.c4 + F(1 / 3) * self.c3 * x * y * (x + y) + F(1 / 6) * self.c2 * (x * x + F(4) * x * y + y * y) + F(1)
        i = F(1) / (y - x)
        p = F(0.5) * (v * end + mixed) * i * i
        d = -np.sqrt(np.maximum(F(4) * p * p * p - self.g2 * p - self.g3, F(0)))
        return self.halved_time(p, d)


class Polar:
    """The motion about the hole, as amplitude of a phase that grows evenly."""

    def __init__(self, ray: Rays, k: Counted, eta: Counted):
        a2 = F(ray.a * ray.a)
        z, rate = ray.n[2], ray.n_rate[2]
        l_z = ray.n[0] * ray.n_rate[1] - ray.n[1] * ray.n_rate[0]
        tilt = k - a2
        d = np.sqrt(np.maximum(tilt * tilt + F(4) * a2 * eta, F(1e-12)))
        small = pick(tilt > 0, F(0.5) * (d + tilt), F(2) * a2 * eta / (d - tilt + F(1e-20)))
        kc2 = np.minimum(np.maximum(small / d, F(1e-8)), F(1))
        y = np.minimum(F(2) * l_z * l_z / (k + a2 + d), F(1))
        kc = np.sqrt(kc2)
        self.root_kc = np.sqrt(kc)
        e = F(0.5) * (F(1) - self.root_kc) / (F(1) + self.root_kc)
        nome = e * (F(1) + F(2) * e * e * e * e)
        self.nome2 = nome * nome
        theta = F(1) + F(2) * nome * (F(1) + nome * self.nome2)
        omega = np.sqrt(d)
        self.rate = omega / (theta * theta)
        q = np.sqrt(kc2 + a2 * z * z / d)
        psi = z * omega * q, -rate
        first = psi[0], self.root_kc * psi[1]
        v = self._unit(*first)
        for _ in range(2):
            c2 = F(1) - F(2) * v[1] * v[1]
            v = self._unit(first[0] * (F(1) - self.nome2 * (F(2) * c2 + F(1))), first[1] * (F(1) + self.nome2 * (F(2) * c2 - F(1))))
        self.phase = np.arctan2(v[1], v[0])
        psi = self._unit(*psi)
        pole = np.sqrt(F(1) + a2 * y / d)
        sense = pick(l_z < 0, F(-1), F(1))
        strength = sense * np.sqrt(y) * a2 / omega
        f0, f1, f2 = (strength / (pole + t) for t in (F(1), self.root_kc, kc))
        self.mean, self.waves = F(0.25) * (f0 + f2) + F(0.5) * f1, (F(0.25) * (f0 - f2) / self.rate, F(0.0625) * (f0 + f2 - F(2) * f1) / self.rate)
        self.axes, self.height = (np.sqrt(y), sense), np.sqrt(F(1) - y)
        u, u_rate = self._turned(psi), (-self.axes[0] * psi[1] * q * omega, sense * psi[0] * q * omega)
        beta = strength / (q + pole)
        m = ray.n_rate[0] + beta * ray.n[1], ray.n_rate[1] - beta * ray.n[0]
        real = d * (ray.n[0] * u[0] + ray.n[1] * u[1]) + m[0] * u_rate[0] + m[1] * u_rate[1]
        imaginary = d * (ray.n[1] * u[0] - ray.n[0] * u[1]) + m[1] * u_rate[0] - m[0] * u_rate[1]
        self.base = np.arctan2(imaginary, real) - self._wave(v)

    @staticmethod
    def _unit(x, y):
        i = F(1) / np.sqrt(np.maximum(x * x + y * y, F(1e-30)))
        return x * i, y * i

    def _turned(self, psi):
        return self.axes[0] * psi[0], self.axes[1] * psi[1]

    def _wave(self, v):
        return F(2) * v[0] * v[1] * (self.waves[0] + F(2) * self.waves[1] * (F(1) - F(2) * v[1] * v[1]))

    def crossing_time(self, order: int):
        half = F(np.pi)
        first = (F(np.pi / 2) - self.phase) / self.rate
        first = pick(first <= 0, first + half / self.rate, first)
        return pick(first > half / self.rate, first - half / self.rate, first) + F(order) * half / self.rate

    def place(self, tau, twist):
        """The world direction after τ, the frame dragged by `twist`."""
        angle = self.phase + self.rate * tau
        v = np.cos(angle), np.sin(angle)
        c2 = F(1) - F(2) * v[1] * v[1]
        psi = self._unit(self.root_kc * v[0] * (F(1) + self.nome2 * (F(2) * c2 - F(1))), v[1] * (F(1) - self.nome2 * (F(2) * c2 + F(1))))
        u, turn = self._turned(psi), self.base + self._wave(v) + self.mean * tau + twist
        c, s = np.cos(turn), np.sin(turn)
        return u[0] * c - u[1] * s, u[0] * s + u[1] * c, self.height * psi[0]


def trace(ray: Rays, nodes: int) -> TracedRays:
    a = ray.a
    horizon = 2.0 * float(horizon_radius(a))
    k = ray.n_rate[0] ** 2 + ray.n_rate[1] ** 2 + ray.n_rate[2] ** 2 - F(a * a) * ray.n[2] * ray.n[2]
    eta = ray.n_rate[2] * ray.n_rate[2] + ray.n[2] * ray.n[2] * (k - F(a * a) + F(a * a) * ray.n[2] * ray.n[2])
    radial, polar = Radial(ray, k, eta), Polar(ray, k, eta)
    slope, offset = F(3 - a * a) - F(a) * ray.lam, F(2 * (1 - a * a))
    y = np.sqrt(np.maximum(slope, F(0))) + F(np.cbrt(2 * (1 - a * a)))
    for _ in range(5):
        y = (F(2) * y * y * y + offset) / (F(3) * y * y - slope)
    barrier = F(1) / (F(1) + y)
    turned = np.asarray(radial.quartic(barrier * radial.root) < 0) & np.asarray(ray.w < barrier)
    escapes = turned | np.asarray(F(a) * ray.lam >= F(2 * horizon)) | np.asarray((ray.w_rate < 0) & (ray.w < barrier))
    w_last = 1.0 / (1.02 * horizon)
    end = pick(escapes, radial.time_to_infinity(), radial.time_to(w_last))
    abscissae, weights = np.polynomial.legendre.leggauss(nodes)
    before, twist = counted(np.zeros(len(y))), counted(np.zeros(len(y)))
    r, phi = np.full((2, len(y), 3), np.nan)

    def dragged(low, high):
        total, half, middle = F(0), F(0.5) * (high - low), F(0.5) * (high + low)
        for x, weight in zip(abscissae, weights):
            w = radial.w_at(middle + F(x) * half)
            total = total + F(weight) * w * (F(2) - F(a) * ray.lam * w) / ((F(1) - F(horizon) * w) * (F(1) - F(2 - horizon) * w))
        return F(-a) * half * total

    for order in range(3):
        tau = polar.crossing_time(order)
        there = np.asarray(tau < end) & np.asarray(eta > 0)
        tau = np.minimum(tau, end)
        twist = twist + dragged(before, tau)
        before = tau
        n = polar.place(tau, twist)
        w = radial.w_at(tau)
        r[:, order] = np.where(there, 0.5 / np.asarray(w), np.nan)
        phi[:, order] = np.where(there, np.arctan2(np.asarray(n[1]), np.asarray(n[0])), np.nan)
    twist = twist + dragged(before, end)
    direction = np.stack([np.asarray(x) for x in polar.place(end, twist)], axis=1).astype(float)
    direction = np.where(escapes[:, None], direction, np.nan)
    zero = np.zeros(len(y), int)
    return replace(unknown(len(y)), fate=np.where(escapes, 1, 2), direction=direction, steps=zero, evaluations=zero, crossing_r=r, crossing_phi=phi)


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--nodes", type=int, default=4, help="Gauss–Legendre nodes of the dragging between two crossings")
    nodes = parser.parse_args().nodes
    print("scene                direction 99 %: rad, px   near curve   crossing r 99 %   wrong fates   lost crossings")
    for chart_scene in scenes.chart_scenes():
        scene = chart_scene.scene.with_values({"rays.model": "kerr"})
        if scene.hole.gravity_strength != 1.0:
            continue
        Counted.quick = Counted.slow = 0
        with np.errstate(all="ignore"):
            found = trace(start(scene, local_vectors(chart_scene.rays, scene)), nodes)
        away = chart_scene.epsilon >= scenes.NEAR_CRITICAL
        far, near = (errors.compare(found, chart_scene.truth, part) for part in (away, ~away))
        print(f"{chart_scene.name:20s} {far.direction_99:14.1e} {far.direction_99 / chart_scene.pixel:8.3f} {near.direction_99:12.1e} {far.crossing_r_99:17.1e} {far.wrong_fates:13.4f} {far.lost_crossings:16.4f}")
    print(f"operations a ray, all three crossings: {Counted.quick} sums, products and choices, {Counted.slow} quotients, roots and trigonometric functions")


if __name__ == "__main__":
    main()
