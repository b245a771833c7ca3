"""Light takes its time: how long it is under way, against the float64 twin and closed forms, and what is seen of moving things because of it."""

from __future__ import annotations

import math
from pathlib import Path

import moderngl
import numpy as np
import pytest

from blackhole_gl import listed_rays
from blackhole_gl.measure import light_curve
from blackhole_gl.physics import disk_profile, motion, relativity
from blackhole_gl.physics.shear import RENEWAL_PERIOD, shear_phases
from blackhole_gl.planning import plan
from blackhole_gl.rendering.frame import Renderer
from blackhole_gl.scene import Scene, met, presets
from tests.sampled import sampled
from tests.shaders.harness import Piece
from tests.shaders.sampling import random_rays

DELAY_99 = 1e-4  # r_s/c, as asked of cameras within 100 r_s, of crossings as far out as disks reach; a crossing's own place is as uncertain
DISK = 20.0  # r_s
SHAPIRO = 1e-3  # relative; the next term of the weak field is 4e-4 of it here

# model, a*, inclination in degrees, distance in r_s, observer
SCENES = [
    ("kerr", 0.9, 45.0, 100.0, "static"),
    ("kerr", 0.99, 85.0, 20.0, "zamo"),
    ("kerr", -0.9, 70.0, 4.0, "rain"),
    ("schwarzschild_binet", 0.0, 80.0, 10.0, "static"),
]


@pytest.mark.parametrize("model, spin, inclination, distance, observer", sampled(SCENES, SCENES[1:]))
def test_crossings_are_as_late_as_the_twin_has_them(
    renderer: Renderer, model: str, spin: float, inclination: float, distance: float, observer: str
) -> None:
    changes = {"rays.model": model, "hole.spin": spin, "camera.inclination_deg": inclination, "camera.distance": distance, "camera.observer": observer}
    scene = presets.load(["kerr", "reference"], changes)
    rays = random_rays(scene, 400, seed=20)
    found, twin = listed_rays.trace_by_shader(renderer, scene, rays), listed_rays.trace_by_reference(scene, rays)
    there = np.isfinite(found.crossing_delay) & (twin.crossing_r < DISK)
    assert np.array_equal(np.isfinite(found.crossing_delay), np.isfinite(found.crossing_r))
    error = np.abs(found.crossing_delay - twin.crossing_delay)[there]
    print(f"{model}, a* = {spin:g}, r = {distance:g} r_s: {there.sum()} crossings, median {np.median(error):.1e}, 99 % {np.quantile(error, 0.99):.1e} r_s/c")
    assert there.sum() > 150
    assert np.quantile(error, 0.99) <= DELAY_99


def test_seen_from_infinity_times_are_those_from_far_away_less_the_way_there(renderer: Renderer) -> None:
    """The twin's from infinity against those from r = 5·10³ and 10⁴ r_s, whose difference from it falls as 1/r; and the shader's against the twin's."""
    infinite = presets.load(["kerr", "reference"], {"hole.spin": 0.7, "camera.distance": math.inf, "camera.inclination_deg": 60.0})
    alpha, beta = (values.ravel() for values in np.meshgrid([-10.0, -7.0, 7.0, 11.0], [-8.0, -6.5, 6.0, 9.0]))
    screen = np.stack([alpha, beta], axis=-1)
    late = []
    for distance in (5e3, 1e4):
        angles = np.stack([np.hypot(alpha, beta) / (2.0 * distance) * math.sqrt(1.0 - 1.0 / distance), np.arctan2(beta, alpha)], axis=-1)
        found = listed_rays.trace_by_reference(infinite.with_values({"camera.distance": distance}), angles).crossing_delay[:, 0]
        late.append(found - distance - math.log(distance))
    far = listed_rays.trace_by_reference(infinite, screen).crossing_delay[:, 0]
    assert np.abs(late[1] - far).max() > 1e-3
    assert np.abs(2.0 * late[1] - late[0] - far).max() < 3e-5
    assert np.abs(listed_rays.trace_by_shader(renderer, infinite, screen).crossing_delay[:, 0] - far).max() < DELAY_99


def test_shapiro_s_delay(renderer: Renderer) -> None:
    """d₁ + d₂ + 2M ln((r₁ + d₁)(r₂ + d₂)/r₀²) + M (√((r₁ − r₀)/(r₁ + r₀)) + √((r₂ − r₀)/(r₂ + r₀))), d² = r² − r₀², r₀ the least radius on the way, where
    b² = r₀³/(r₀ − 2M): the logarithm is 2M ln(4 r₁ r₂/b²) for r ≫ b (Shapiro 1964; Weinberg 1972, 8.7)."""
    distance, impact = 1e4, 1e3  # r_s
    nearest = float(np.roots([1.0, 0.0, -(impact**2), impact**2]).real.max())
    changes = {"hole.spin": 0.0, "rays.model": "kerr", "camera.distance": distance, "camera.inclination_deg": 89.0}
    scene = presets.load(["kerr", "reference"], changes)
    chi = np.radians([4.0, 5.0, 176.0])  # up so little that they come to the plane, beyond the hole
    rays = np.stack([np.full(3, math.asin(impact * math.sqrt(1.0 - 1.0 / distance) / distance)), chi], axis=-1)
    for found in (listed_rays.trace_by_shader(renderer, scene, rays), listed_rays.trace_by_reference(scene, rays)):
        far = found.crossing_delay[:, 0] > distance
        crossing = found.crossing_r[:, 0]
        ways = np.stack([np.full(3, distance), crossing])
        straight = np.sqrt(ways**2 - nearest**2)
        assert far.all() and np.all(crossing > impact)
        late = found.crossing_delay[:, 0] - straight.sum(axis=0)
        expected = np.log(np.prod(ways + straight, axis=0) / nearest**2) + 0.5 * np.sqrt((ways - nearest) / (ways + nearest)).sum(axis=0)
        np.testing.assert_allclose(late, expected, rtol=SHAPIRO)


LOOK_BACK = """#version 330 core
#defines
#blocks
#include "common/look_back.glsl"
uniform float delays[16];
out vec4 o;
void main() {
    look_back(delays[int(gl_FragCoord.x)]);
    o = gl_FragCoord.y < 1.0 ? seen_phase : seen_seed;
}
"""


def test_patterns_seen_late_are_those_of_the_time_before(ctx: moderngl.Context, tmp_path: Path) -> None:
    """In single precision: an age to 2e-5 of a life, however many lives ago."""
    path = tmp_path / "look_back.frag"
    path.write_text(LOOK_BACK)
    delays = np.linspace(-40.0, 700.0, 16)
    for time in (3.0, 1e6):
        ages, weights, seeds = shear_phases(time)
        piece = Piece(ctx, path, switches={"RAYS_LIGHT_TRAVEL": 1}, shear_phase=(*ages, *weights), shear_seed=(*seeds, 0.0, 0.0), delays=tuple(delays.tolist()))
        phase, seed = piece.draw((16, 2))
        for n, delay in enumerate(delays):
            ages, weights, seeds = shear_phases(time - delay)
            assert seed[n, :2].tolist() == list(seeds)
            np.testing.assert_allclose(phase[n], (*ages, *weights), atol=2e-5 * RENEWAL_PERIOD)


SPOT = {"disk.hot_spot": True, "disk.hot_spot.radius": 5.0, "disk.hot_spot.size": 0.3, "disk.hot_spot.brightness": 12.0, "disk.hot_spot.phase_deg": 25.0}


def scene_with_spot(delayed: bool, **changes: object) -> Scene:
    values = {
        "hole.spin": 0.6, "camera.inclination_deg": 50.0, "camera.distance": 20.0, "camera.fov_deg": 50.0, "disk.temperature_law": "shakura_sunyaev",
        "disk.colour": "white", "disk.compositing": "additive", "sky.enabled": False, "rays.edges": 1, "rays.light_travel": delayed, **SPOT,
    }  # fmt: skip
    return presets.load(["kerr", "reference", "smooth"], values | changes)


def twin_s_curves(scene: Scene, when: np.ndarray, size: tuple[int, int]) -> tuple[np.ndarray, np.ndarray]:
    """The light that the spot of a white, see-through disk adds, from the twin's crossings through the middles of the pixels, at once and as late
    as it arrives; each over its mean."""
    found = listed_rays.trace_by_reference(scene, listed_rays.pixel_rays(scene, size).reshape(-1, 2))
    made = plan(scene)
    with np.errstate(invalid="ignore"):
        shines = (found.crossing_r >= made.disk_inner) & (found.crossing_r <= made.disk_outer)
    r = np.where(shines, found.crossing_r, 5.0)
    heat = disk_profile.temperature("shakura_sunyaev", r, spin=0.6, orbit="prograde", r_in=made.disk_inner, r_out=made.disk_outer)
    base = np.where(shines, (heat * found.crossing_g) ** 4, 0.0) * light_curve.pixel_angles(scene.camera, size).reshape(-1, 1)
    curves = []
    for late in (np.zeros_like(r), np.where(shines, found.crossing_delay, 0.0)):
        at = math.radians(25.0) + float(relativity.orbital_frequency(5.0, 0.6)) * (when[:, None, None] - late)
        spot = np.exp(-0.5 * (np.log(r / 5.0) ** 2 + 4.0 * np.sin(0.5 * (found.crossing_phi - at)) ** 2) / 0.3**2)
        curves.append(np.nansum(base * spot, axis=(1, 2)))
    return curves[0] / curves[0].mean(), curves[1] / curves[1].mean()


def test_the_hot_spot_s_light_curve_is_the_twin_s(renderer: Renderer) -> None:
    """With and without delays: what it adds, of the direct image, as a ring is thinner than these pixels. Within 1 % of the brightest."""
    scene, size = scene_with_spot(False, **{"rays.orders": 1}), (48, 36)
    when = light_curve.times(scene, 12)
    curves = twin_s_curves(scene, when, size)
    assert np.abs(curves[0] - curves[1]).max() > 0.3, "delays matter"
    for delayed, expected in zip((False, True), curves, strict=True):
        seen = scene.with_values({"rays.light_travel": delayed})
        dark = light_curve.measure(renderer, seen.with_values({"disk.hot_spot": False}), when[:1], size).flux
        found = light_curve.measure(renderer, seen, when, size).flux - dark
        found /= found.mean()
        print(f"delayed {delayed}: at most {np.abs(found - expected).max():.2e} of the mean off; from {found.min():.3f} to {found.max():.3f}")
        np.testing.assert_allclose(found, expected, atol=0.01 * expected.max())


def test_what_does_not_move_looks_the_same_whenever_its_light_left(renderer: Renderer) -> None:
    scene = scene_with_spot(False, **{"disk.hot_spot": False})
    pictures = []
    for delayed in (False, True):
        renderer.render(scene.with_values({"rays.light_travel": delayed}), 5.0, (72, 40))
        pictures.append(renderer.radiance())
    assert np.array_equal(*pictures)


def test_the_plan_takes_a_model_that_tells_time_or_says_why_none_does() -> None:
    for changes, model, why in (
        ({"rays.model": "schwarzschild_table", "hole.spin": 0.0}, "schwarzschild_binet", "schwarzschild_binet instead of schwarzschild_table"),
        ({"rays.model": "kerr_schild"}, "kerr", "kerr instead of kerr_schild"),
        ({"rays.model": "kerr_like"}, "kerr_like", "light takes no time: kerr_like"),
        ({"hole.gravity_strength": 2.0}, "schwarzschild", "light takes no time: "),
    ):
        made = plan(presets.load(["kerr"], changes | {"rays.light_travel": True}))
        assert made.model.key == model and made.times == (not why.startswith("light takes no"))
        assert any(why in reason for reason in made.reasons)
        assert not made.times or made.refine_px == 0.0
    free = plan(presets.load(["kerr"], {"rays.model": "auto", "hole.spin": 0.0, "rays.light_travel": True}))
    assert free.times and free.model.traits.tells_time and free.refine_px == 0.0, "whichever the chart has for the cheapest of those that do"


@pytest.mark.parametrize(
    "changes",
    [
        {},
        {"hole.spin": 0.0, "things.star.orbit_tilt_deg": 40.0},
        {"things.star.path": "circle", "things.star.orbit_rate": 0.12, "things.star.orbit_tilt_deg": 70.0, "things.star.orbit_radius": 5.0},
    ],
)
def test_a_star_is_met_where_it_was_when_the_light_left_it(renderer: Renderer, changes: dict[str, object]) -> None:
    """On its surface as it was then, to 1e-5 r_s, ten times what places 20 r_s from the camera are rounded by; up to 0.6 c fast."""
    scene = presets.load(["orbiting_star", "reference"], {"rays.light_travel": True, "disk.enabled": False, **changes})
    made = plan(scene)
    (star,) = motion.movers(made.scene, "thing")
    for time in (0.0, 45.0):
        renderer.render(scene, time, (160, 90))
        hits = renderer.hits()
        assert hits.met is not None and hits.met_place is not None and hits.met_delay is not None
        there = hits.met[..., 0, 0] >= 0
        assert there.sum() > 20
        centres = [motion.of(star.instance, star.traits, made.space_time, time - float(delay)).centre for delay in hits.met_delay[there][:, 0]]
        off = np.abs(np.linalg.norm(hits.met_place[there][:, 0] - np.array(centres), axis=1) - 0.6)
        print(f"time {time:g}: {there.sum()} rays, at most {off.max():.1e} r_s off")
        assert off.max() < 1e-5


@pytest.mark.parametrize(
    "what",
    [
        {"things.star.kind": "sphere", "things.star.radius": 1.0, "things.star.path": "circle", "things.star.surface": "black_body"},
        {"media.cloud.kind": "ball", "media.cloud.radius": 1.0, "media.cloud.path": "circle"},
    ],
)
def test_from_above_all_of_a_circle_is_seen_as_long_ago(renderer: Renderer, what: dict[str, object]) -> None:
    """What goes round slowly, seen from far above the pole: the picture at a time is that of so much earlier without delays. What lies a radius nearer or
    farther is seen up to a time of 1 apart, in which it has gone a hundredth of a pixel."""
    name = "things.star" if "things.star.kind" in what else "media.cloud"
    values = {
        "camera.distance": 100.0, "camera.inclination_deg": 0.0, "camera.fov_deg": 12.0, "disk.enabled": False, "sky.enabled": False, "post.bloom": False,
        f"{name}.orbit_radius": 7.0, f"{name}.orbit_rate": 0.002, f"{name}.orbit_sense": "prograde", "hole.spin": 0.5, "rays.edges": 1,
    }  # fmt: skip
    scene = presets.load(["kerr", "reference"], values | what)
    late = float(listed_rays.trace_by_reference(met.without_any(scene), np.array([[math.asin(7.5 / 100.0), 0.3]])).crossing_delay[0, 0])
    light = []
    for delayed, time in ((True, 500.0), (False, 500.0 - late), (False, 500.0)):
        renderer.render(scene.with_values({"rays.light_travel": delayed}), time, (90, 90))
        light.append(renderer.radiance().astype(float).sum(axis=-1))
    assert light[0].max() > 0.0
    apart = [np.abs(light[0] - other).sum() / light[0].sum() for other in light[1:]]
    print(f"late by {late:.2f} r_s/c: {apart[0]:.4f} of the light elsewhere, at once {apart[1]:.3f}")
    assert apart[0] < 0.02 and apart[1] > 0.2
