"""Ticks over a picture and the Stokes parameters that they show. No GL is needed."""

from __future__ import annotations

import math

import numpy as np
import pytest
from scipy import ndimage

from blackhole_gl.measure import polarization_maps, ring
from blackhole_gl.physics.observer import local_directions, observe, parallel_rays
from blackhole_gl.planning import plan
from blackhole_gl.rendering import beam, labels, polarized_disk
from blackhole_gl.rendering.annotation import annotated
from blackhole_gl.scene import Scene

FACE_ON = {"camera.inclination_deg": 0.0, "camera.distance": math.inf, "camera.field_m": 36.0, "polarization.field_vertical": 0.0}
FIELDS = {"radial": {**FACE_ON, "polarization.field_radial": 1.0}, "toroidal": {**FACE_ON, "polarization.field_toroidal": 1.0}}


def segments(scene: Scene, aspect: float = 1.5) -> np.ndarray:
    """Ends of the ticks, (N, 2, 2)."""
    return polarized_disk.ticks(scene, aspect).curves[-1].places.reshape(-1, 3, 2)[:, :2]


@pytest.mark.parametrize("values", [FACE_ON, {"camera.yaw_deg": 12.0, "camera.pitch_deg": -5.0, "camera.roll_deg": 30.0, "camera.distance": 9.0}])
def test_a_place_of_the_picture_has_the_direction_that_is_seen_there(values: dict) -> None:
    scene = Scene().with_values(values)
    places = np.random.default_rng(1).uniform(0.0, (1.5, 1.0), (50, 2))
    found = polarized_disk.directions_at(observe(scene), scene, 1.5, places)
    np.testing.assert_allclose(labels.places(observe(scene), scene, 1.5, found), places, atol=1e-12)
    if observe(scene).w > 0.0:  # what a ray starts with is told of unit vectors
        np.testing.assert_allclose(np.linalg.norm(found, axis=-1), 1.0)


@pytest.mark.parametrize("name, outwards", [("toroidal", 1.0), ("radial", 0.0)])
def test_ticks_of_a_face_on_disk_go_round_or_outwards(name: str, outwards: float) -> None:
    """0.1: aberration tilts those of a radial field, by 3° at 6.5 r_s and by 5° at 5; images of higher order, near the shadow, may lie otherwise."""
    ends = segments(Scene().with_values(FIELDS[name]))
    middle, along = ends.mean(axis=1) - [0.75, 0.5], ends[:, 1] - ends[:, 0]
    cosine = np.abs(np.sum(middle * along, axis=1)) / np.linalg.norm(middle, axis=1) / np.linalg.norm(along, axis=1)
    far = np.linalg.norm(middle, axis=1) > 0.3
    assert far.sum() > 200
    np.testing.assert_allclose(cosine[far], outwards, atol=0.1)


def test_ticks_are_no_longer_than_they_are_apart_and_stand_on_the_disk_alone() -> None:
    scene = Scene().with_values(FIELDS["radial"])
    ends = segments(scene)
    assert np.linalg.norm(ends[:, 1] - ends[:, 0], axis=1).max() < 1.0 / scene.polarization.tick_rows
    far = np.linalg.norm(ends.mean(axis=1) - [0.75, 0.5], axis=1) * scene.camera.field_m
    assert far.max() < 2.0 * plan(scene).disk_outer + 2.0  # light of the edge is bent by about 1 M
    assert far.min() > 3.0 * math.sqrt(3.0)  # the shadow's radius, in M


def test_light_is_polarized_by_three_quarters_at_most_and_less_where_images_lie_over_each_other() -> None:
    scene = Scene().with_values({"camera.inclination_deg": 70.0, "disk.compositing": "additive", "hole.spin": 0.5, "polarization.field_radial": 0.7})
    found = polarized_disk.stokes(plan(scene), observe(scene), local_directions(np.linspace(0.05, 0.5, 400), np.linspace(0.0, 25.0, 400)))
    share = found.polarized[found.i > 0.0] / found.i[found.i > 0.0]
    assert share.max() < 0.75 + 1e-12
    assert np.median(share) == pytest.approx(0.75)
    assert share.min() < 0.74


def test_brightness_is_that_of_the_disk_s_law_and_the_shift() -> None:
    """Along the axis g of a place is 1/u^t, and light leaves a slow disk almost along the normal."""
    scene = Scene().with_values({**FACE_ON, "disk.temperature_law": "shakura_sunyaev", "disk.outer_radius": 20.0, "polarization.emission": "atmosphere"})
    found = polarized_disk.stokes(plan(scene), observe(scene), parallel_rays(np.array([20.0, 38.0]), np.zeros(2)))
    r = (np.array([20.0, 38.0]) - 1.0) / 2.0  # r_s, within 1 % of r where light comes from
    g = np.sqrt(1.0 - 1.5 / r)
    np.testing.assert_allclose(found.i / (g**4 * (r / 3.0) ** -3.0), 1.27, atol=0.08)  # the atmosphere's limb, 1.269 along the normal
    assert (found.polarized / found.i).max() < 0.01


def test_what_ticks_do_not_depend_on_does_not_make_them_anew() -> None:
    scene = Scene().with_values({"polarization.ticks": True})
    for key, value in {"camera.azimuth_deg": 40.0, "post.exposure": 1.0, "disk.temperature_k": 9000.0, "sky.brightness": 0.0}.items():
        assert polarized_disk.ticks(scene, 1.5) is polarized_disk.ticks(scene.with_values({key: value}), 1.5), key
    assert polarized_disk.ticks(scene, 1.5) is not polarized_disk.ticks(scene.with_values({"polarization.field_radial": 1.0}), 1.5)


@pytest.mark.parametrize(
    "values, word",
    [
        ({"rays.model": "weak_field"}, "weak_field"),
        ({"disk.enabled": False}, "no disk"),
        ({"rays.lensing": False}, "flat"),
        ({"polarization.field_vertical": 0.0}, "field_vertical"),
    ],
)
def test_where_it_is_not_known_a_note_says_why(values: dict, word: str) -> None:
    found = polarized_disk.ticks(Scene().with_values(values), 1.5)
    assert not found.curves
    assert word in found.note


def test_ticks_are_drawn_into_saved_pictures_and_over_no_view() -> None:
    black = np.zeros((120, 180, 3), np.uint8)
    scene = Scene().with_values({**FIELDS["radial"], "polarization.ticks": True})
    drawn = annotated(black, scene, None)
    assert 0.02 < (drawn.max(axis=-1) > 60).mean() < 0.5
    assert not annotated(black, scene.with_values({"polarization.ticks": False}), None).any()


def test_orders_that_are_not_shown_give_no_light() -> None:
    scene = Scene().with_values({"camera.inclination_deg": 60.0, "disk.compositing": "additive"})
    rays = local_directions(np.linspace(0.1, 0.25, 4000), np.linspace(0.0, 25.0, 4000))

    def light(shown: str) -> np.ndarray:
        made = scene.with_values({"disk.orders_shown": shown})
        return np.stack([getattr(polarized_disk.stokes(plan(made), observe(made), rays), part) for part in "iqu"])

    orders = [light(shown) for shown in ("direct", "first_ring", "second_ring")]
    assert all(part[0].any() for part in orders)
    np.testing.assert_allclose(sum(orders), light("all"), atol=1e-12)


def test_ticks_of_a_picture_through_a_beam_are_those_of_light_through_it() -> None:
    """Against maps of 240 rows through the blur of the ring's measures. 0.02 and 0.07 of the brightest: edges lie between samples."""
    scene = Scene().with_values(
        {"hole.spin": 0.5, "camera.distance": math.inf, "camera.field_m": 32.0, "camera.inclination_deg": 30.0, "disk.outer_radius": 4.0, "post.beam": True}
    )
    aside, down = np.linspace(0.2, 0.8, 20), np.linspace(0.2, 0.8, 24)
    maps = polarization_maps.measure(scene, (240, 240)).through(lambda part: ring.blurred(part, beam.sigma_px(scene, 240)))
    for samples, error in ((polarized_disk._SAMPLES_A_SIGMA, 0.02), (polarized_disk._SAMPLES_IN_MOTION, 0.07)):
        found = polarized_disk._through_beam(plan(scene), observe(scene), 1.0, aside, down, samples)
        for name in "iqu":
            places = np.meshgrid(240.0 * down - 0.5, 240.0 * aside - 0.5, indexing="ij")
            fine = ndimage.map_coordinates(getattr(maps.stokes, name), places, order=1).ravel()
            np.testing.assert_allclose(getattr(found, name), fine, atol=error * maps.stokes.i.max())
    assert segments(scene, 1.0).shape != segments(scene.with_values({"post.beam": False}), 1.0).shape


def test_matter_that_falls_in_is_polarized_too() -> None:
    """Its light begins where that of circular orbits ends, and the shadow's middle stays dark."""
    scene = Scene().with_values({"camera.inclination_deg": 30.0, "disk.plunging": True, "disk.inner_torque": 0.1, "polarization.field_radial": 1.0})
    rays = local_directions(np.linspace(0.01, 0.3, 400), np.full(400, 0.5 * np.pi))
    with_it, without = (polarized_disk.stokes(plan(made), observe(made), rays) for made in (scene, scene.with_values({"disk.plunging": False})))
    more = (with_it.i > 0.0) & (without.i == 0.0)
    assert more.sum() > 5 and np.isfinite(with_it.angle).all()
    assert with_it.polarized[more].max() > 0.1 * with_it.polarized.max()
    outside = without.i > 0.0
    np.testing.assert_allclose(with_it.angle[outside][-50:], without.angle[outside][-50:], atol=1e-9)
