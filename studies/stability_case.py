"""How a way to go wrong is stated: a case, what its errors are held against, and the rays it is about. The cases themselves are in `stability_cases`.

Lengths in r_s = 1, angles in radians. Rays are (N, 2) arrays of ψ (angle from the hole's centre) and χ (on the screen from right towards up).
"""

from __future__ import annotations

import math
from collections.abc import Callable, Mapping
from dataclasses import dataclass, field
from functools import cache
from typing import Any, Literal

import numpy as np

from blackhole_gl.physics import relativity
from blackhole_gl.physics.space_time import space_time
from blackhole_gl.scene import Scene

HALF_PIXEL = 4e-4
"""rad: half a pixel of a picture 1080 pixels and 45° high, the plan's tolerance. Up to it a direction is fine."""

DEGREE = 2e-2
"""rad: about a degree. A direction that errs by more has failed."""

SHADOW_FINE, SHADOW_FAILS = 1e-3, 3e-2
"""Relative error of a shadow's angle."""

FLOOR = 5e-6
"""rad: a float32 ray at the relative distance ε from the critical curve errs by up to FLOOR/ε, crossings included, where the march is
Cartesian; by a tenth of it in Mino time. Typical are 3e-7/ε and 1e-7/ε."""

Topic = Literal[
    "observer's frame",
    "force law",
    "special directions",
    "long steps",
    "end of the march",
    "critical curve",
    "inside the photon sphere",
    "coordinates",
    "camera's place",
    "extreme spins",
    "whole range",
]
"""What a case is about."""

# Eight screen directions: the four axes, where symmetries hide mistakes or make them, and four that lie on none.
CHI = np.concatenate([0.5 * np.pi * np.arange(4), 0.5 * np.pi * np.arange(4) + 0.61])


@dataclass(frozen=True)
class Case:
    """One way to go wrong.

    Attributes:
        key: its name.
        topic: what it is about.
        title: what is asked, in a few words.
        why: what goes wrong in a method that fails.
        measure: ``rays`` (fates, directions, crossings), ``shadow`` (the angle of its edge) or ``sweep`` (random scenes: finite and resolved).
        values: scene values, by key, on top of the preset `reference`.
        rays: the rays of the scene; None for the other measures.
        floor: error in rad that float32 alone may make here, or that does not count; π where fates alone are judged.
        fates: whether a wrong fate counts; not where the critical curve is nearer than float32 numbers lie apart.
        needs: ``spin`` or ``steps`` where a model without has nothing to show; empty otherwise.
    """

    key: str
    topic: Topic
    title: str
    why: str
    measure: Literal["rays", "shadow", "sweep"] = "rays"
    values: Mapping[str, Any] = field(default_factory=dict)
    rays: Callable[[Scene], np.ndarray] | None = None
    floor: float = 0.0
    fates: bool = True
    needs: Literal["", "spin", "steps"] = ""

    def rays_in(self, scene: Scene) -> np.ndarray:
        """Its rays (N, 2) in `scene`.

        Raises:
            ValueError: it has none of its own.
        """
        if self.rays is None:
            raise ValueError(f"the case {self.key} measures {self.measure} and has no rays of its own; those that measure rays do")
        return self.rays(scene)


def grid(psi: Any, chi: Any = CHI) -> np.ndarray:
    """Every ψ at every χ, (N, 2)."""
    psi, chi = np.meshgrid(np.atleast_1d(psi), np.atleast_1d(chi))
    return np.stack([psi.ravel(), chi.ravel()], axis=-1)


def listed(psi: Any, chi: Any = CHI) -> Callable[[Scene], np.ndarray]:
    """The same rays in every scene."""
    return lambda scene: grid(psi, chi)


def impact(*b: float, inward: bool = True) -> Callable[[Scene], np.ndarray]:
    """Rays with impact parameters `b` (r_s) of a static observer in Schwarzschild."""

    def rays(scene: Scene) -> np.ndarray:
        r = scene.camera.distance
        psi = np.arcsin(np.array(b) * math.sqrt(1.0 - 1.0 / r) / r)
        return grid(psi if inward else np.pi - psi)

    return rays


def beside_shadow(*epsilon: float) -> Callable[[Scene], np.ndarray]:
    """Rays at ψ = ψ_c(χ)·(1 + ε), by the closed form of the shadow's edge."""

    def rays(scene: Scene) -> np.ndarray:
        edge = shadow_edge(scene, CHI)
        return np.concatenate([np.stack([edge * (1.0 + e), CHI], axis=-1) for e in epsilon])

    return rays


def whole_sky(count: int, reach: float = math.pi, away: float = 1e-2) -> Callable[[Scene], np.ndarray]:
    """`count` rays spread evenly over ψ < `reach`, none nearer than `away` (relative) to the critical curve. The golden ratio's sequence, no chance."""

    def rays(scene: Scene) -> np.ndarray:
        k = np.arange(2 * count)
        psi = reach * (k + 0.5) / (2 * count)
        chi = 2.0 * np.pi * np.mod(k * 0.6180339887498949, 1.0)
        kept = np.abs(psi / shadow_edge(scene, chi) - 1.0) >= away
        chosen = np.flatnonzero(kept)
        return np.stack([psi, chi], axis=-1)[chosen[:: max(1, len(chosen) // count)][:count]]

    return rays


def shadow_edge(scene: Scene, chi: np.ndarray) -> np.ndarray:
    """ψ of the shadow's edge that the scene's true space-time has: Kerr's, with the spin that its model knows."""
    camera, spin = scene.camera, space_time(scene).spin
    kind = camera.observer if camera.observer == "zamo" or _may_rest(scene, spin) else "zamo"
    return _edge(chi.tobytes(), camera.distance, math.radians(camera.inclination_deg), spin, kind)


@cache
def _edge(chi: bytes, distance: float, theta: float, spin: float, kind: str) -> np.ndarray:
    """The same edges serve every method."""
    return relativity.shadow_angle(np.frombuffer(chi), distance, theta, spin, kind)


def _may_rest(scene: Scene, spin: float) -> bool:
    """Whether a static observer is possible: outside the ergosphere."""
    r, a_cos = 2.0 * scene.camera.distance, spin * math.cos(math.radians(scene.camera.inclination_deg))
    return r * r - 2.0 * r + a_cos * a_cos > 0.0
