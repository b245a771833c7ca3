"""Where the ray model `screen_lens`, a thin lens seen in flat space, shows the sky well enough: its error in closed form (r_s = 1).

From r = D light that comes at the angle ψ from the hole was turned by (1 + cos ψ)/b + κ/b² + …, b = D sin ψ, with κ = 15π/16 + |a*| on the
side where dragging is worst. The lens turns it by atan(tan ψ) − atan(tan ψ − 2/(D tan ψ)), to first order 2 cos³ψ/b. So it errs by

    E(ψ) = (1 + cos ψ − 2 cos³ψ)/(D sin ψ) + κ/b² + 16/(3 b³),

the first for the flat observer and his flat screen, largest at the picture's corner, the others for bending near the hole. Measured against
the float64 reference: docs/accuracy.md.
"""

from __future__ import annotations

import math

from ..physics import projection, relativity
from ..physics.observer import is_moving
from ..scene import Scene, catalogue, met

MODEL = "screen_lens"

ASPECT = 16.0 / 9.0
"""Width over height of the picture that a tolerance is given in pixels of."""

# The share of the pixels that may err more.
_REST = 0.01

# Where the error of flat space is largest, rad: at the zero of its derivative.
_WIDEST = 0.9459

# Nearer the series in 1/b says nothing, and a per cent of the picture and more is shadow and what winds round it.
_LEAST_IMPACT = 2.0 * relativity.CRITICAL_IMPACT

# A static observer sees the sky's light (1 − 1/D)^(-2) times as bright as one in flat space does: nearer, by more than 1/255.
_LEAST_DISTANCE = 2.0 * 255.0


def draws(scene: Scene) -> bool:
    """Whether the lens may stand for `scene`: far from a hole, at rest, with nothing but its sky, and the lens as it comes."""
    if not projection.is_perspective(scene.camera):
        return False
    if scene.disk.enabled or not met.is_empty(scene) or scene.camera.distance < _LEAST_DISTANCE or is_moving(scene.camera):
        return False
    return all(scene.get(key) == item.default for key, item in catalogue.plug_ins("ray_model")[MODEL].parameters.items())


def error_px(scene: Scene, height: int) -> float:
    """What 99 % of the pixels of a picture of `scene` `height` pixels high keep within, of the direction that light comes from; infinite too near."""
    pixel = math.radians(scene.camera.fov_deg) / height
    distance, second = scene.camera.distance, 15.0 * math.pi / 16.0 + abs(scene.hole.spin)
    if math.isinf(distance):
        return _bending(math.sqrt(_REST * ASPECT / math.pi) * 0.5 * scene.camera.field_m, second) / pixel
    near, far = _least_angle(scene), min(_aside(scene) + _half_diagonal(scene), _WIDEST)
    # E falls away from the hole and rises again: between two angles it is nowhere larger than at one of them.
    return max(_error(min(psi, far), distance, second) for psi in (near, far)) / pixel


def _error(psi: float, distance: float, second: float) -> float:
    """E in rad; `second` is κ."""
    cosine, impact = math.cos(psi), distance * math.sin(psi)
    return (1.0 + cosine - 2.0 * cosine**3) / impact + _bending(impact, second)


def _bending(impact: float, second: float) -> float:
    """What the thin lens lacks of a deflection at the impact parameter `impact`, rad; infinite where the series does not reach."""
    return second / impact**2 + 16.0 / 3.0 / impact**3 if impact > _LEAST_IMPACT else math.inf


def _least_angle(scene: Scene) -> float:
    """ψ in rad within which the given share of the pixels lies; a circle aside of the middle takes more of them, by 1/cos³."""
    squeezed = math.cos(min(_aside(scene), _half_diagonal(scene))) ** 3
    return math.atan(_half_height(scene) * math.sqrt(_REST * 4.0 * ASPECT * squeezed / math.pi))


def _half_height(scene: Scene) -> float:
    return math.tan(math.radians(0.5 * scene.camera.fov_deg))


def _half_diagonal(scene: Scene) -> float:
    """Angle in rad from the picture's middle to its corner."""
    return math.atan(_half_height(scene) * math.hypot(1.0, ASPECT))


def _aside(scene: Scene) -> float:
    """Angle in rad from the picture's middle to the hole."""
    return math.acos(math.cos(math.radians(scene.camera.yaw_deg)) * math.cos(math.radians(scene.camera.pitch_deg)))
