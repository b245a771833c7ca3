"""The bar of a round angle on the sky, as long as the picture says."""

import math

import numpy as np
import pytest

from blackhole_gl.output.streams import spelled
from blackhole_gl.physics.angular_size import picture_height_uas
from blackhole_gl.rendering import scale_bar
from blackhole_gl.rendering.annotation import annotated
from blackhole_gl.scene import Scene, presets

FAR = {"camera.distance": math.inf, "camera.field_m": 32.0}


def test_scenes_that_stand_for_nothing_have_none() -> None:
    shown = scale_bar.of(Scene().with_values(FAR), 1.5)
    assert not shown.curves and not shown.names


@pytest.mark.parametrize("aspect", [0.5, 1.0, 16.0 / 9.0])
@pytest.mark.parametrize("name", ["m87_eht", "sgr_a_eht"])
def test_bar_and_beam_have_their_size(name: str, aspect: float) -> None:
    scene = presets.load([name])
    shown, height = scale_bar.of(scene, aspect), picture_height_uas(scene.camera, scene.source)
    bar, circle = shown.curves[1].places, shown.curves[3].places
    told, unit = shown.names[0].text.split()
    assert unit == "µas" and np.ptp(bar[:, 0]) * height == pytest.approx(float(told))
    assert np.ptp(circle[:, 0]) * height == pytest.approx(20.0) and shown.names[1].text == "beam 20 µas"
    for curve in shown.curves:
        assert ((curve.places > 0.0) & (curve.places < (aspect, 1.0))).all()
    assert 0.1 * aspect <= np.ptp(bar[:, 0]) <= 0.25 * aspect  # of 1, 2, 5 and 10 one lies in any such range


@pytest.mark.parametrize("angle, found", [(1.0, 1.0), (1.99, 1.0), (2.0, 2.0), (4.9, 2.0), (5.0, 5.0), (9.9, 5.0), (0.031, 0.02), (730.0, 500.0), (0.3, 0.2)])
def test_angles_are_round(angle: float, found: float) -> None:
    assert scale_bar.round_below(angle) == pytest.approx(found)


@pytest.mark.parametrize("angle, text", [(50.0, "50 µas"), (0.2, "0.2 µas"), (2000.0, "2 mas"), (5e6, "5 as")])
def test_units_suit_the_angle(angle: float, text: str) -> None:
    assert scale_bar.words(angle) == text


def test_saved_pictures_have_it_where_labels_are_on() -> None:
    scene, dark = presets.load(["m87_eht"]), np.zeros((180, 320, 3), np.uint8)
    assert annotated(dark, scene, None).max() == 0
    drawn = annotated(dark, scene.with_values({"post.labels": True}), None)
    row = drawn[round(180 * 0.96) - 1 : round(180 * 0.96) + 1, :, 0].max(axis=0)
    scale = picture_height_uas(scene.camera, scene.source)
    length = 180 * 50.0 / scale
    start = 180 * 0.04
    assert (row[math.ceil(start) : math.floor(start + length)] > 100).all() and row[: math.floor(start) - 1].max() == 0


def test_a_terminal_without_the_letter_gets_another() -> None:
    assert spelled("42.3 µas, 6.5e9 M☉") == "42.3 uas, 6.5e9 M_sun"
