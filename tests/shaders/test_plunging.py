"""Matter that falls in from the ISCO, in the shader: g against the float64 twin, and what it adds to a picture. `-rP` shows the figures."""

from __future__ import annotations

import math

import numpy as np
import pytest

from blackhole_gl import listed_rays
from blackhole_gl.physics import plunging, relativity
from blackhole_gl.planning import choice, plan
from blackhole_gl.rendering.frame import Renderer
from blackhole_gl.scene import Scene, presets
from tests.sampled import sampled
from tests.shaders.harness import Piece

SIZE = (64, 32)
CASES = [(0.0, "prograde"), (0.9, "prograde"), (0.9, "retrograde"), (-0.6, "prograde"), (0.998, "retrograde")]
# Near a turning point k_r is the root of a difference of numbers of the size of 1, of which
# float32 keeps 3e-7: below this, in units of r²/Δ, that is 3e-6 and more.
STEEP = 0.05


def scene_of(spin: float, orbit: str = "prograde", **changes: object) -> Scene:
    values = {"hole.spin": spin, "disk.orbit": orbit, "disk.plunging": True, **{key.replace("__", "."): value for key, value in changes.items()}}
    return presets.load(["kerr", "reference", "smooth"], values)


@pytest.mark.parametrize("spin, orbit", CASES)
@pytest.mark.parametrize("share", [0.1, 0.25, 0.5, 0.75, 0.98])
def test_g_is_the_twins_at_five_radii(ctx, tmp_path, spin: float, orbit: str, share: float) -> None:
    """Of light of every direction that leaves the plane there and can come out: 99 % within 1e-5."""
    horizon, isco = float(relativity.horizon_radius(spin)), float(relativity.isco_radius(spin, orbit))
    r = np.float32(horizon + (isco - horizon) * share)
    lam, eta, k_r, inbound = light_at(float(r), spin, SIZE[0] * SIZE[1])
    path = tmp_path / "shift.frag"
    path.write_text(
        "#version 330 core\n#defines\n#blocks\n#include \"common/disk_orbit.glsl\"\nuniform sampler2D cases;\nout vec4 o;\n"
        "void main() { vec4 c = texelFetch(cases, ivec2(gl_FragCoord.xy), 0); o = vec4(disk_g(c.x, DiskLight(c.y, c.z, vec2(1.0)), c.w > 0.5)); }\n"
    )
    root = math.sqrt((1.0 - spin) * (1.0 + spin))
    piece = Piece(
        ctx, path, switches={"DISK_PLUNGING": 1}, hole_spin=spin, disk_spin_sign=float(relativity.orbit_sense(spin, orbit)),
        hole_spin_complement=1.0 - abs(spin), disk_fall=(*plunging.constants(spin, orbit), 0.0), hole_w_factors=(1.0 + root, 1.0 - root),
    )
    cases = np.stack([np.full_like(lam, r), lam, eta, inbound.astype(np.float32)], -1).reshape(SIZE[1], SIZE[0], 4)
    got = piece.table("cases", cases, nearest=True).draw(SIZE)[..., 0].reshape(-1)
    exact = plunging.emission_shift(float(r), lam.astype(float), k_r, spin, orbit)
    steep = np.abs(k_r * (4.0 * r * r - 4.0 * r + spin * spin) / (4.0 * r * r)) > STEEP
    off = np.abs(got / exact - 1.0)[steep]
    assert steep.mean() > 0.8
    print(f"a* = {spin:g}, {orbit}, r = {r:.3f} r_s: 99 % of g within {np.quantile(off, 0.99):.1e}")
    assert np.quantile(off, 0.99) <= 1e-5


def light_at(r: float, spin: float, count: int) -> tuple[np.ndarray, np.ndarray, np.ndarray, np.ndarray]:
    """(λ, η, k_r, whether it comes in) of light in the plane at r (r_s), as a ZAMO there sees it go in directions that are evenly strewn, with E > 0."""
    rng, r = np.random.default_rng(8), 2.0 * r
    n = rng.normal(size=(40 * count, 3))
    n /= np.linalg.norm(n, axis=1, keepdims=True)
    delta, area = r * r - 2.0 * r + spin**2, (r * r + spin**2) ** 2 - spin**2 * (r * r - 2.0 * r + spin**2)
    lapse, drag, ring = math.sqrt(delta) * r / math.sqrt(area), 2.0 * spin * r / area, math.sqrt(area) / r
    energy = lapse + drag * ring * n[:, 2]
    # From within the light's own innermost orbit only what would pass inside the critical curve gets away; farther out nothing passes beyond r over the lapse.
    innermost = 2.0 * float(relativity.photon_orbit_radius(abs(spin)))
    aside, _ = relativity.critical_curve(spin, 0.5 * math.pi)
    widest = (-aside.max(), -aside.min()) if r < innermost else (-max(7.0, 1.4 * r), max(7.0, 1.4 * r))
    found = (energy > 0.0) & (np.hypot(ring * n[:, 2], r * n[:, 1]) < max(-widest[0], widest[1]) * energy)
    found &= (ring * n[:, 2] > widest[0] * energy) & (ring * n[:, 2] < widest[1] * energy)
    lam, eta = (ring * n[:, 2] / energy)[found][:count].astype(np.float32), ((r * n[:, 1] / energy) ** 2)[found][:count].astype(np.float32)
    inbound = (n[:, 0] < 0.0)[found][:count] & (r > innermost)  # nor does any turn round there that comes in
    w, a, l64, q64 = 1.0 / r, spin, lam.astype(float), eta.astype(float)
    square = 1.0 + w * w * (a * a - l64**2 - q64 + w * (2.0 * ((l64 - a) ** 2 + q64) - w * a * a * q64))
    k_r = np.sqrt(np.maximum(square, 0.0)) * r * r / delta
    return lam, eta, np.where(inbound, -k_r, k_r), inbound


CAMERAS = [(20.0, 75.0), (math.inf, 30.0)]


@pytest.mark.parametrize("spin, orbit, distance, inclination", sampled(
    [(*case, *camera) for case in CASES for camera in CAMERAS], [(0.9, "prograde", *CAMERAS[0]), (0.9, "retrograde", *CAMERAS[1])],
))
def test_listed_rays_have_the_twins_g_inside_the_isco(renderer: Renderer, spin: float, orbit: str, distance: float, inclination: float) -> None:
    """The twin's k_r is its own ray's, the shader's follows from the constants of its pixel. The crossing is within 2e-5 (test_trace_against_twins.py)."""
    scene = scene_of(spin, orbit, camera__distance=distance, camera__inclination_deg=inclination, rays__orders=3)
    rng = np.random.default_rng(4)
    turn, away = rng.uniform(0.0, 2.0 * np.pi, 1500), 9.0 * np.sqrt(rng.uniform(0.0, 1.0, 1500))  # M, about the hole
    far = np.stack([away * np.cos(turn), away * np.sin(turn)], axis=-1)
    rays = far if math.isinf(distance) else np.stack([0.5 * away / distance, turn], axis=-1)
    found, twin = listed_rays.trace_by_shader(renderer, scene, rays), listed_rays.trace_by_reference(scene, rays)
    isco = float(relativity.isco_radius(spin, orbit))
    inside = (twin.crossing_r < 0.999 * isco) & (found.crossing_r < isco)
    assert inside.sum() > 40
    assert np.array_equal(np.isnan(found.crossing_g), np.isnan(twin.crossing_g))
    off = np.abs(found.crossing_g / twin.crossing_g - 1.0)[inside]
    print(f"a* = {spin:g}, {orbit}, {inside.sum()} crossings: median {np.median(off):.1e}, 90 % {np.quantile(off, 0.9):.1e}")
    assert np.median(off) <= 1e-6 and np.quantile(off, 0.9) <= 1e-5, "the rest pass close to the critical curve"


@pytest.mark.parametrize("orbit", ["prograde", "retrograde"])
def test_off_it_is_the_picture_without_and_on_it_changes_the_inside_alone(renderer: Renderer, orbit: str) -> None:
    values = {"disk__temperature_law": "shakura_sunyaev", "post__bloom": False, "rays__edges": 1, "sky__enabled": False, "disk__compositing": "additive"}
    size, radiance = (240, 135), []
    scene = scene_of(0.5, orbit, camera__inclination_deg=50.0, **values)
    for plunges in (False, True):
        renderer.render(scene.with_values({"disk.plunging": plunges}), 0.0, size)
        radiance.append(renderer.radiance()[::-1])
    without, there = radiance
    r, isco = np.linalg.norm(renderer.hits().crossing, axis=-1), plan(scene).disk_inner
    apart = np.all((r == 0.0) | (r > 1.6 * isco), axis=-1)
    # The table of temperatures has its texels elsewhere, and the picture is of half floats: a thousandth, and where it is dark or narrow less than can be seen.
    np.testing.assert_allclose(there[apart], without[apart], rtol=1e-3, atol=5e-4)
    inside = (r[..., 0] > 1.3) & (r[..., 0] < 0.85 * isco)
    assert inside.sum() > 100 and apart.sum() > 10000
    assert np.all(there[inside].sum(axis=-1) > without[inside].sum(axis=-1) + 1e-3)


def test_the_light_has_no_jump_at_the_isco(renderer: Renderer) -> None:
    """Temperature, g and what it makes of them: along a column of pixels the brightness changes by no more across it than on either side."""
    values = {"disk__temperature_law": "shakura_sunyaev", "disk__colour": "white", "sky__enabled": False, "post__bloom": False, "rays__edges": 1}
    scene = scene_of(0.0, camera__inclination_deg=0.0, camera__fov_deg=24.0, **values)
    renderer.render(scene, 0.0, (8, 512))
    light = renderer.radiance()[::-1][:, 4].sum(axis=-1).astype(float)
    r = np.linalg.norm(renderer.hits().crossing[:, 4, 0], axis=-1)
    near = (r > 2.7) & (r < 3.3) & (np.arange(512) > 256)
    steps = np.abs(np.diff(np.log(light[near])))
    assert near.sum() > 10 and steps.max() < 2.0 * np.median(steps)


@pytest.mark.parametrize("spin, orbit", [(0.0, "prograde"), (0.6, "retrograde")])
def test_under_a_moving_camera_it_is_the_same_picture(renderer: Renderer, monkeypatch: pytest.MonkeyPatch, spin: float, orbit: str) -> None:
    """Where hits are interpolated k_r comes of the pixel's own constants and the cell's sense: 99 % of the disk within a thousandth of the brightest light."""
    monkeypatch.setattr(choice, "refinement", lambda scene: None)
    scene = scene_of(spin, orbit, disk__inner_torque=0.1, camera__fov_deg=30.0, camera__inclination_deg=75.0, sky__enabled=False, post__bloom=False)
    scene = presets.load(["automatic"], {key: value for key, value in scene.values().items() if not key.startswith("rays.")})
    light = []
    for progressive in (False, True):
        renderer.hit_map.forget()
        renderer.render(scene, 0.0, (480, 270), progressive=progressive)
        light.append(renderer.radiance().astype(float).sum(axis=-1))
    assert not renderer.hit_map.is_sharp, "nothing was interpolated"
    off = np.abs(light[1] - light[0])[light[0] > 0.0] / light[0].max()
    assert np.quantile(off, 0.99) < 1e-3


@pytest.mark.parametrize(
    "values, why",
    [
        ({"disk.frequency_shift": "s1"}, "formulas"),
        ({"disk.inner_radius": 5.0}, "cut off"),
        ({"rays.model": "kerr_like"}, "space-time"),
        ({"rays.model": "schwarzschild", "hole.gravity_strength": 1.5}, "space-time"),
    ],
)
def test_where_there_can_be_none_the_plan_says_so(values: dict, why: str) -> None:
    made = plan(scene_of(0.0).with_values(values))
    assert not made.scene.disk.plunging and made.disk_edge == made.disk_inner
    assert any(why in reason and "innermost stable orbit" in reason for reason in made.reasons)
