"""Angles on the sky of the Earth, against published ones."""

import math

import pytest

from blackhole_gl.physics import angular_size
from blackhole_gl.planning import plan
from blackhole_gl.rendering import uniforms
from blackhole_gl.scene import Camera, Scene, Source

M87 = Source(real=True, mass_suns=6.5e9, distance_pc=16.8e6)
SGR_A = Source(real=True, mass_suns=4.154e6, distance_pc=8178.0)


def test_a_solar_mass_is_half_a_schwarzschild_radius_of_2953_m_wide():
    """GM/c² of the nominal Sun is 1476.625 m; here at a distance of 1 pc."""
    angle = 1476.625 / 3.0856775814913673e16 * 180.0 / math.pi * 3600e6
    assert angular_size.m_uas(Source(mass_suns=1.0, distance_pc=1.0)) == pytest.approx(angle, rel=1e-6)  # digits of 1476.625


@pytest.mark.parametrize("source, published, error", [(M87, 3.8, 0.4), (SGR_A, 5.02, 0.02)])
def test_published_sizes(source, published, error):
    """EHT 2019 Paper VI: 3.8 ± 0.4 µas; GRAVITY 2019, whose mass and distance EHT 2022 Paper VI turns into 5.02 µas."""
    assert angular_size.m_uas(source) == pytest.approx(published, abs=error)


def test_a_near_camera_sees_the_hole_at_its_own_distance():
    far = angular_size.picture_height_m(Camera(distance=math.inf, field_m=40.0))
    near = angular_size.picture_height_m(Camera(distance=1000.0, fov_deg=math.degrees(2.0 * math.atan(20.0 / 2000.0))))
    assert far == 40.0 and near == pytest.approx(40.0, rel=1e-12)


def test_only_a_real_object_is_told():
    scene = Scene().with_values({"camera.distance": math.inf, "camera.field_m": 40.0})
    assert angular_size.told(scene) == ""
    assert angular_size.told(scene.with_values({"source.real": True})) == "1 M = 3.82 µas, picture 152.8 µas high"


def test_mass_and_distance_bend_no_light():
    blocks = [uniforms.as_bytes(plan(Scene().with_values({"source.mass_suns": mass})), 0.0, (64, 36), (0.0, 0.0)) for mass in (1.0, 1e9)]
    assert blocks[0]["RayBlock"] == blocks[1]["RayBlock"]
