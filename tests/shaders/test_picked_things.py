"""Which of the scene's things and media a pixel shows."""

from __future__ import annotations

import numpy as np

from blackhole_gl.rendering import instance_numbers
from blackhole_gl.rendering.frame import Renderer
from blackhole_gl.scene import Scene, presets

SIZE = (96, 64)


def sphere(name: str, **values: float) -> dict[str, object]:
    return {f"things.{name}.{key}": value for key, value in {"kind": "sphere", **values}.items()}


def scene() -> Scene:
    """Two spheres and a ring before them, far from the hole, where light runs nearly straight: near sphere left, far one right."""
    left, right = sphere("left", x=40.0, y=-1.5, z=0.0, radius=1.0), sphere("right", x=38.0, y=1.5, z=0.0, radius=1.0)
    given = {"kind": "annulus", "inner_radius": 42.0, "outer_radius": 43.0, "tilt_deg": 2.0, "node_deg": 90.0}
    ring = {f"things.ring.{key}": value for key, value in given.items()}
    return presets.load(["kerr"], {"camera.distance": 50.0, "camera.inclination_deg": 90.0, "disk.enabled": False, **left, **ring, **right})


def test_numbers_and_names_are_two_ways_of_one(renderer: Renderer) -> None:
    made = scene()
    numbers = [instance_numbers.number_of(made, f"things.{name}") for name in made.things]
    assert len(set(numbers)) == 3 and [instance_numbers.path_of(made, number) for number in numbers] == ["things.left", "things.ring", "things.right"]
    assert instance_numbers.number_of(made, "things.gone") is None


def test_a_pixel_shows_the_thing_whose_pixel_it_is(renderer: Renderer) -> None:
    made = scene()
    renderer.render(made, 0.0, SIZE)
    met = renderer.hits().met
    masks = {name: renderer.last.pixels_of(made, f"things.{name}") for name in made.things}
    # The camera on the x axis has y to its right: the spheres' own places say which is which.
    columns = {name: np.nonzero(mask)[1] for name, mask in masks.items()}
    assert columns["left"].size > 20 and columns["left"].max() < SIZE[0] / 2 - 1 and columns["right"].size > 20 and columns["right"].min() > SIZE[0] / 2
    assert masks["ring"].sum() > 20
    assert np.array_equal(np.logical_or.reduce(list(masks.values())), (met[..., 0] >= 0).any(axis=-1))
    for y, x in np.argwhere(masks["left"] & ~masks["ring"])[::7]:
        assert renderer.last.instance_at(((x + 0.5) / SIZE[0], (y + 0.5) / SIZE[1])) == "things.left"
    assert renderer.last.instance_at((0.5, 0.02)) == ""


def test_a_thing_in_a_cloud_is_picked_before_the_cloud() -> None:
    made = Scene().with_values(sphere("a") | sphere("b"))
    assert instance_numbers.picked(made, np.array([[-1, -1, -1], [0, 1, 0]])) == "things.b"
    assert instance_numbers.picked(made, np.array([[-1, -1, -1]])) == instance_numbers.picked(made, None) == ""


def test_nothing_is_told_of_a_map_that_is_not_whole(renderer: Renderer) -> None:
    made = presets.load(["kerr"], {"camera.azimuth_deg": 3.0, "rays.tolerance": 0.5})
    renderer.render(made, 0.0, SIZE, progressive=True)
    assert not renderer.hit_map.is_sharp and renderer.last.instance_at((0.5, 0.5)) is None
    renderer.render(made, 0.0, SIZE)
    assert renderer.last.instance_at((0.5, 0.5)) == ""
