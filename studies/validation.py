"""The validation that BlackHoleGPU's report (docs/sources.md) states for itself, made again with figures: drift, photon sphere, deflection."""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np

from blackhole_gl import listed_rays
from blackhole_gl.measure.methods import MAX_STEPS
from blackhole_gl.physics import deflection, observer
from blackhole_gl.rendering.frame import Renderer
from blackhole_gl.scene import Scene, presets

DRIFT_STEPS = 1000
DRIFT_LENGTH = 0.08  # r_s: the step of BlackHoleGPU's preset Ultra

IMPACTS = (2.6, 2.7, 3.0, 4.0, 6.0, 10.0, 30.0, 100.0, 1000.0)
"""Impact parameters in r_s."""

DEFLECTION_MODELS = ("kerr", "schwarzschild", "post_newtonian")


@dataclass(frozen=True)
class Drift:
    """Largest relative change of the conserved energy and angular momentum over `DRIFT_STEPS` steps of an integrator, in float32."""

    integrator: str
    energy: float
    angular_momentum: float


@dataclass(frozen=True)
class Deflection:
    """Deflection in radians at impact parameter `b` (r_s): first order, exact by elliptic integrals, and what the shader finds by model."""

    b: float
    weak: float
    exact: float
    by_model: dict[str, float]


@dataclass(frozen=True)
class PhotonSphere:
    """Radius of the photon sphere in r_s from the edge of the traced shadow, b_c/√3; 3/2 is exact."""

    model: str
    radius: float


@dataclass(frozen=True)
class Validation:
    """All three."""

    drifts: list[Drift]
    photon_spheres: list[PhotonSphere]
    deflections: list[Deflection]


def validate(renderer: Renderer) -> Validation:
    """BlackHoleGPU's checks on our shaders; the drift on the same equation in NumPy's float32, as shaders do not tell what they conserve."""
    spheres = [PhotonSphere(model, _shadow_impact(renderer, _scene(model, 20.0)) / math.sqrt(3.0)) for model in ("kerr", "schwarzschild")]
    return Validation([_drift(name, step) for name, step in _STEPS.items()], spheres, _deflections(renderer))


def _scene(model: str, distance: float) -> Scene:
    values = {"rays.model": model, "rays.max_steps": MAX_STEPS, "camera.distance": distance, "camera.inclination_deg": 90.0, "disk.enabled": False}
    return presets.load(["schwarzschild", "reference"], values)


def _shadow_impact(renderer: Renderer, scene: Scene) -> float:
    """Impact parameter in r_s at which the shader's fate turns: four rounds of 256 trial rays."""
    low, high = 0.0, 0.5 * math.pi
    for _ in range(4):
        trials = np.linspace(low, high, 258)[1:-1]
        fate = listed_rays.trace_by_shader(renderer, scene, np.stack([trials, np.full(256, 0.3)], axis=-1)).fate
        captured = int(np.sum(fate == 2))
        edges = np.concatenate([[low], trials, [high]])
        low, high = edges[captured], edges[captured + 1]
    distance = scene.camera.distance
    return distance * math.sin(0.5 * (low + high)) / math.sqrt(1.0 - 1.0 / distance)


def _deflections(renderer: Renderer) -> list[Deflection]:
    rays = np.stack([2.0 * np.array(IMPACTS), np.zeros(len(IMPACTS))], axis=-1)
    found = {}
    for model in DEFLECTION_MODELS:
        scene = _scene(model, math.inf)
        inward = -observer.observe(scene).n
        direction = listed_rays.trace_by_shader(renderer, scene, rays).direction
        aside = observer.observe(scene).e_phi
        found[model] = np.arctan2(-direction @ aside, direction @ inward)
    exact, weak = deflection.exact(np.array(IMPACTS)), deflection.weak(np.array(IMPACTS))
    # Directions are the same after a whole turn; the exact value says how many there were.
    found = {model: angle + 2.0 * np.pi * np.round((exact - angle) / (2.0 * np.pi)) for model, angle in found.items()}
    return [Deflection(b, float(weak[i]), float(exact[i]), {model: float(angle[i]) for model, angle in found.items()}) for i, b in enumerate(IMPACTS)]


# --- x'' = −(3/2) h² x/r⁵ in float32 -------------------------------------------------------------------------------------------


def _force(x: np.ndarray, h2: np.ndarray) -> np.ndarray:
    r2 = np.sum(x * x, axis=0)
    return np.float32(-1.5) * h2 * x / (r2 * r2 * np.sqrt(r2))


def _euler(x, v, h2, dt):
    return x + dt * v, v + dt * _force(x, h2)


def _verlet(x, v, h2, dt):
    half = v + np.float32(0.5) * dt * _force(x, h2)
    x = x + dt * half
    return x, half + np.float32(0.5) * dt * _force(x, h2)


def _rk4(x, v, h2, dt):
    half = np.float32(0.5) * dt
    k1, l1 = v, _force(x, h2)
    k2, l2 = v + half * l1, _force(x + half * k1, h2)
    k3, l3 = v + half * l2, _force(x + half * k2, h2)
    k4, l4 = v + dt * l3, _force(x + dt * k3, h2)
    sixth, two = dt / np.float32(6.0), np.float32(2.0)
    return x + sixth * (k1 + two * (k2 + k3) + k4), v + sixth * (l1 + two * (l2 + l3) + l4)


_STEPS = {"euler": _euler, "verlet": _verlet, "rk4": _rk4}


def _drift(name: str, step) -> Drift:
    """Rays from r = 20 r_s with b = 2.7 … 10 r_s, which all swing round the hole and leave."""
    b = np.linspace(2.7, 10.0, 64)
    x = np.array([np.full(64, 20.0), np.zeros(64)], np.float32)
    v = np.array([-np.sqrt(1.0 - b**2 / 400.0 * (1.0 - 1.0 / 20.0)), b / 20.0], np.float32)
    h2 = (x[0] * v[1] - x[1] * v[0]) ** 2
    energy, momentum = _conserved(x, v)
    worst = [0.0, 0.0]
    for _ in range(DRIFT_STEPS):
        x, v = step(x, v, h2, np.float32(DRIFT_LENGTH))
        now = _conserved(x, v)
        worst = [max(w, float(np.max(np.abs(a / b0 - 1.0)))) for w, a, b0 in zip(worst, now, (energy, momentum))]
    return Drift(name, *worst)


def _conserved(x: np.ndarray, v: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """(E², h) in float64: E² = |v|² − h²/r³."""
    x, v = x.astype(float), v.astype(float)
    momentum = x[0] * v[1] - x[1] * v[0]
    return np.sum(v * v, axis=0) - momentum**2 / np.sum(x * x, axis=0) ** 1.5, momentum
