"""Rays for tests: shadow edges by bisection through the pictures' own shader, and random rays that keep off the critical curve."""

from __future__ import annotations

import math

import numpy as np

from blackhole_gl.physics import observer, relativity
from blackhole_gl.physics.space_time import space_time
from blackhole_gl.rendering.frame import Renderer
from blackhole_gl.scene import Scene

# With 2048 rays the list's texture has two rows of 1024.
_TRIALS = 256
SCREEN_ANGLES = 2.0 * np.pi * (np.arange(8) + 0.3) / 8
"""χ of eight points of a shadow's edge, none on an axis of symmetry."""


def shadow_edge(renderer: Renderer, scene: Scene, chi: np.ndarray) -> np.ndarray:
    """ψ where the traced fate turns from captured to escaped, for each of `chi`; good to π/257⁴ = 7e-10.

    Each round splits what is left into 257 parts and keeps the one after the captured ones.
    """
    low, high = np.zeros_like(chi), np.full_like(chi, np.pi)
    for _ in range(4):
        inner = low[:, None] + (high - low)[:, None] * np.arange(1, _TRIALS + 1) / (_TRIALS + 1)
        hits, _, _ = renderer.trace_listed(scene, observer.local_directions(inner, chi[:, None]).reshape(-1, 3))
        assert np.all(hits.fate > 0), "unresolved rays at the shadow's edge"
        captured = np.sum(hits.fate.reshape(inner.shape) == 2, axis=1)
        edges = np.concatenate([low[:, None], inner, high[:, None]], axis=1)
        low, high = (edges[np.arange(len(chi)), captured + k] for k in (0, 1))
    return 0.5 * (low + high)


def random_rays(scene: Scene, count: int, seed: int, away: float = 1e-2) -> np.ndarray:
    """(count, 2) rays ψ, χ; |ψ/ψ_c − 1| ≥ `away` from the critical curve.

    Half of them uniform in solid angle over a view 15 r_s wide at the hole, half uniform in ψ over the whole sky.
    """
    rng = np.random.default_rng(seed)
    camera, spin = scene.camera, space_time(scene).horizon_spin
    chi = rng.uniform(0.0, 2.0 * np.pi, 2 * count)
    reach = min(math.pi, 1.2 * math.atan(15.0 / camera.distance))
    share = rng.uniform(0.0, 1.0, 2 * count)
    psi = np.where(np.arange(2 * count) % 2 == 0, np.arccos(1.0 - share * (1.0 - math.cos(reach))), share * np.pi)
    edge = relativity.shadow_angle(chi, camera.distance, math.radians(camera.inclination_deg), spin, observer.observe(scene).kind)
    kept = np.abs(psi / edge - 1.0) >= away
    return np.stack([psi, chi], axis=-1)[kept][:count]
