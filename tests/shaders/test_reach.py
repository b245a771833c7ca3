"""Where things can be seen: a moving camera's refined map loses and displaces none, and a thing that moves before a resting one costs its own squares alone."""

from __future__ import annotations

import math
from dataclasses import fields

import numpy as np
import pytest

from blackhole_gl.planning import plan
from blackhole_gl.rendering import reach
from blackhole_gl.rendering.edge_blocks import EdgeBlocks
from blackhole_gl.rendering.edge_marks import Edges
from blackhole_gl.rendering.frame import Renderer
from blackhole_gl.rendering.hit_texels import HitArrays
from blackhole_gl.rendering.inputs import FrameInputs
from blackhole_gl.rendering.squares import Squares
from blackhole_gl.scene import Scene, presets

SIZE = (320, 180)
VIEWS = 24

# At the plan's own steps a ray that falls straight in takes one, on whose curve things beside the horizon are met some pixels off (shaders/common/curve.glsl).
FINE = {"rays.model": "kerr", "rays.integrator": "nystrom5", "rays.step_control": "mino", "rays.step_angle": 0.2}


def _sphere(name: str, radius: float, **values: object) -> dict[str, object]:
    return {f"things.{name}.kind": "sphere", f"things.{name}.radius": radius, **{f"things.{name}.{key}": value for key, value in values.items()}}


def _at_rest(name: str, radius: float, place: np.ndarray) -> dict[str, object]:
    return _sphere(name, radius, **dict(zip("xyz", map(float, place))))


def _scene(**values: object) -> Scene:
    return presets.load(["kerr"], {"hole.spin": 0.9, "rays.edges": 1, **values})


def _ten(**values: object) -> Scene:
    """Ten spheres about the hole and its disk, of which the first is on an orbit."""
    things = _sphere("s0", 0.4, path="geodesic", orbit_radius=7.0, orbit_tilt_deg=20.0)
    for k in range(1, 10):
        around = 2.0 * math.pi * k / 10
        place = np.array([(4.0 + 0.9 * k) * math.cos(around), (4.0 + 0.9 * k) * math.sin(around), 1.5 * math.sin(3.0 * around) + 1.0])
        things |= _at_rest(f"s{k}", 0.2 + 0.05 * k, place)
    return _scene(**things, **values)


def _random_view(rng: np.random.Generator, steps: dict[str, object]) -> Scene:
    """Ten spheres from half a pixel to the hole's size, anywhere from beside the horizon to 14 r_s, seen from anywhere."""
    things = {}
    for k in range(10):
        direction = rng.normal(size=3)
        place = direction / np.linalg.norm(direction) * np.exp(rng.uniform(np.log(1.5), np.log(14.0)))
        things |= _at_rest(f"s{k}", float(np.exp(rng.uniform(np.log(0.02), np.log(0.8)))), place)
    camera = {
        "camera.azimuth_deg": rng.uniform(-180.0, 180.0),
        "camera.inclination_deg": rng.uniform(2.0, 178.0),
        "camera.distance": float(np.exp(rng.uniform(np.log(3.0), np.log(40.0)))),
        "camera.yaw_deg": rng.uniform(-20.0, 20.0),
    }
    return _scene(**things, **camera, **steps)


def _traced(renderer: Renderer, scene: Scene, *, progressive: bool, time: float = 0.0, size: tuple[int, int] = SIZE) -> HitArrays:
    renderer.hit_map.forget()
    renderer.hit_map.trace(_inputs(scene, time, size), progressive=progressive)
    return renderer.hits()


def _inputs(scene: Scene, time: float, size: tuple[int, int] = SIZE) -> FrameInputs:
    return FrameInputs.whole(plan(scene), time, size)


def _same(found: HitArrays, exact: HitArrays) -> bool:
    pairs = ((getattr(found, item.name), getattr(exact, item.name)) for item in fields(HitArrays))
    return all(a is None and b is None or np.array_equal(a, b) for a, b in pairs)


@pytest.mark.parametrize(("steps", "most"), [(FINE, 0), ({}, 20)])
def test_no_thing_is_lost_or_displaced_under_a_moving_camera(renderer: Renderer, steps: dict, most: int) -> None:
    """In which thing each pixel shows, refined maps of random views are the exact ones: a pixel that shows any has a ray of its own.

    At the plan's own steps one sphere beside the horizon is displaced in the exact map: by 17 pixels, and by 45 when the step was a curve beyond the horizon.
    """
    rng = np.random.default_rng(3)
    shown = wrong = interpolated = 0
    for _ in range(VIEWS):
        scene = _random_view(rng, steps)
        exact, found = _traced(renderer, scene, progressive=False), _traced(renderer, scene, progressive=True)
        interpolated += int(np.count_nonzero(~renderer.hit_map.own_rays())) if not renderer.hit_map.is_sharp else 0
        shown += np.count_nonzero(exact.met[..., 0, 0] >= 0)
        wrong += np.count_nonzero(np.any(found.met != exact.met, axis=(-2, -1)))
    assert shown > 30 * VIEWS
    assert wrong <= most
    assert interpolated > 0.4 * VIEWS * SIZE[0] * SIZE[1], "at 1280×720 most pixels are: squares are as large whatever the picture's size"


def test_nor_in_a_large_picture_whose_first_nodes_are_farther_apart(renderer: Renderer) -> None:
    size, rng = (360, 720), np.random.default_rng(5)
    assert reach.steps(size[1]) == [16, 8, 4] and reach.steps(SIZE[1]) == [8, 4]
    shown = 0
    for _ in range(3):
        scene = _random_view(rng, FINE)
        exact, found = (_traced(renderer, scene, progressive=progressive, size=size) for progressive in (False, True))
        shown += np.count_nonzero(exact.met[..., 0, 0] >= 0)
        np.testing.assert_array_equal(found.met, exact.met)
    assert shown > 10_000


def test_a_ball_that_a_hole_lies_in_is_seen_by_rays_that_fall_in(renderer: Renderer) -> None:
    """By how much a way into the hole may be off does not shrink with what lies between rays: 75 pixels were black."""
    view = {"camera.azimuth_deg": -57.73, "camera.inclination_deg": 153.97, "camera.distance": 10.01, "camera.fov_deg": 21.14}
    scene = presets.load(["kerr"], {"rays.edges": 1, **view, **_at_rest("ball", 2.0522, np.array([-1.0976, 0.8643, -1.9489]))})
    exact, found = _traced(renderer, scene, progressive=False), _traced(renderer, scene, progressive=True)
    np.testing.assert_array_equal(found.met, exact.met)
    assert 0.1 < renderer.hit_map.own_rays().mean() < 0.5


def test_a_sphere_that_moves_before_a_resting_camera_leaves_the_exact_map_bit_for_bit(renderer: Renderer) -> None:
    scene, fresh = _ten(), Renderer(renderer.ctx)
    _traced(renderer, scene, progressive=False)
    for time in np.arange(1, 26) * 1.7:
        traces = renderer.hit_map.traces
        renderer.hit_map.trace(_inputs(scene, time))
        assert renderer.hit_map.traces == traces + 1
        assert _same(renderer.hits(), _traced(fresh, scene, progressive=False, time=time)), time
    fresh.release()


def test_it_costs_rays_where_it_is_seen_and_was_seen_alone(renderer: Renderer) -> None:
    """Those of its cells, and of those on the shadow's edge, where images of all there is crowd: a twentieth of this small picture at most."""
    scene = _ten()
    _traced(renderer, scene, progressive=False)
    before = renderer.hit_map.generation
    renderer.hit_map.trace(_inputs(scene, 1.0))
    changed = renderer.hit_map.changed_since(before)
    assert changed is not None and 0 < len(changed) * changed.side**2 < 0.05 * SIZE[0] * SIZE[1]
    assert renderer.hit_map.changed_since(before - 1) is None
    assert not renderer.hit_map.trace(_inputs(scene, 1.0)), "nothing has moved"


def test_a_thing_that_is_changed_by_hand_costs_no_more(renderer: Renderer) -> None:
    scene = _ten()
    _traced(renderer, scene, progressive=False)
    before = renderer.hit_map.generation
    wider = scene.with_values({"things.s4.radius": 0.8, "things.s4.z": 2.0})
    renderer.hit_map.trace(_inputs(wider, 0.0))
    assert renderer.hit_map.changed_since(before) is not None
    assert _same(renderer.hits(), _traced(renderer, wider, progressive=False))
    before = renderer.hit_map.generation
    renderer.hit_map.trace(_inputs(wider.with_values(_sphere("more", 0.3)), 0.0))
    assert renderer.hit_map.changed_since(before) is None, "the hits of all spheres hold their numbers"


def test_a_refined_map_sharpens_while_a_sphere_moves(renderer: Renderer) -> None:
    scene = _ten()
    assert not _same(_traced(renderer, scene, progressive=True), _traced(Renderer(renderer.ctx), scene, progressive=False))
    frames = 0
    while not renderer.hit_map.is_sharp:
        frames += 1
        renderer.hit_map.trace(_inputs(scene, 0.5 * frames), progressive=True)
        assert frames <= 30
    exact = _traced(Renderer(renderer.ctx), scene, progressive=False, time=0.5 * frames)
    assert _same(renderer.hits(), exact)


@pytest.mark.parametrize("passes", [False, True])
def test_the_picture_is_that_of_a_fresh_map(renderer: Renderer, passes: bool) -> None:
    """Sky, sorting of the pixels and rays at edges are made anew in the changed squares alone; nothing stale is left, and no square is seen."""
    scene, fresh = _ten(**{"rays.edges": 2}), Renderer(renderer.ctx)
    renderer.hit_map.forget()
    for time in np.arange(0, 12) * 2.3:
        renderer.render(scene, time, SIZE, glow_may_last=passes)
        fresh.hit_map.forget()
        fresh.render(scene, time, SIZE, glow_may_last=passes)
        np.testing.assert_array_equal(renderer.radiance(), fresh.radiance())
    fresh.release()


def test_pixels_at_edges_have_fewer_rays_while_a_thing_moves(renderer: Renderer) -> None:
    """In frames that the next one replaces; a picture that stays, and one in which time runs and nothing moves, have all of them."""
    moves = _ten(**{"rays.edges": 4})
    rests = moves.with_values({"things.s0.path": "fixed", "things.s0.x": 7.0})
    renderer.render(moves, 0.0, SIZE)
    rays = []
    for scene, time, passes in ((moves, 1.0, True), (moves, 2.0, True), (moves, 2.0, False), (moves, 3.0, False), (rests, 3.0, False), (rests, 4.0, True)):
        renderer.render(scene, time, SIZE, glow_may_last=passes)
        rays.append(renderer.edges.rays_a_pixel)
    assert rays == [4, 4, 16, 16, 16, 16]


def test_rays_at_edges_beside_no_thing_need_not_look_for_any(renderer: Renderer, monkeypatch: pytest.MonkeyPatch) -> None:
    """What they would meet is an image thinner than a pixel, within a pixel of none that is seen: that changes few pixels under a moving camera.

    At 1280×720 0.3 to 0.6 % of the pixels at edges differ by a hundredth of their light; most of them at the shadow's edge, where images crowd.
    """
    all_look, scene = Renderer(renderer.ctx), _ten(**{"rays.edges": 2})
    told, different, edges = Edges.beside_things, 0, 0
    renderer.hit_map.forget()
    for turn in range(0, 100, 10):
        view, pictures = scene.with_values({"camera.azimuth_deg": 3.6 * turn, "camera.inclination_deg": 60.0 + 0.3 * turn}), []
        for drawn_by, rule in ((renderer, told), (all_look, lambda found: np.ones(len(found.pixels), bool))):
            monkeypatch.setattr(Edges, "beside_things", rule)
            drawn_by.render(view, 0.0, SIZE, progressive=True)
            pictures.append(drawn_by.radiance())
        difference, light = np.abs(pictures[0] - pictures[1]).max(axis=-1), np.maximum(*pictures).max(axis=-1)
        different += np.count_nonzero(difference > 0.01 * light)
        edges += len(renderer.edges.pixels)
    all_look.release()
    assert 0 < different < 0.01 * edges


def test_what_was_seen_before_leaves_no_edges_in_the_next_view(renderer: Renderer) -> None:
    """Cells that show no thing have none written: what the map held there before, of another view, is not looked at."""
    scene, fresh = _ten(**{"rays.edges": 2}), Renderer(renderer.ctx)
    turned = scene.with_values({"camera.azimuth_deg": 30.0})
    renderer.hit_map.forget()
    renderer.render(scene, 0.0, SIZE)
    for drawn_by in (renderer, fresh):
        drawn_by.render(turned, 0.0, SIZE, progressive=True)
    np.testing.assert_array_equal(renderer.edges.pixels, fresh.edges.pixels)
    fresh.release()


MOON = _sphere("moon", 0.5)


@pytest.mark.parametrize("values", [{"things.ring.kind": "annulus"}, {"camera.distance": math.inf, **MOON}, {"rays.step_control": "doubling", **MOON}])
def test_what_is_not_bound_to_a_place_is_traced_whole(renderer: Renderer, values: dict) -> None:
    """A ring about the hole may be seen anywhere; parallel rays and steps that find their own lengths tell nothing by their neighbours."""
    made = plan(_scene(**values))
    assert made.reach_steps == 0 and made.refine_px == 0.0


def _edge_blocks(pixels: np.ndarray, seeking: bool | list[bool] = True) -> EdgeBlocks:
    return EdgeBlocks.of(pixels, np.full(len(pixels), seeking) if isinstance(seeking, bool) else np.array(seeking))


def test_blocks_at_edges_that_stand_keep_their_places_and_freed_ones_are_used() -> None:
    size = (64, 64)
    before = _edge_blocks(np.array([[1, 1], [9, 1], [20, 20], [40, 3]]))
    changed = Squares.of(np.array([[1, 0], [5, 0]]), 8, size)
    found = before.after(np.array([[1, 1], [10, 1], [21, 20], [20, 20]]), np.ones(4, bool), changed, size)
    assert found is not None
    after, fresh = found
    assert after.numbers[0] == before.numbers[0] and after.numbers[3] == before.numbers[2], "outside the squares, and there before"
    assert len(set(after.numbers)) == 4 and fresh.tolist() == [False, True, True, False]
    assert before.numbers[1] in after.numbers, "its pixel is at no edge now"
    columns, rows = after.places.T
    np.testing.assert_array_equal(after.shifts[rows, columns] + after.places, after.pixels)
    room = int(np.prod(before.size))
    full, one_more = (_edge_blocks(np.stack(np.divmod(np.arange(blocks), 64)[::-1], axis=-1)) for blocks in (room, room + 1))
    assert full.after(one_more.pixels, one_more.seeking, changed, size) is None


def test_a_block_that_looks_for_things_now_and_did_not_is_traced_anew() -> None:
    pixels, nothing_changed = np.array([[1, 1], [9, 1], [20, 20]]), Squares.of(np.empty((0, 2), int), 8, (64, 64))
    found = _edge_blocks(pixels, [True, False, False]).after(pixels, np.array([False, True, False]), nothing_changed, (64, 64))
    assert found is not None and found[1].tolist() == [True, True, False]


@pytest.mark.parametrize("side", [2, 4])
def test_no_square_of_one_kind_holds_a_block_of_the_other(side: int) -> None:
    """Rays that look for no things would be drawn over those that do."""
    rng = np.random.default_rng(4)
    pixels = np.stack(np.divmod(np.arange(900), 64)[::-1], axis=-1)
    seeking = rng.random(900) < 0.5
    in_a_row, rows = _edge_blocks(pixels).size
    blocks = EdgeBlocks(pixels, rng.permutation(in_a_row * rows)[:900], rows, seeking)
    picked = rng.random(900) < 0.7
    fresh, size = blocks.fresh(picked, side, all_new=False), (side * in_a_row, side * rows)
    rays = side * blocks.places
    for squares, kind in ((fresh.seeking, seeking), (fresh.others, ~seeking)):
        drawn = np.any([some.holds(rays, size) for some in squares if len(some)], axis=0)
        assert np.all(drawn[picked & kind]) and not np.any(drawn & ~kind)
    assert fresh.changed is not None and np.all(fresh.changed.holds(rays[picked], size))


@pytest.mark.parametrize("blocks", [1, 512, 700, 1024, 5000])
def test_the_map_of_blocks_has_room_and_no_side_that_is_a_power_of_two(blocks: int) -> None:
    """llvmpipe finishes each program anew for textures whose size is one: the first picture with things stood still for a second."""
    made = _edge_blocks(np.stack(np.divmod(np.arange(blocks), 128)[::-1], axis=-1))
    assert made.size[0] * made.size[1] >= blocks and all(side.bit_count() > 1 for side in made.size)


def test_small_blocks_are_drawn_four_at_a_time_where_they_lie_together() -> None:
    """A software renderer shades 4×4 pixels whichever of them are asked for: blocks of 2×2 rays, each drawn alone, took nearly twice the time."""
    blocks = _edge_blocks(np.stack(np.divmod(np.arange(300), 64)[::-1], axis=-1))
    assert len({tuple(place) for place in blocks.places}) == 300 and np.all(blocks.places < blocks.size)
    picked = (np.arange(300) >= 40) & (np.arange(300) < 80)
    assert [(some.side, len(some)) for some in blocks.fresh(picked, 2, all_new=False).seeking] == [(4, 10), (2, 0)]
    assert [(some.side, len(some)) for some in blocks.fresh(picked, 4, all_new=False).seeking] == [(4, 40), (4, 0)]
    assert not any(len(some) for some in blocks.fresh(picked & False, 2, all_new=False).seeking)


def test_a_map_of_few_blocks_is_not_traced_whole() -> None:
    """A picture with forty pixels at edges had 720 blocks of rays."""
    pixels = np.stack(np.divmod(np.arange(700), 64)[::-1], axis=-1)
    few, most = (_edge_blocks(pixels[:count]).fresh(np.ones(count, bool), 2, all_new=True) for count in (40, 700))
    assert most.whole and not few.whole and few.changed is None and sum(len(some) for some in few.seeking) == 10 and not any(map(len, few.others))


def test_many_balls_are_gathered_into_few_that_hold_them() -> None:
    rng = np.random.default_rng(1)
    balls = np.column_stack([rng.normal(0.0, 8.0, (1000, 3)), rng.uniform(0.01, 0.5, 1000)])
    few = reach.gathered(balls, reach.MOST_BALLS)
    assert len(few) == reach.MOST_BALLS
    apart = np.linalg.norm(balls[:, None, :3] - few[None, :, :3], axis=-1) + balls[:, None, 3] - few[None, :, 3]
    assert np.all(apart.min(axis=1) < 1e-9)
    assert np.median(few[:, 3]) < 0.5 * reach.gathered(balls, 1)[0, 3], "not each of them the whole"
    np.testing.assert_array_equal(reach.gathered(balls[:5], 24), balls[:5])
