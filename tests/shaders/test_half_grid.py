"""Rays at every second pixel under a moving camera, where the coarse grid is too coarse: what lies between them is seen where an exact map has it."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest

from blackhole_gl.planning import plan, steps_in_motion
from blackhole_gl.rendering.frame import Renderer
from blackhole_gl.rendering.frame_met import FrameMet
from blackhole_gl.rendering.half_grid import HalfGrid, narrow_balls
from blackhole_gl.rendering.hit_texels import HitArrays
from blackhole_gl.rendering.inputs import FrameInputs
from blackhole_gl.rendering.packed_rays import PackedRays
from blackhole_gl.rendering.refinement import tolerances
from blackhole_gl.scene import Scene, presets
from tests.shaders.test_meshes import globe

SIZE = (320, 180)


def _inputs(scene: Scene) -> FrameInputs:
    return FrameInputs.whole(plan(scene), 0.0, SIZE)


def _traced(renderer: Renderer, scene: Scene, *, progressive: bool) -> HitArrays:
    renderer.hit_map.forget()
    renderer.hit_map.trace(_inputs(scene), progressive=progressive)
    return renderer.hits()


def _displacement(values: np.ndarray, error: np.ndarray) -> np.ndarray:
    """By how many pixels an `error` of `values` (height, width, 3) moves what is seen: what of it lies along their change, by that change."""
    up, right = np.gradient(values.astype(float), axis=(0, 1))
    xx, xy, yy = (np.sum(a * b, axis=-1) for a, b in ((right, right), (right, up), (up, up)))
    along = np.stack([np.sum(right * error, axis=-1), np.sum(up * error, axis=-1)], axis=-1)
    moved = np.stack([yy * along[..., 0] - xy * along[..., 1], xx * along[..., 1] - xy * along[..., 0]], axis=-1)
    return np.linalg.norm(moved, axis=-1) / np.maximum(xx * yy - xy * xy, 1e-30)


KNOT = {"camera.fov_deg": 43.0}  # larger than in the shipped scene

# Shells that are thinner and more ragged than those of the shipped scenes, so that more rays lie between folds.
EXPLOSION = {"rays.refraction.width": 1.0, "rays.refraction.grain": 3.0}
SHOCK_WAVE = {
    **{"rays.refraction.size": 5.0, "rays.refraction.strength": 0.35, "rays.refraction.width": 1.0, "rays.refraction.grain": 4.0},
    **{"rays.integrator": "nystrom4", "rays.step_control": "radius", "rays.step_length": 0.3},
}


def test_most_of_an_explosion_is_interpolated_and_displaced_by_less_than_the_tolerance(renderer: Renderer) -> None:
    """By the coarse grid alone three fifths of a picture this small have rays of their own."""
    scene = presets.load(["explosion"], {**EXPLOSION, "rays.edges": 1})
    exact, found = _traced(renderer, scene, progressive=False), _traced(renderer, scene, progressive=True)
    own = renderer.hit_map.own_rays()
    assert 0.02 < own.mean() < 0.19  # 0.186 and more by cubics alone
    error = found.direction - exact.direction
    pixel = np.radians(scene.camera.fov_deg) / SIZE[1]
    moved = np.minimum(np.linalg.norm(error, axis=-1) / pixel, _displacement(exact.direction, error))
    print(f"{own.mean():.3f} have rays of their own; displaced by {np.quantile(moved, 0.99):.3f} px at 99 %")
    assert np.quantile(moved, 0.99) <= scene.rays.tolerance
    np.testing.assert_array_equal(found.fate, exact.fate)
    assert np.quantile(moved[own], 0.99) <= scene.rays.tolerance  # of longer steps alone


def test_cells_along_lines_ask_for_no_such_rays(renderer: Renderer) -> None:
    """The outlines of a few balls cost a frame 12 of 59 ms so: rays and cells about them are more than those they spare."""
    half, nothing = HalfGrid(renderer.ctx, renderer.programs), np.zeros((45, 80), bool)
    line, block = nothing.copy(), nothing.copy()
    line[20:22], block[10:30, 10:30] = True, True
    inputs = _inputs(presets.load(["objects_lorenz"]))
    assert not half.choose(inputs, 3, nothing, line) and half.choose(inputs, 3, nothing, block)
    half.release()


def test_balls_behind_a_shock_wave_are_where_they_are_and_fewer_pixels_have_rays_of_their_own(renderer: Renderer) -> None:
    scene = presets.load(["objects_refraction"], {**SHOCK_WAVE, "rays.edges": 1})
    exact, found = _traced(renderer, scene, progressive=False), _traced(renderer, scene, progressive=True)
    np.testing.assert_array_equal(found.met, exact.met)
    assert renderer.hit_map.own_rays().mean() < 0.19  # 0.41 by the coarse grid alone, 0.2 and more by four in a row


def test_balls_behind_the_shipped_shock_wave_are_where_they_are(renderer: Renderer) -> None:
    scene = presets.load(["objects_refraction"], {"rays.edges": 1})
    exact, found = _traced(renderer, scene, progressive=False), _traced(renderer, scene, progressive=True)
    np.testing.assert_array_equal(found.met, exact.met)
    assert renderer.hit_map.own_rays().mean() < 0.19


def test_things_of_which_there_are_more_than_bits_are_where_they_are(renderer: Renderer) -> None:
    """A lot of small balls in an explosion, which are not told apart: rays at every second pixel are for what lies beside them."""
    rng, values = np.random.default_rng(7), {**EXPLOSION, "rays.edges": 1}
    for number in range(60):
        place = dict(zip("xyz", map(float, rng.uniform(-1.0, 1.0, 3) + (0.0, 4.0, 0.0))))
        values |= {f"things.small_{number}.{key}": value for key, value in {"kind": "sphere", "radius": 0.1, **place}.items()}
    scene = presets.load(["explosion"], values)
    exact, found = _traced(renderer, scene, progressive=False), _traced(renderer, scene, progressive=True)
    np.testing.assert_array_equal(found.met, exact.met)
    assert 0.001 < (exact.met[..., 0, 0] >= 0).mean() and renderer.hit_map.own_rays().mean() < 0.5


def test_no_place_on_a_mesh_is_interpolated_between_its_near_and_its_far_part(renderer: Renderer) -> None:
    """Outlines may be displaced as everywhere in motion, be it before another strand: what is interpolated lies where one of the nine pixels about has it."""
    scene = presets.load(["knot_behind_a_hole"], {**KNOT, "rays.edges": 1})
    exact, found = _traced(renderer, scene, progressive=False), _traced(renderer, scene, progressive=True)
    own = renderer.hit_map.own_rays()
    both = (exact.met[..., 0, 0] >= 0) & (found.met[..., 0, 0] >= 0)
    assert (both & ~own).mean() > 0.04 and own.mean() < 0.25
    strand = 0.5  # r_s, less than one is thick
    places = np.pad(exact.met_place[..., 0, :], ((1, 1), (1, 1), (0, 0)), mode="edge")
    around = [places[1 + y : 1 + y + SIZE[1], 1 + x : 1 + x + SIZE[0]] for y in (-1, 0, 1) for x in (-1, 0, 1)]
    error = [np.linalg.norm(found.met_place[..., 0, :] - one, axis=-1) for one in around]
    elsewhere, displaced = (np.count_nonzero(off[both & ~own] > strand) for off in (np.min(error, axis=0), error[4]))
    print(f"{own.mean():.3f} have rays of their own; of {np.count_nonzero(both & ~own)} interpolated {elsewhere} are elsewhere, {displaced} beside an outline")
    assert elsewhere == 0 and displaced <= 1e-3 * np.count_nonzero(both & ~own)


def test_steps_are_longer_in_motion_where_a_march_through_a_field_errs_by_less_than_the_picture_s_own_pixels() -> None:
    """The explosion's errs by a quarter of a pixel of 1080 at steps of 0.3; twice as long ones by ten of them at 640×360."""
    made = plan(presets.load(["explosion"], EXPLOSION))
    coarse, fine = steps_in_motion(made, 360), steps_in_motion(made, 1080)
    assert 1.2 < coarse < 1.5 and 1.0 < fine < coarse and steps_in_motion(made, 2160) == fine
    for name, values in (
        ("knot_behind_a_hole", {}),
        ("explosion", {**EXPLOSION, "rays.step_length": 0.7, "rays.integrator": "nystrom5"}),
        ("explosion", {"rays.refraction.size": 4.0}),
    ):
        assert steps_in_motion(plan(presets.load([name], values)), 360) == 1.0, "not measured, or no field"


def test_no_pixel_of_a_moving_mesh_has_a_colour_that_is_not_its_place_s(renderer: Renderer) -> None:
    """Places beside an outline had the colour of the mesh's first triangle: 38 pixels here, violet among green."""
    scene = presets.load(["knot_behind_a_hole"], {**KNOT, "rays.edges": 1, "post.bloom": False, "post.dither": False})
    pictures, shown = [], []
    for progressive in (False, True):
        renderer.hit_map.forget()
        renderer.render(scene, 0.0, SIZE, progressive=progressive)
        pictures.append(renderer.read_rgb8().astype(int))
        shown.append(renderer.hits().met[..., 0, 0][::-1] >= 0)
    exact, found = pictures
    nearby = np.pad(exact, ((1, 1), (1, 1), (0, 0)), mode="edge")
    around = [nearby[1 + y : 1 + y + SIZE[1], 1 + x : 1 + x + SIZE[0]] for y in (-1, 0, 1) for x in (-1, 0, 1)]
    off = np.min([np.abs(found - one).max(axis=-1) for one in around], axis=0)[shown[0] & shown[1]]
    print(f"{np.count_nonzero(off > 40)} of {off.size} pixels like none of the nine about them")
    assert np.count_nonzero(off > 40) <= 2e-4 * off.size


def test_what_a_moving_ray_meets_of_a_mesh_lies_no_farther_from_its_way_than_outlines_may(renderer: Renderer) -> None:
    """A piece of a way may stray by 0.8 of half a pixel, at its straight distance from the camera; a triangle is met on the piece itself."""
    scene = presets.load(["knot_behind_a_hole"], {**KNOT, "rays.edges": 1})
    exact, found = _traced(renderer, scene, progressive=False), _traced(renderer, scene, progressive=True)
    both = (exact.met[..., 0, 0] >= 0) & (found.met[..., 0, 0] >= 0) & renderer.hit_map.own_rays()
    place, rates = exact.met_place[both][..., 0, :].astype(float), exact.met_rates[both][..., 0, :].astype(float)
    radius = np.linalg.norm(place, axis=-1, keepdims=True)
    along = 0.5 / radius * rates[:, :3] - rates[:, 3:] * place / radius
    along /= np.linalg.norm(along, axis=-1, keepdims=True)
    error = found.met_place[both][..., 0, :] - place
    beside = np.linalg.norm(error - np.sum(error * along, axis=-1, keepdims=True) * along, axis=-1)
    inclination = np.radians(scene.camera.inclination_deg)
    camera = scene.camera.distance * np.array([np.sin(inclination), 0.0, np.cos(inclination)])
    pixels = beside / (np.radians(scene.camera.fov_deg) / SIZE[1] * np.linalg.norm(place - camera, axis=-1))
    print(f"{np.quantile(pixels, 0.5):.3f} px beside the way in the middle, {np.quantile(pixels, 0.99):.3f} at 99 %")
    assert both.mean() > 0.03 and 0.0 < np.quantile(pixels, 0.99) <= 0.8 * scene.rays.tolerance


@pytest.mark.parametrize(("around", "along"), [(5, 4), (12, 8), (60, 30)])
def test_no_ray_goes_through_a_moving_mesh_of_few_or_of_many_triangles(renderer: Renderer, tmp_path: Path, around: int, along: int) -> None:
    """A way is held against small ones as it bends, against large ones in straight pieces: where an exact map has a globe's near side, none has its far one."""
    values = {"things.knot.file": str(globe(tmp_path / "globe.obj", around, along)), "things.knot.size": 4.0, "rays.edges": 1}
    scene = presets.load(["knot_behind_a_hole"], values, any_file=True)
    exact, found = _traced(renderer, scene, progressive=False), _traced(renderer, scene, progressive=True)
    shown = [hits.met[..., 0, 0] >= 0 for hits in (exact, found)]
    within = np.pad(shown[0], 1)
    whole = np.min([within[1 + y : 1 + y + SIZE[1], 1 + x : 1 + x + SIZE[0]] for y in (-1, 0, 1) for x in (-1, 0, 1)], axis=0)
    off = np.linalg.norm(found.met_place[..., 0, :] - exact.met_place[..., 0, :], axis=-1)[whole]
    assert whole.sum() > 2000 and np.all(shown[1][whole])
    assert np.quantile(off, 0.999) < 0.4 and (shown[0] != shown[1]).sum() < 0.01 * whole.sum()


def test_rays_at_edges_may_stray_by_no_more_than_those_of_their_picture() -> None:
    """They are drawn in a map of their own, which is lower: eighteen times as far was allowed."""
    inputs = _inputs(presets.load(["knot_behind_a_hole"]))
    assert tolerances(inputs.drawn_as((64, 10))) == tolerances(inputs)


def _texel_of(number: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """Where shaders/refine_half_put.frag looks for rays of that number: column and row."""
    block, within = np.divmod(number, 16)
    row, column = np.divmod(block, 63)
    return 4 * column + within % 4, 4 * row + within // 4


def test_rays_that_are_packed_are_those_of_their_pixels(renderer: Renderer) -> None:
    """Four of each cell, but for the first where that is known; as many again, and fewer, as the map has had."""
    rng, size = np.random.default_rng(3), (131, 90)
    packed = PackedRays(renderer.ctx, size, 3)
    for share in (0.02, 0.6, 0.1, 0.0):
        cells, known = rng.random(size[::-1]) < share, rng.random(size[::-1]) < 0.5
        assert packed.choose(cells, known) == 4 * np.count_nonzero(cells) - np.count_nonzero(cells & known)
        shifts = packed.blocks.shifts
        places = np.frombuffer(shifts.read(), np.float32).reshape(shifts.height, shifts.width, 2)
        numbers = np.frombuffer(packed.numbers.read(alignment=1), np.float32).reshape(size[::-1]).astype(int)
        rows, columns = np.nonzero(cells)
        for part in range(4):
            first = numbers[rows, columns]
            np.testing.assert_array_equal(first < 0, known[rows, columns])
            traced = (first >= 0) | (part > 0)
            x, y = _texel_of(np.where(first < 0, part - 2 - first, first + part)[traced])
            np.testing.assert_array_equal(places[y, x] + np.stack([x, y], axis=-1), np.stack([2 * columns + part % 2, 2 * rows + part // 2], axis=-1)[traced])
    packed.release()


@pytest.mark.parametrize(("name", "values"), [("explosion", EXPLOSION), ("knot_behind_a_hole", KNOT)])
def test_at_rest_every_pixel_is_the_exact_map_s(renderer: Renderer, name: str, values: dict) -> None:
    scene = presets.load([name], {**values, "rays.edges": 1})
    exact = _traced(renderer, scene, progressive=False)
    _traced(renderer, scene, progressive=True)
    shares = []
    while not renderer.hit_map.is_sharp:
        renderer.hit_map.trace(_inputs(scene), progressive=True)
        shares.append(renderer.hit_map.own_rays().mean())
    assert len(shares) == 12 and all(before < after for before, after in zip(shares, shares[1:]))
    sharp = renderer.hits()
    np.testing.assert_array_equal(sharp.direction, exact.direction)
    if exact.met is not None:
        np.testing.assert_array_equal(sharp.met_place, exact.met_place)


def test_what_may_be_seen_narrower_than_two_pixels_is_told(renderer: Renderer) -> None:
    """A ball of 0.1 r_s 14 r_s away is 2.6 pixels wide here; a ring has no inside, however large its ball is."""
    things = {"things.small.kind": "sphere", "things.small.radius": 0.1, "things.wide.kind": "sphere", "things.wide.radius": 1.0, "things.ring.kind": "annulus"}
    inputs = _inputs(presets.load(["objects_refraction"], things))
    met = FrameMet.of(inputs)
    seen = [name for name, ball in zip(inputs.plan.scene.things, met.balls) if ball[3] > 0.0]
    narrow = narrow_balls(inputs, met.balls, met.bodies)
    assert [name for bit, name in enumerate(seen) if narrow >> bit & 1] == ["small", "ring"]
