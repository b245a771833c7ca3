"""The jet: light and motion of its matter against NumPy from the formulas, its distance, and in flat space a wall's chord and the ratio of its two sides."""

from __future__ import annotations

import math
from dataclasses import dataclass
from pathlib import Path

import moderngl
import numpy as np
import pytest

from blackhole_gl.physics.moving_matter import emitted_shift
from blackhole_gl.physics.observer import observe
from blackhole_gl.reference import jet, transfer
from blackhole_gl.rendering.frame import Renderer
from blackhole_gl.rendering.recording import pixel_direction
from blackhole_gl.scene import Scene, catalogue, presets
from tests.shaders.harness import Piece

EDGE = 3.0  # widths of its Gaussian


@dataclass(frozen=True)
class Jet:
    """Its parameters without knots, and its formulas in float64; places (..., 3) in r_s."""

    inner_radius: float = 1.5
    outer_radius: float = 30.0
    opening_deg: float = 30.0
    thickness: float = 0.15
    collimation: float = 0.0
    speed: float = 0.6
    pitch_deg: float = 30.0
    falloff: float = 1.5
    brightness: float = 0.5
    depth: float = 0.2
    index: float = 0.7
    knots: float = 0.0
    knot_length: float = 4.0
    strands: int = 6

    def wall(self, r: np.ndarray) -> np.ndarray:
        """s = sin(theta/2) of the wall's middle."""
        return math.sin(math.radians(self.opening_deg) / 2) / np.sqrt(1 + self.collimation * np.maximum(r / self.inner_radius - 1, 0))

    def beside(self, x: np.ndarray) -> np.ndarray:
        """s less that of the wall's middle, in widths of the Gaussian."""
        r = np.linalg.norm(x, axis=-1)
        half = np.arctan2(np.hypot(x[..., 0], x[..., 1]), np.abs(x[..., 2])) / 2
        return (np.sin(half) / self.wall(r) - 1) / self.thickness

    def inside(self, x: np.ndarray) -> np.ndarray:
        r = np.linalg.norm(x, axis=-1)
        return (np.abs(self.beside(x)) < EDGE) & (r > self.inner_radius) & (r < self.outer_radius)

    def density(self, x: np.ndarray) -> np.ndarray:
        r = np.linalg.norm(x, axis=-1)
        begun = np.clip((r / self.inner_radius - 1) / 0.5, 0, 1)
        ended = np.clip((r / self.outer_radius - 0.5) / 0.5, 0, 1)
        ends = begun**2 * (3 - 2 * begun) * (1 - ended**2 * (3 - 2 * ended))
        return ends * np.exp(-self.beside(x) ** 2 / 2) * (r / self.inner_radius) ** -self.falloff

    def beta(self, x: np.ndarray) -> np.ndarray:
        """Velocity (r, theta, phi) as a ZAMO sees it: along s sqrt(1 + c (r/r_0 - 1)) = const., by its slope in finite differences, and round."""
        r, cosine = np.linalg.norm(x, axis=-1), np.sign(x[..., 2])
        half = np.arctan2(np.hypot(x[..., 0], x[..., 1]), np.abs(x[..., 2])) / 2
        step = 1e-6
        later = 2 * np.arcsin(np.sin(half) * self.wall(r * (1 + step)) / self.wall(r)) - 2 * half
        ways = np.stack([np.ones_like(r), cosine * later / step, 0 * r], axis=-1)
        pitch = math.radians(self.pitch_deg)
        return self.speed * (math.cos(pitch) * ways / np.linalg.norm(ways, axis=-1)[..., None] + math.sin(pitch) * np.array([0.0, 0.0, 1.0]))

    def set(self) -> dict[str, object]:
        return {f"media.jet.{name}": value for name, value in vars(self).items()}


CASES = {
    "cone": (Jet(), 0.9, False),
    "paraboloid": (Jet(collimation=1.0, opening_deg=50.0, pitch_deg=-50.0, speed=0.9), 0.9, False),
    "between, against the hole": (Jet(collimation=0.4, inner_radius=1.1, thickness=0.4, speed=0.95), -0.9, False),
    "no spin": (Jet(thickness=0.05, pitch_deg=80.0), 0.0, False),
    "flat": (Jet(collimation=0.7, speed=0.9), 0.0, True),
}

HEAD = """#version 330 core
#defines
#blocks
#include "common/hits.glsl"
#include "common/matter.glsl"
"""
BODY = """
#include "media/jet.glsl"
uniform sampler2D cases;
out vec4 o;
vec4 given(int k) { return texelFetch(cases, ivec2(gl_FragCoord.x, k), 0); }
void main() {
    Meeting met = Meeting(0, 0, 0, true, given(0).xyz, Momentum(given(1).w, given(1).xyz), vec3(0.0));
    Matter matter = medium_jet_matter(0, sight_of(met, vec2(1.25)));
    float pattern = medium_jet_pattern(0, met.place, 0.0);
    o = vec4(pattern * matter.emission.x, pattern * matter.absorption.x, matter.shift, medium_jet_distance(0, met.place));
}
"""
ENERGY = 1.25


def matter_of(ctx: moderngl.Context, folder: Path, jet: Jet, spin: float, flat: bool, texels: np.ndarray, **uniforms: object) -> np.ndarray:
    """(N, 4): emission, absorption, shift and distance, as the shader has them at places and momenta (2, N, 4)."""
    values = "".join(f"#define medium_jet_{name}(i) {value}\n" for name, value in vars(jet).items()) + "#define medium_jet_colour(i) vec3(1.0)\n"
    path = folder / "jet.frag"
    path.write_text(HEAD + values + BODY)
    root = math.sqrt((1.0 - spin) * (1.0 + spin))
    factors = (1.0 + root, spin * spin / (1.0 + root))
    piece = Piece(ctx, path, switches={"MEETINGS": 1, "SPACE_TIME_FLAT": int(flat)}, hole_spin=spin, hole_w_factors=factors, **uniforms)
    return piece.table("cases", texels, nearest=True).draw((texels.shape[1], 1))[0].astype(float)


def places_in(jet: Jet, count: int, seed: int) -> np.ndarray:
    """Places in its wall, on both sides, as single precision has them."""
    rng = np.random.default_rng(seed)
    r = np.exp(rng.uniform(math.log(1.02 * jet.inner_radius), math.log(0.98 * jet.outer_radius), count))
    half = np.arcsin(np.clip(jet.wall(r) * (1 + jet.thickness * rng.uniform(-2.5, 2.5, count)), 0.02, 0.7))
    phi = rng.uniform(-np.pi, np.pi, count)
    z = np.where(rng.random(count) < 0.5, -1, 1) * np.cos(2 * half)
    x = r[:, None] * np.stack([np.sin(2 * half) * np.cos(phi), np.sin(2 * half) * np.sin(phi), z], axis=-1)
    return x.astype(np.float32).astype(float)


def coordinate_velocity(x: np.ndarray, beta: np.ndarray, spin: float, flat: bool) -> tuple[np.ndarray, np.ndarray]:
    """dx/dt from what a ZAMO sees, by the printed metric's g; and the unit vectors e_r, e_theta, e_phi, (N, 3, 3)."""
    r, n = 2 * np.linalg.norm(x, axis=-1), x / np.linalg.norm(x, axis=-1)[:, None]
    sine, cosine = np.hypot(n[:, 0], n[:, 1]), n[:, 2]
    e_phi = np.stack([-n[:, 1], n[:, 0], 0 * r], axis=-1) / sine[:, None]
    frame = np.stack([n, np.cross(e_phi, n), e_phi], axis=1)
    if flat:
        return np.einsum("nk,nkx->nx", beta, frame), frame
    sigma, delta = r**2 + (spin * cosine) ** 2, r**2 - 2 * r + spin**2
    g_tt, g_tphi = -(1 - 2 * r / sigma), -2 * spin * r * sine**2 / sigma
    g_phiphi = sine**2 * (r**2 + spin**2 + 2 * r * (spin * sine) ** 2 / sigma)
    omega = -g_tphi / g_phiphi
    lapse = np.sqrt(-(g_tt + omega * g_tphi))
    rates = np.stack([lapse * beta[:, 0] * np.sqrt(delta / sigma), lapse * beta[:, 1] * r / np.sqrt(sigma),
                      r * sine * (omega + lapse * beta[:, 2] / np.sqrt(g_phiphi))], axis=-1)
    return np.einsum("nk,nkx->nx", rates, frame), frame


@pytest.mark.parametrize("name", CASES)
def test_light_and_motion_of_its_matter_are_those_of_the_formulas(ctx: moderngl.Context, tmp_path: Path, name: str) -> None:
    """The shift within 1e-4 of the float64 one, as all shifts; emission and absorption within 1e-3 of their largest, as they go as its power, and as
    float32 has the place in a thin wall."""
    jet, spin, flat = CASES[name]
    x = places_in(jet, 1024, 5)
    velocity, axes = coordinate_velocity(x, jet.beta(x), spin, flat)
    rng, r = np.random.default_rng(6), 2 * np.linalg.norm(x, axis=-1)
    sine = 2 * np.hypot(x[:, 0], x[:, 1]) / r
    seen = rng.normal(size=x.shape)  # the light's way as a ZAMO sees it: E_local (1, n), from which E = 1 far away
    seen /= np.linalg.norm(seen, axis=-1)[:, None]
    k = momentum(r, sine, x[:, 2] * 2 / r, seen, spin, flat)
    fall = np.ones_like(r) if flat else 1 - 2 / r + (spin / r) ** 2
    rates = -(k[:, 1])[:, None] * axes[:, 1] - (k[:, 2] / sine)[:, None] * axes[:, 2]
    texels = np.zeros((2, len(x), 4))
    texels[0, :, :3], texels[1] = x, np.concatenate([rates, (fall * k[:, 0])[:, None]], axis=-1)
    found = matter_of(ctx, tmp_path, jet, spin, flat, texels)
    shift = emitted_shift(x, velocity, k, spin, 0.0 if flat else 1.0)
    assert np.all(np.isfinite(shift)) and shift.max() > 1.0 > shift.min()
    print(name, "shift", np.abs(found[:, 2] / shift - 1).max())
    np.testing.assert_allclose(found[:, 2], shift, rtol=1e-4)
    light = jet.density(x) * (shift * ENERGY) ** jet.index
    for channel, expected in ((0, jet.brightness * light), (1, jet.depth * light * (shift * ENERGY) ** 2.5)):
        assert np.mean(expected > 0.01 * expected.max()) > 0.03
        np.testing.assert_allclose(found[:, channel], expected, atol=1e-3 * expected.max(), rtol=1e-3)


def momentum(r: np.ndarray, sine: np.ndarray, cosine: np.ndarray, way: np.ndarray, spin: float, flat: bool) -> np.ndarray:
    """(k_r, k_theta, k_phi) of light with E = 1 that a ZAMO sees run along `way`."""
    if flat:
        return way * np.stack([np.ones_like(r), r, r * sine], axis=-1)
    sigma, delta = r**2 + (spin * cosine) ** 2, r**2 - 2 * r + spin**2
    square = (r**2 + spin**2) ** 2 - delta * (spin * sine) ** 2
    lapse, omega, ring = np.sqrt(sigma * delta / square), 2 * spin * r / square, sine * np.sqrt(square / sigma)
    local = 1 / (lapse + omega * ring * way[:, 2])  # E = lapse E_local + omega L
    return local[:, None] * way * np.stack([np.sqrt(sigma / delta), np.sqrt(sigma), ring], axis=-1)


@pytest.mark.parametrize("name", CASES)
def test_its_distance_never_leads_through_a_surface(ctx: moderngl.Context, tmp_path: Path, name: str) -> None:
    """Its sign is that of the formulas, and no place within that distance lies on the other side."""
    jet, spin, flat = CASES[name]
    rng = np.random.default_rng(7)
    x = rng.normal(size=(2048, 3)) * np.array([0.5, 0.5, 1.0])
    x *= (np.exp(rng.uniform(math.log(0.3), math.log(60.0), len(x))) / np.linalg.norm(x, axis=-1))[:, None]
    x = x.astype(np.float32).astype(float)
    texels = np.zeros((2, len(x), 4))
    texels[0, :, :3] = x
    off = matter_of(ctx, tmp_path, jet, spin, flat, texels)[:, 3]
    clear = np.abs(off) > 1e-4 * np.linalg.norm(x, axis=-1)
    np.testing.assert_array_equal((off < 0)[clear], jet.inside(x)[clear])
    assert 0.05 < np.mean(off < 0) < 0.9
    ways = rng.normal(size=(200, 1, 3))
    ways *= 0.999 / np.linalg.norm(ways, axis=-1)[..., None]
    there = x + ways * np.abs(off)[:, None]
    assert np.all(jet.inside(there)[:, clear] == (off < 0)[clear])


SIZE = (48, 48)
QUIET = {"rays.lensing": False, "hole.spin": 0.0, "disk.enabled": False, "sky.enabled": False, "post.bloom": False, "rays.edges": 1, "media.jet.kind": "jet",
         "media.jet.colour": (1.0, 1.0, 1.0), "camera.distance": 60.0}


def drawn(renderer: Renderer, scene: Scene, time: float = 0.0) -> np.ndarray:
    """Red of the radiance, top row first."""
    renderer.render(scene, time, SIZE)
    return renderer.radiance()[..., 0].astype(float)


def rays_of(scene: Scene) -> tuple[np.ndarray, np.ndarray]:
    """Where the camera is, and the pixels' directions (h, w, 3), top row first, in the world."""
    eye = observe(scene)
    ways = np.array([[pixel_direction(scene, SIZE, (x + 0.5, SIZE[1] - y - 0.5)) for x in range(SIZE[0])] for y in range(SIZE[1])])
    return scene.camera.distance * eye.n, ways @ eye.axes


def quadrature(jet: Jet, place: np.ndarray, ways: np.ndarray, samples: int = 40000) -> np.ndarray:
    """The integral of emission shift^(2 + index) along straight rays that nothing dims."""
    way = np.linspace(np.linalg.norm(place) - jet.outer_radius, np.linalg.norm(place) + jet.outer_radius, samples)
    x = place + way[:, None] * ways
    velocity, _ = coordinate_velocity(x, jet.beta(x), 0.0, True)
    shift = math.sqrt(1 - jet.speed**2) / (1 + velocity @ ways)
    return float(np.trapezoid(np.where(jet.inside(x), jet.brightness * jet.density(x) * shift ** (2 + jet.index), 0.0), way))


@pytest.mark.parametrize("collimation", [0.0, 0.8])
def test_a_thin_wall_shines_as_far_as_light_goes_through_it(renderer: Renderer, collimation: float) -> None:
    """In flat space, against quadrature along straight rays: within 1 %, and a thousandth of the brightest, which is a wall seen along itself."""
    jet = Jet(collimation=collimation, opening_deg=50.0, thickness=0.04, depth=0.0, inner_radius=3.0, falloff=0.0)
    scene = presets.load(["kerr"], {**QUIET, **jet.set(), "camera.inclination_deg": 70.0, "camera.fov_deg": 50.0})
    picture = drawn(renderer, scene)
    place, ways = rays_of(scene)
    rows, columns = np.meshgrid(np.arange(2, 48, 5), np.arange(1, 48, 5), indexing="ij")
    expected = np.array([quadrature(jet, place, ways[row, column]) for row, column in zip(rows.ravel(), columns.ravel())])
    found = picture[rows.ravel(), columns.ravel()]
    assert np.mean(expected > 0.01 * expected.max()) > 0.12
    print("off, of the peak:", np.abs(found - expected).max() / expected.max())
    np.testing.assert_allclose(found, expected, rtol=0.01, atol=1e-3 * expected.max())


def test_the_side_that_comes_at_us_outshines_the_other(renderer: Renderer) -> None:
    """By (shift₁/shift₂)^(2 + index) of matter on the axis: the cone is a degree wide, without pitch, and seen by parallel rays, which run as far through both
    sides. What goes to the left of the axis and to the right differs by 2 % in its ratio and cancels but for its square."""
    jet = Jet(opening_deg=1.0, thickness=0.3, speed=0.5, pitch_deg=0.0, falloff=0.0, depth=0.0, index=0.5)
    scene = presets.load(["kerr"], {**QUIET, **jet.set(), "camera.inclination_deg": 60.0, "camera.distance": math.inf,
                                    "camera.field_m": 120.0})
    picture = drawn(renderer, scene)
    near, far = picture[:22].sum(), picture[26:].sum()
    ratio = ((1 + 0.5 * math.cos(math.radians(60.0))) / (1 - 0.5 * math.cos(math.radians(60.0)))) ** 2.5
    assert near / far == pytest.approx(ratio, rel=0.01)


def test_knots_stream_with_the_matter_and_none_is_smooth(ctx: moderngl.Context, tmp_path: Path) -> None:
    """A pattern of age 8 is that of age 0, farther out by 8 times the speed along the wall, along the line that the matter takes."""
    jet = Jet(knots=1.0, pitch_deg=40.0, falloff=0.0, outer_radius=1000.0, opening_deg=4.0, index=0.0)
    count, step = 512, 8.0
    pitch = math.radians(jet.pitch_deg)
    r = np.linspace(5.0, 50.0, count)
    later = r + step * jet.speed * math.cos(pitch)

    def texels(radius: np.ndarray) -> np.ndarray:
        half = math.radians(jet.opening_deg) / 2
        phi = math.tan(pitch) * np.log(radius) / (2 * math.sin(half))
        place = radius[:, None] * np.stack([math.sin(2 * half) * np.cos(phi), math.sin(2 * half) * np.sin(phi), 0 * phi + math.cos(2 * half)], axis=-1)
        return np.stack([np.concatenate([place, np.zeros((count, 1))], axis=1), np.zeros((count, 4))])

    def light(radius: np.ndarray, age: float) -> np.ndarray:
        return matter_of(ctx, tmp_path, jet, 0.0, True, texels(radius), shear_phase=(age, 40.0, 1.0, 0.0))[:, 0]

    here, there = light(r, 0.0), light(later, step)
    assert np.std(here) > 0.3 * np.mean(here)
    np.testing.assert_allclose(there, here, atol=0.02 * here.max())  # the winding of many turns, in float32


def test_its_light_is_alike_after_hours(renderer: Renderer) -> None:
    """Nothing winds up and nothing moves off: mean and spread of the picture at 1 s and 36,000 s within their scatter, a tenth."""
    scene = presets.load(["kerr"], {**QUIET, "media.jet.knots": 1.0, "camera.inclination_deg": 70.0, "camera.fov_deg": 50.0})
    early = [drawn(renderer, scene, time) for time in (1.0, 31.0, 61.0)]
    late = [drawn(renderer, scene, 36000.0 + time) for time in (1.0, 31.0, 61.0)]
    assert np.abs(early[0] - early[1]).max() > 0.05 * early[0].max(), "it moves"
    for measure in (np.mean, np.std):
        assert measure(late) == pytest.approx(measure(early), rel=0.1)


def test_it_is_told_as_art() -> None:
    kinds = catalogue.plug_ins("medium")
    assert kinds["jet"].traits.phenomenological and all(item.art for item in kinds["jet"].parameters.values())
    assert not any(item.art for item in kinds["ball"].parameters.values())


TWIN_CASES = {
    "cone, clear": (Jet(outer_radius=12.0, depth=0.0), 0.9, 60.0),
    "paraboloid, dim": (Jet(outer_radius=14.0, depth=0.6, collimation=1.0, opening_deg=50.0, pitch_deg=-40.0, speed=0.8), 0.9, 35.0),
    "cone, no spin": (Jet(outer_radius=12.0, thickness=0.25, depth=0.3, speed=0.9), 0.0, 75.0),
}


@pytest.mark.parametrize("size", [(6, 4), pytest.param((36, 24), marks=pytest.mark.slow)])
@pytest.mark.parametrize("name", [name if name == "paraboloid, dim" else pytest.param(name, marks=pytest.mark.slow) for name in TWIN_CASES])
def test_its_picture_is_the_twins(renderer: Renderer, name: str, size: tuple[int, int]) -> None:
    """Seen from far away: of the pixels 99 % within 1 % of the peak."""
    made, spin, inclination = TWIN_CASES[name]
    values = {"hole.spin": spin, "camera.distance": math.inf, "camera.field_m": 40.0, "camera.inclination_deg": inclination, "disk.enabled": False}
    values |= {"sky.enabled": False, "post.bloom": False, "rays.edges": 1, "rays.model": "kerr", "rays.tolerance": 0.02, "media.jet.kind": "jet"}
    scene = presets.load(["kerr"], {**values, **made.set(), "media.jet.colour": (1.0, 1.0, 1.0)})
    renderer.render(scene, 0.0, size)
    found = renderer.radiance()[..., 0]
    width, height = size
    rays = np.array([observe(scene).look @ pixel_direction(scene, size, (x + 0.5, height - y - 0.5)) for y in range(height) for x in range(width)])
    parameters = {key: value for key, value in vars(made).items() if not key.startswith(("knot", "strand"))}
    seen = transfer.gather("kerr", jet.Jet(**parameters), spin=spin, distance=math.inf, inclination_deg=inclination,
                           azimuth_deg=scene.camera.azimuth_deg, screen=np.stack([rays[:, 2], -rays[:, 1]], axis=-1), tolerance=1e-5)
    expected = seen.intensity.reshape(height, width)
    off = np.abs(found - expected) / expected.max()
    print(f"{name}: peak {expected.max():.3g}, 99 % within {np.quantile(off, 0.99):.1e} of it, worst {off.max():.1e}")
    assert expected.max() > 0.05 and np.quantile(off, 0.99) < 0.01
