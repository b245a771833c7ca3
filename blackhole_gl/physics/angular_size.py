"""How large things are on the sky of the Earth: lengths in M and angles in µas, for the mass and distance that a scene states.

The constants are exact by definition (SI; IAU 2012 B2 for the astronomical unit, IAU 2015 B3 for the nominal Sun).
"""

from __future__ import annotations

import math

from ..scene import Camera, Scene, Source

SUN_GM = 1.3271244e20
"""Nominal mass parameter of the Sun in m³/s²."""

LIGHT_SPEED = 299792458.0
"""m/s."""

PARSEC = 648000.0 / math.pi * 149597870700.0
"""Metres."""

MICROARCSECOND = math.pi / 648000.0 * 1e-6
"""Radians."""


def m_uas(source: Source) -> float:
    """The angle of M = GM/c² at the distance of `source`, in µas; small angles."""
    return SUN_GM * source.mass_suns / LIGHT_SPEED**2 / (source.distance_pc * PARSEC) / MICROARCSECOND


def picture_height_m(camera: Camera) -> float:
    """Height of the picture in M: of a near camera, of what is as far away as the hole."""
    if math.isinf(camera.distance):
        return camera.field_m
    return 4.0 * camera.distance * math.tan(math.radians(0.5 * camera.fov_deg))  # r_s = 2 M


def picture_height_uas(camera: Camera, source: Source) -> float:
    """The same in µas."""
    return picture_height_m(camera) * m_uas(source)


def is_told(scene: Scene) -> bool:
    """Whether angles on the sky mean something in `scene`: it stands for a real object, or is seen with a beam, whose width is such an angle."""
    return scene.source.real or scene.post.beam


def told(scene: Scene) -> str:
    """What is said of the real object's size on the sky; empty where the scene stands for none."""
    if not is_told(scene):
        return ""
    height = picture_height_uas(scene.camera, scene.source)
    return f"1 M = {m_uas(scene.source):.3g} µas, picture {height:.4g} µas high"
