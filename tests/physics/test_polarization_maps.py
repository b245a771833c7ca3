"""Maps of polarization, and what is told of them."""

from __future__ import annotations

import math

import numpy as np
import pytest

from blackhole_gl import cli
from blackhole_gl.measure import polarization_maps
from blackhole_gl.measure.polarization_maps import PolarizationMaps
from blackhole_gl.physics.observer import local_directions, observe
from blackhole_gl.planning import plan
from blackhole_gl.rendering import labels
from blackhole_gl.rendering.polarized_disk import Stokes, stokes
from blackhole_gl.scene import Scene, SceneError


def ring_with(turn: float) -> PolarizationMaps:
    """A ring about (40.5, 30) polarized by half at an angle of `turn` with the radius."""
    x, y = np.meshgrid(np.arange(81) + 0.5 - 40.5, 30.0 - np.arange(60) - 0.5)
    light = np.exp(-((np.hypot(x, y) - 20.0) ** 2) / 8.0)
    angle = np.arctan2(-x, y) + turn
    return PolarizationMaps(Stokes(light, 0.5 * light * np.cos(2.0 * angle), 0.5 * light * np.sin(2.0 * angle)), (40.5, 30.0))


@pytest.mark.parametrize("turn", [0.0, 0.3, 0.5 * math.pi])
def test_beta_2_is_the_share_and_twice_the_angle_with_the_radius(turn: float) -> None:
    found = ring_with(turn)
    assert found.beta_2 == pytest.approx(0.5 * np.exp(2j * turn), abs=1e-12)
    assert found.mean_share == pytest.approx(0.5)
    assert found.net[0] < 1e-3  # it cancels round the ring, but for what pixels leave


@pytest.mark.parametrize("values, beta", [({"polarization.field_toroidal": 1.0}, 0.75), ({"polarization.field_radial": 1.0}, -0.75)])
def test_the_ring_of_a_face_on_disk_has_the_published_signs(values: dict, beta: float) -> None:
    """Positive for a field that goes round, negative for one outwards (Palumbo, Wong & Prather 2020); 0.08: aberration turns the latter by some degrees."""
    face_on = {"camera.inclination_deg": 0.0, "camera.distance": math.inf, "camera.field_m": 45.0, "polarization.field_vertical": 0.0}
    assert polarization_maps.measure(Scene().with_values({**face_on, **values}), (72, 72)).beta_2 == pytest.approx(beta, abs=0.08)


def test_a_pixel_of_the_maps_is_a_ray_through_its_middle() -> None:
    scene = Scene().with_values({"camera.inclination_deg": 60.0, "hole.spin": 0.5, "camera.roll_deg": 20.0, "polarization.field_radial": 0.5})
    maps, observer = polarization_maps.measure(scene, (48, 32)), observe(scene)
    rays = local_directions(np.linspace(0.1, 0.3, 20), np.linspace(0.0, 6.0, 20))
    right, down = np.floor(32.0 * labels.places(observer, scene, 1.5, rays)).astype(int).T
    alone = stokes(plan(scene), observer, rays)
    shines = (alone.i > 0.02) & (maps.stokes.i[down, right] > 0.02)
    assert shines.sum() > 8
    turn = np.exp(2j * (alone.angle - maps.stokes.angle[down, right]))[shines]
    assert np.median(np.abs(turn - 1.0)) < 0.15  # half a pixel aside it is another angle


def test_the_command_writes_an_archive(tmp_path, capsys) -> None:
    cli.polarization(tmp_path / "maps.npz", names=["kerr"], size="24x16")
    with np.load(tmp_path / "maps.npz") as maps:
        assert {name: maps[name].shape for name in maps} == {"I": (16, 24), "Q": (16, 24), "U": (16, 24)}
        assert (np.hypot(maps["Q"], maps["U"]) <= 0.75 * maps["I"] + 1e-12).all() and maps["I"].max() > 0.0
    assert "beta_2" in capsys.readouterr().err


@pytest.mark.parametrize(
    "values, word",
    [({"rays.model": "weak_field"}, "weak_field"), ({"polarization.field_vertical": 0.0}, "field_vertical"), ({"camera.yaw_deg": 180.0}, "arrives")],
)
def test_a_scene_without_it_is_refused(values: dict, word: str) -> None:
    with pytest.raises(SceneError, match=word):
        polarization_maps.measure(Scene().with_values(values), (24, 16))
