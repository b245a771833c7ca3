"""Observers that move: their frames against the twins', aberration and shift against closed forms, and what is refused."""

from __future__ import annotations

import math

import numpy as np
import pytest

from blackhole_gl.physics import observer, polarization, relativity
from blackhole_gl.planning import plan
from blackhole_gl.reference import observers as twin
from blackhole_gl.scene import Scene, SceneError

# observer, spin, distance in r_s, inclination, velocity (r, θ, φ)
CAMERAS = [
    ("static", 0.9, 3.0, 70.0, (0.3, -0.5, 0.6)),
    ("static", 0.9, 0.9, 80.0, (0.0, 0.7, 0.0)),
    ("zamo", -0.9, 1.2, 40.0, (-0.9, 0.0, 0.1)),
    ("circular", 0.9, 2.0, 90.0, (0.0, 0.0, 0.0)),
    ("circular", -0.7, 6.0, 90.0, (0.2, 0.2, 0.2)),
    ("circular", 0.0, 2.5, 50.0, (0.0, 0.0, 0.0)),
    ("rain", 0.0, 1.001, 80.0, (0.0, 0.0, 0.0)),
    ("rain", 0.998, 0.8, 30.0, (0.5, -0.5, 0.3)),
    ("fall", 0.0, 4.0, 80.0, (0.0, 0.0, 0.0)),
    ("rain", 0.9, 0.5, 60.0, (0.0, 0.0, 0.0)),
    ("rain", 0.0, 0.1, 80.0, (0.3, 0.2, -0.4)),
    ("fall", 0.0, 0.3, 80.0, (0.0, 0.0, 0.0)),
    ("fall", 0.0, 25.0, 80.0, (0.0, 0.3, -0.4)),
]


def _is_outside(camera: tuple) -> bool:
    return camera[2] > float(relativity.horizon_radius(camera[1]))


def scene_of(kind: str = "static", velocity: tuple[float, float, float] = (0.0, 0.0, 0.0), **values: object) -> Scene:
    radial, down, around = velocity
    moving = {"camera.observer": kind, "camera.velocity_forward": -radial, "camera.velocity_up": -down, "camera.velocity_right": around}
    return Scene().with_values({"rays.model": "kerr", **moving, **{key.replace("__", "."): value for key, value in values.items()}})


def seen_by(camera: tuple, **values: object) -> observer.Observer:
    kind, spin, distance, inclination, velocity = camera
    return observer.observe(scene_of(kind, velocity, hole__spin=spin, camera__distance=distance, camera__inclination_deg=inclination, **values))


def directions(count: int = 100) -> np.ndarray:
    local = np.random.default_rng(3).normal(size=(count, 3))
    return local / np.linalg.norm(local, axis=1, keepdims=True)


@pytest.mark.parametrize("camera", CAMERAS, ids=str)
def test_rays_start_with_the_constants_of_the_twin_s_own_frame(camera: tuple) -> None:
    """The twin's axes are Gram and Schmidt's from a four-velocity, in Carter's null frame; only rounding is between them."""
    kind, spin, distance, inclination, velocity = camera
    seen, local = seen_by(camera), directions()
    rows = np.column_stack([np.ones(len(local)), local]) @ seen.observer_map.T
    place = twin.Place.from_degrees(2.0 * distance, inclination, 0.0)
    found = twin.momenta(local, place, -spin, "zamo" if seen.kind == "zamo" else kind, velocity, 60.0)
    expected = np.stack([found.energy, -found.radial_rate / place.r**2, found.p_theta, found.l_over_sin], axis=-1)
    assert np.abs(rows - expected).max() < 1e-12 * np.abs(expected).max()


@pytest.mark.parametrize("beta", [-0.9, 0.5, 0.9])
def test_flat_space_has_aberration_and_doppler_s_shift(beta: float) -> None:
    """cos θ' = (cos θ + β)/(1 + β cos θ) and D = γ(1 + β cos θ), θ from the motion for who is at rest."""
    seen = observer.observe(scene_of(velocity=(0.0, 0.0, beta), rays__model="flat"))
    moving = directions()
    at_rest = twin.at_rest(moving, (0.0, 0.0, beta))
    np.testing.assert_allclose(moving[:, 2], (at_rest[:, 2] + beta) / (1.0 + beta * at_rest[:, 2]), atol=1e-13)
    np.testing.assert_allclose(1.0 / seen.energies(moving), (1.0 + beta * at_rest[:, 2]) / math.sqrt(1.0 - beta**2), rtol=1e-13)
    rows = np.column_stack([np.ones(len(moving)), moving]) @ seen.tetrad.T
    np.testing.assert_allclose(-rows[:, 1] / rows[:, 0], at_rest[:, 0], atol=1e-13)


def test_who_circles_sees_the_star_ahead_shifted_by_closed_form() -> None:
    """At r = 5 r_s the speed is √(M/(r − 2M)) = 1/√8: γ(1 + β)/√(1 − 1/r) straight ahead, (1 + β)/(1 − β) times as much as straight behind."""
    seen = seen_by(("circular", 0.0, 5.0, 90.0, (0.0, 0.0, 0.0)))
    beta = 1.0 / math.sqrt(8.0)
    ahead, behind = 1.0 / seen.energies(np.array([[0.0, 0.0, 1.0], [0.0, 0.0, -1.0]]))
    assert ahead == pytest.approx(math.sqrt((1.0 + beta) / (1.0 - beta)) / math.sqrt(0.8), rel=1e-14)
    assert ahead / behind == pytest.approx((1.0 + beta) / (1.0 - beta), rel=1e-14)


def test_who_fell_from_far_away_sees_what_rain_sees() -> None:
    rain, fall = (seen_by((kind, 0.0, 3.0, 60.0, (0.0, 0.0, 0.0)), camera__fall_from=1e4) for kind in ("rain", "fall"))
    np.testing.assert_allclose(fall.observer_map, rain.observer_map, rtol=3e-4, atol=3e-4)
    at_rest = seen_by(("fall", 0.0, 3.0, 60.0, (0.0, 0.0, 0.0)), camera__fall_from=3.0)
    np.testing.assert_allclose(at_rest.observer_map, seen_by(("static", 0.0, 3.0, 60.0, (0.0, 0.0, 0.0))).observer_map, atol=1e-15)


@pytest.mark.parametrize("camera", [camera for camera in CAMERAS if _is_outside(camera)], ids=str)
def test_the_hole_is_where_straight_inwards_is_seen(camera: tuple) -> None:
    seen = seen_by(camera)
    assert np.linalg.norm(seen.hole) == pytest.approx(1.0)
    still = observer.observe(scene_of(hole__spin=camera[1], camera__distance=camera[2], camera__inclination_deg=camera[3], camera__observer=_at_rest(camera)))
    inwards = still.tetrad @ np.array([1.0, -1.0, 0.0, 0.0])
    found = seen.tetrad @ np.array([1.0, *seen.hole])
    np.testing.assert_allclose(found / found[0], inwards / inwards[0], rtol=1e-9, atol=1e-9)


def _at_rest(camera: tuple) -> str:
    return "zamo" if camera[0] == "zamo" else "static"


def test_a_switch_takes_its_part_of_the_motion_away() -> None:
    """D is what the moving frame adds to the frame at rest: without it colours, or brightness, are those that who is at rest sees there."""
    camera, local = CAMERAS[0], directions()
    on = seen_by(camera)
    still = observer.observe(scene_of(hole__spin=0.9, camera__distance=3.0, camera__inclination_deg=70.0))
    there = twin.at_rest(local, camera[4])
    without = seen_by(camera, camera__doppler_colour=False)
    np.testing.assert_allclose(without.energies(local), still.energies(there), rtol=1e-12)
    np.testing.assert_array_equal(without.observer_map, on.observer_map)
    np.testing.assert_array_equal(without.beaming, on.beaming)
    np.testing.assert_allclose(seen_by(camera, camera__beaming=False).beaming, without.colour)
    unmoved = seen_by(camera, camera__aberration=False)
    np.testing.assert_allclose(unmoved.observer_map, still.observer_map, atol=1e-14)
    np.testing.assert_allclose(unmoved.energies(there), on.energies(local), rtol=1e-12)


@pytest.mark.parametrize("camera", [camera for camera in CAMERAS if camera[0] != "fall" and _is_outside(camera)], ids=str)
def test_polarization_is_carried_into_the_moving_frame_as_a_vector(camera: tuple) -> None:
    """The vector that a ZAMO sees, by Lorentz's transformation, less a multiple of the light's own."""
    kind, spin, distance, inclination, velocity = camera
    seen = seen_by(camera)
    zamo = observer.observe(scene_of("zamo", hole__spin=spin, camera__distance=distance, camera__inclination_deg=inclination))
    local = directions(20)
    rows = np.column_stack([np.ones(len(local)), local]) @ seen.zamo.T
    there, constant = rows[:, 1:] / rows[:, :1], np.exp(1j * np.linspace(0.0, 6.0, len(local)))
    arrived = polarization.arriving(zamo, there, constant)
    back = np.linalg.inv(seen.zamo) * np.outer([1.0, -1.0, -1.0, -1.0], [1.0, -1.0, -1.0, -1.0])  # of vectors, which light moves along
    moved = np.column_stack([np.zeros(len(local)), arrived]) @ back.T
    vector = moved[:, 1:] - moved[:, :1] * -local
    np.testing.assert_allclose(np.abs(np.sum(vector * polarization.arriving(seen, local, constant), axis=-1)), 1.0, atol=1e-9)


REFUSED = [
    (scene_of(velocity=(-0.8, 0.0, 0.7)), "camera.velocity_forward: got 0.8, with the other two a speed of 1.063 c; allowed is a speed below 1 c"),
    (scene_of("circular", camera__distance=1.5), "camera.observer: got circular at 1.5 r_s; allowed is outside the photon orbit at 1.5 r_s"),
    (scene_of("circular", hole__spin=0.5), "camera.observer: got circular at an inclination of 80°.*allowed is 90°"),
    (scene_of("fall", hole__spin=0.5), "camera.observer: got fall.*allowed there is rain"),
    (scene_of("fall", camera__fall_from=10.0), "camera.fall_from: got 10 r_s for a camera at 20 r_s.*allowed is at least camera.distance"),
    (scene_of(camera__distance=0.9), "camera.distance: got 0.9 r_s; at spin 0 the horizon is at 1 r_s and the camera must be outside it: nothing rests"),
    (scene_of("circular", camera__distance=0.9), "camera.distance: got 0.9 r_s.*where only rain and fall are"),
    (scene_of("rain", camera__distance=0.9, rays__model="schwarzschild"), "camera.distance: got 0.9 r_s.*does not lead through it.*kerr and auto"),
    (scene_of("rain", camera__distance=0.28, hole__spin=0.9), "camera.distance: got 0.28 r_s.*followed down to 0.287696 r_s"),
    (scene_of("rain", camera__distance=0.5, camera__beaming=False), "camera.beaming: got false; inside the horizon.*allowed is true"),
    (scene_of("rain", rays__lensing=False), "camera.observer: got rain; in flat space.*allowed are static and zamo"),
    (scene_of("circular", rays__model="post_newtonian"), "camera.observer: got circular; in flat space"),
    (scene_of(velocity=(0.0, 0.0, 0.1), camera__distance=math.inf), "camera.velocity_right: got 0.1; a camera at infinity has parallel rays"),
    (scene_of("fall", camera__distance=math.inf), "camera.observer: got fall for a camera at infinity"),
]


@pytest.mark.parametrize("scene, text", REFUSED, ids=[text[:40] for _, text in REFUSED])
def test_an_observer_that_cannot_be_is_refused_with_a_sentence(scene: Scene, text: str) -> None:
    with pytest.raises(SceneError, match=text):
        observer.observe(scene)


def test_the_thin_lens_far_away_is_for_cameras_at_rest() -> None:
    values = {"rays.model": "auto", "disk.enabled": False, "camera.distance": 5000.0}
    assert plan(scene_of().with_values(values)).model.key == "screen_lens"
    assert plan(scene_of(velocity=(0.0, 0.0, 0.5)).with_values(values)).model.key != "screen_lens"


def test_things_are_not_met_from_inside_and_a_sentence_says_so() -> None:
    with pytest.raises(SceneError, match="camera.distance: got 0.5 r_s, inside the horizon.*allowed is outside"):
        plan(scene_of("rain", camera__distance=0.5).with_values({"things.moon.kind": "sphere"}))


def test_the_plan_takes_the_model_that_leads_through_the_horizon() -> None:
    made = plan(scene_of("rain", camera__distance=0.5).with_values({"rays.model": "auto"}))
    assert made.model.key == "kerr" and made.is_inside
    assert "from inside the horizon: the model that leads through it" in " ".join(made.reasons)


def test_a_fall_is_followed_to_near_the_centre_or_the_inner_horizon() -> None:
    assert observer.least_distance(scene_of("rain")) == 0.1
    assert observer.least_distance(scene_of("rain", hole__spin=0.9)) == pytest.approx(1.02 * float(relativity.inner_horizon_radius(0.9)))
    assert observer.least_distance(scene_of("static", hole__spin=0.9)) == float(relativity.horizon_radius(0.9))
    assert observer.least_distance(scene_of("rain", rays__model="schwarzschild_table")) == 1.0
