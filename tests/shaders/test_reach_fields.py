"""Things in fields under a moving camera: none is lost, and what is interpolated on a ball that fills a cell is where its ray would meet it."""

from __future__ import annotations

import numpy as np
import pytest

from blackhole_gl.planning import plan
from blackhole_gl.rendering.frame import Renderer
from blackhole_gl.rendering.hit_texels import HitArrays
from blackhole_gl.rendering.inputs import FrameInputs
from blackhole_gl.scene import Scene, presets

SIZE = (320, 180)
VIEWS = 5
STEPS = {"rays.integrator": "nystrom5", "rays.step_control": "fixed", "rays.step_length": 1.0}
FIELDS = {
    "lorenz": {"rays.model": "lorenz", "rays.lorenz.strength": 2e-3},
    "potential": {"rays.model": "potential", "rays.potential.strength": 0.3, "rays.potential.core": 1.0},
    "fish-eye": {"rays.model": "refraction", "rays.refraction.medium": "fish_eye", "rays.field_radius": 6.0},
}

SHIPPED = ("fish_eye", "crystal_ball", "objects_potential", "objects_roessler", "objects_lorenz", "objects_refraction", "objects_black_hole")
PLACES = {"camera.azimuth_deg": (-180.0, 180.0), "camera.inclination_deg": (40.0, 88.0), "camera.distance": (9.0, 25.0), "camera.fov_deg": (25.0, 80.0)}


def _traced(renderer: Renderer, scene: Scene, *, progressive: bool) -> HitArrays:
    renderer.hit_map.forget()
    renderer.hit_map.trace(FrameInputs.whole(plan(scene), 0.0, SIZE), progressive=progressive)
    return renderer.hits()


def _displacement(exact: HitArrays, found: HitArrays) -> np.ndarray:
    """By how many pixels what is seen is displaced, (height, width): the error along the surface, by how the surface lies in the picture."""
    place, error = exact.met_place[..., 0, :], found.met_place[..., 0, :] - exact.met_place[..., 0, :]
    up, right = np.gradient(place.astype(float), axis=(0, 1))
    xx, xy, yy = (np.sum(a * b, axis=-1) for a, b in ((right, right), (right, up), (up, up)))
    along = np.stack([np.sum(right * error, axis=-1), np.sum(up * error, axis=-1)], axis=-1)
    moved = np.stack([yy * along[..., 0] - xy * along[..., 1], xx * along[..., 1] - xy * along[..., 0]], axis=-1)
    return np.linalg.norm(moved, axis=-1) / np.maximum(xx * yy - xy * xy, 1e-12)


@pytest.mark.parametrize("name", ["objects_lorenz", "objects_potential", "objects_refraction", "fish_eye", "objects_black_hole"])
def test_a_shipped_scene_of_balls_is_interpolated_where_they_are_whole(renderer: Renderer, name: str) -> None:
    scene = presets.load([name], {"rays.edges": 1})
    exact, found = _traced(renderer, scene, progressive=False), _traced(renderer, scene, progressive=True)
    assert not renderer.hit_map.is_sharp
    own = renderer.hit_map.own_rays()
    shown = ~own & (exact.met[..., 0, 0] >= 0)
    assert own.mean() < 0.25 and shown.mean() > 0.2  # of a small picture; half of that at 640×360
    assert np.count_nonzero(np.any(found.met != exact.met, axis=(-2, -1))) == 0
    moved = _displacement(exact, found)[shown]
    print(f"{name}: {own.mean():.2f} have rays of their own; displaced by {np.quantile(moved, 0.99):.3f} px at 99 %, {np.quantile(moved, 0.999):.3f} at 99.9 %")
    assert np.quantile(moved, 0.999) <= scene.rays.tolerance


# Views whose floor four rays miss by little: on ways that bow towards it between two steps, and where what lies between them is folded.
BENT = {"objects_roessler": (102.94, 66.46, 12.9, 43.39), "objects_lorenz": (58.6, 68.96, 12.45, 73.23)}


@pytest.mark.parametrize("name", BENT)
def test_a_floor_that_four_rays_miss_is_seen_between_them(renderer: Renderer, name: str) -> None:
    scene = presets.load([name], {**dict(zip(PLACES, BENT[name])), "rays.edges": 1})
    exact, found = (_traced(renderer, scene, progressive=moving).met for moving in (False, True))
    np.testing.assert_array_equal(found, exact)


@pytest.mark.slow
def test_a_moving_camera_sees_the_shipped_balls_where_an_exact_map_has_them(renderer: Renderer) -> None:
    """Rays that know which balls they may meet cut their ways elsewhere: a pixel in a million lies on the other side of an outline."""
    rng = np.random.default_rng(5)
    wrong = pixels = 0
    for name in SHIPPED:
        for _ in range(6):
            camera = {key: float(rng.uniform(*ends)) for key, ends in PLACES.items()}
            scene = presets.load([name], {**camera, "rays.edges": 1})
            exact, found = (_traced(renderer, scene, progressive=moving).met for moving in (False, True))
            wrong, pixels = wrong + np.count_nonzero(np.any(found != exact, axis=(-2, -1))), pixels + found[..., 0, 0].size
    print(f"{wrong} of {pixels} pixels show something else")
    assert wrong <= 2e-6 * pixels


@pytest.mark.parametrize("field", FIELDS)
def test_no_ball_is_lost_or_displaced_in_a_field(renderer: Renderer, field: str) -> None:
    """Ten balls from half a pixel to a pixel's hundredfold, within the sphere and before and behind it: which pixel shows which is as in the exact map."""
    rng = np.random.default_rng(11)
    wrong = shown = interpolated = 0
    for _ in range(VIEWS):
        things: dict[str, object] = {}
        for k in range(10):
            place, radius = rng.normal(size=3), float(np.exp(rng.uniform(np.log(0.02), np.log(1.2))))
            place *= rng.uniform(0.5, 14.0) / np.linalg.norm(place)
            things |= {f"things.s{k}.kind": "sphere", f"things.s{k}.radius": radius, **{f"things.s{k}.{axis}": float(x) for axis, x in zip("xyz", place)}}
        camera = {"camera.azimuth_deg": rng.uniform(-180.0, 180.0), "camera.inclination_deg": rng.uniform(5.0, 175.0)}
        camera["camera.distance"] = rng.uniform(5.0, 30.0)
        scene = presets.load(["kerr"], {"hole.spin": 0.0, "disk.enabled": False, "rays.edges": 1, **STEPS, **FIELDS[field], **things, **camera})
        exact, found = _traced(renderer, scene, progressive=False), _traced(renderer, scene, progressive=True)
        interpolated += np.count_nonzero(~renderer.hit_map.own_rays()) if not renderer.hit_map.is_sharp else 0
        shown += np.count_nonzero(exact.met[..., 0, 0] >= 0)
        wrong += np.count_nonzero(np.any(found.met != exact.met, axis=(-2, -1)))
    assert shown > 300 * VIEWS and interpolated > 0.3 * VIEWS * SIZE[0] * SIZE[1]
    assert wrong == 0


def test_no_ray_slips_into_a_ball_where_one_piece_of_its_way_joins_the_next(renderer: Renderer) -> None:
    """A camera outside all things sees surfaces from without. Two rays of this picture came out of the floor, 60 r_s farther on."""
    scene = presets.load(["objects_lorenz"], {"rays.edges": 1, **STEPS, "rays.step_length": 1.2, "camera.azimuth_deg": 7.0})
    renderer.hit_map.trace(FrameInputs.whole(plan(scene), 0.0, (640, 360)))
    hits = renderer.hits()
    on_floor = hits.met[..., 0, 0] >= 0
    place, rates = hits.met_place[..., 0, :][on_floor].astype(float), hits.met_rates[..., 0, :][on_floor]
    index = hits.met[..., 0, 1][on_floor]
    radius = np.linalg.norm(place, axis=-1, keepdims=True)
    backwards = 0.5 / radius * rates[:, :3] - rates[:, 3:] * place / radius
    balls = [name for name, thing in scene.things.items() if thing.kind == "sphere"]
    middles = np.array([[scene.get(f"things.{name}.{axis}") for axis in "xyz"] for name in balls])
    outward = np.sum((place - middles[index]) * backwards, axis=-1)
    assert np.count_nonzero(outward > 0.0) == 0
