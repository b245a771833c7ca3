"""A view turned from the hole: its pixels' rays are those of the directions that they look in, refined or not, all the way round."""

from __future__ import annotations

import math

import numpy as np
import pytest

from blackhole_gl.physics import observer
from blackhole_gl.planning import choice
from blackhole_gl.rendering.frame import Renderer
from blackhole_gl.rendering.hit_texels import HitArrays
from blackhole_gl.scene import Scene, SceneError, presets
from studies.displacement import beside_an_edge, displacement_px

SIZE = (320, 180)
SPINS = (0.0, 0.5, 0.9, 0.998)
STRAIGHT_AWAY = (180.0, 0.0)


def _spread(count: int) -> list[tuple[float, float]]:
    """(yaw, pitch) in degrees of `count` directions spread evenly over the sphere (a Fibonacci lattice), straight away from the hole among them."""
    index = np.arange(count - 1) + 0.5
    pitch = np.degrees(np.arcsin(1.0 - 2.0 * index / (count - 1)))
    yaw = np.mod(index * 180.0 * (3.0 - math.sqrt(5.0)), 360.0) - 180.0
    return [STRAIGHT_AWAY, *zip(np.round(yaw, 3).tolist(), np.round(pitch, 3).tolist())]


LOOKS = _spread(20)


@pytest.fixture(autouse=True)
def refined_whether_or_not_it_pays(monkeypatch: pytest.MonkeyPatch) -> None:
    """What the chart measured on some machine is the plan's matter."""
    monkeypatch.setattr(choice, "refinement", lambda scene: None)


def _looking(yaw: float, pitch: float, roll: float = 0.0, **values: float) -> Scene:
    looks = {"camera.yaw_deg": yaw, "camera.pitch_deg": pitch, "camera.roll_deg": roll}
    return presets.load(["kerr"], {**looks, **{key.replace("__", "."): value for key, value in values.items()}})


def _hits(renderer: Renderer, scene: Scene, *, progressive: bool = False) -> HitArrays:
    renderer.hit_map.forget()
    assert renderer.render(scene, 0.0, SIZE, progressive=progressive).traced
    return renderer.hits()


@pytest.mark.parametrize("yaw, pitch, roll", [(20.0, 0.0, 0.0), (0.0, -15.0, 0.0), (0.0, 0.0, 70.0), (33.0, 21.0, -140.0), (*STRAIGHT_AWAY, 10.0)])
def test_a_pixel_s_ray_is_that_of_the_direction_it_looks_in(renderer: Renderer, yaw: float, pitch: float, roll: float) -> None:
    """By hand: the direction is turned about the view's own axes with Rodrigues' formula, one turn after the other, and traced as a listed ray.

    Rounding a direction to float32 moves a ray by 6e-8 rad, and near the hole rays part by a factor of some tens: 5e-6 for 99 % of them.
    """
    scene = _looking(yaw, pitch, roll)
    pixels = np.random.default_rng(4).integers(0, SIZE, (400, 2))
    found = _hits(renderer, scene)
    scale = math.tan(math.radians(0.5 * scene.camera.fov_deg)) / SIZE[1]
    x, y = ((2.0 * (pixels + 0.5) - SIZE) * scale).T
    ahead, up = np.array([-1.0, 0.0, 0.0]), np.array([0.0, -1.0, 0.0])  # in (r, θ, φ)
    right = np.cross(ahead, up)
    assert np.allclose(right, [0.0, 0.0, 1.0]), "(r, θ, φ) is right-handed"
    ahead, up = (_turned(v, right, math.radians(pitch)) for v in (ahead, up))
    ahead, right, up = (_turned(v, np.array([0.0, -1.0, 0.0]), -math.radians(yaw)) for v in (ahead, right, up))
    right, up = (_turned(v, ahead, math.radians(roll)) for v in (right, up))
    local = ahead + x[:, None] * right + y[:, None] * up
    expected, _, _ = renderer.trace_listed(scene, local / np.linalg.norm(local, axis=1, keepdims=True))
    fate, direction = found.fate[pixels[:, 1], pixels[:, 0]], found.direction[pixels[:, 1], pixels[:, 0]]
    assert np.mean(fate != expected.fate) <= 0.005
    both = (fate == 1) & (expected.fate == 1)
    assert both.any()
    assert np.quantile(np.linalg.norm(direction - expected.direction, axis=1)[both], 0.99) < 5e-6


def _turned(vector: np.ndarray, axis: np.ndarray, angle: float) -> np.ndarray:
    return math.cos(angle) * vector + math.sin(angle) * np.cross(axis, vector) + (1.0 - math.cos(angle)) * np.dot(axis, vector) * axis


def _assert_refined_within_tolerance(renderer: Renderer, scene: Scene) -> None:
    exact, found = _hits(renderer, scene), _hits(renderer, scene, progressive=True)
    assert not renderer.hit_map.is_sharp, "nothing was interpolated"
    assert displacement_px(scene, found, exact).max() <= scene.rays.tolerance
    wrong = found.fate != exact.fate
    assert not np.any(wrong & ~beside_an_edge(exact.fate))
    assert np.mean(wrong) <= 1e-4


@pytest.mark.parametrize("look", LOOKS[:4], ids=str)
@pytest.mark.parametrize("spin", (0.0, 0.998))
def test_refined_hits_stay_within_the_tolerance_wherever_one_looks(renderer: Renderer, spin: float, look: tuple[float, float]) -> None:
    _assert_refined_within_tolerance(renderer, _looking(*look, hole__spin=spin, camera__fov_deg=90.0))


@pytest.mark.parametrize("look, values", [((151.37, -39.167), {"hole__spin": 0.998, "camera__distance": 2.5, "camera__fov_deg": 90.0}), ((41.1, 7.0), {})])
def test_what_bends_at_the_edge_of_the_picture_is_judged_as_elsewhere(renderer: Renderer, look: tuple[float, float], values: dict[str, float]) -> None:
    """A corner of a cell there shares its quad with a node outside the picture, whose differences it needs."""
    _assert_refined_within_tolerance(renderer, _looking(*look, **values))


@pytest.mark.slow
@pytest.mark.parametrize("look", LOOKS, ids=str)
@pytest.mark.parametrize("spin", SPINS)
@pytest.mark.parametrize("distance", (2.5, 20.0))
def test_refined_hits_stay_within_the_tolerance_in_twenty_directions(renderer: Renderer, spin: float, distance: float, look: tuple[float, float]) -> None:
    _assert_refined_within_tolerance(renderer, _looking(*look, hole__spin=spin, camera__distance=distance, camera__fov_deg=90.0))


def _turn(renderer: Renderer, step: float) -> float:
    """The largest displacement in pixels of any refined frame of a whole turn, and asserts that nothing in it is worse than the tolerance."""
    worst = 0.0
    for yaw in np.arange(-180.0, 180.0, step):
        scene = _looking(float(np.round(yaw, 6)), 7.0)
        exact, found = _hits(renderer, scene), _hits(renderer, scene, progressive=True)
        worst = max(worst, float(displacement_px(scene, found, exact).max()))
        assert worst <= scene.rays.tolerance, yaw
        assert not np.any((found.fate != exact.fate) & ~beside_an_edge(exact.fate)), yaw
    return worst


def test_a_whole_turn_has_no_jump(renderer: Renderer) -> None:
    _turn(renderer, 20.0)


@pytest.mark.slow
@pytest.mark.timeout(1200)
def test_a_whole_turn_in_tenths_of_a_degree_has_no_jump(renderer: Renderer) -> None:
    """Each frame is within the tolerance of the exact one, which turns as the camera does: so no frame jumps against its neighbours."""
    _turn(renderer, 0.1)


def test_looking_straight_away_there_is_no_hole(renderer: Renderer) -> None:
    hits = _hits(renderer, _looking(*STRAIGHT_AWAY, hole__spin=0.9))
    assert np.all(hits.fate == 1) and np.all(np.isfinite(hits.direction))
    outward = observer.observe(_looking(*STRAIGHT_AWAY)).n
    middle = hits.direction[SIZE[1] // 2, SIZE[0] // 2]
    assert np.dot(middle, outward) > math.cos(math.radians(1.0)), "a ray straight away is bent by nothing but the drag"


def test_a_roll_turns_the_picture(renderer: Renderer) -> None:
    """By 180° exactly: the same rays, from the other corner. Rounding of the pixel's place differs: 1e-6 rad, and ten times that beside the hole."""
    plain, turned = _hits(renderer, _looking(0.0, 0.0)), _hits(renderer, _looking(0.0, 0.0, 180.0))
    assert np.mean(plain.fate != turned.fate[::-1, ::-1]) < 1e-4
    assert np.quantile(np.abs(plain.direction - turned.direction[::-1, ::-1]), 0.99) < 1e-5


@pytest.mark.parametrize("name", ["yaw_deg", "pitch_deg"])
def test_parallel_rays_cannot_look_aside(name: str) -> None:
    with pytest.raises(SceneError, match=f"camera.{name}.*parallel"):
        observer.observe(_looking(0.0, 0.0, camera__distance=math.inf).with_values({f"camera.{name}": 5.0}))


def test_the_axes_of_the_view_are_its_own() -> None:
    """Back, down and right of a camera on the x axis that looks 90° to the right: it sees along +y."""
    scene = _looking(90.0, 0.0, camera__inclination_deg=90.0)
    np.testing.assert_allclose(observer.observe(scene).axes, [[0.0, -1.0, 0.0], [0.0, 0.0, -1.0], [1.0, 0.0, 0.0]], atol=1e-15)
