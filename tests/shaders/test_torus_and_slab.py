"""Media with a form of their own: a Polish doughnut's density, surface and picture against the float64 twin, and the slab's clouds."""

from __future__ import annotations

import math

import numpy as np
import pytest

from blackhole_gl.physics import relativity
from blackhole_gl.physics.observer import observe
from blackhole_gl.physics.torus import Torus
from blackhole_gl.reference import media, transfer
from blackhole_gl.rendering import instances
from blackhole_gl.rendering.frame import Renderer
from blackhole_gl.rendering.recording import pixel_direction
from blackhole_gl.scene import Scene, presets
from tests.shaders.harness import Piece

# Spin, inner edge, pressure's maximum, adiabatic index; lengths in r_s. The first has l = 4.
L_IS_4 = 3.0 + math.sqrt(5.0)
TORI = {"a = 0, l = 4": (0.0, 2.2, L_IS_4, 4.0 / 3.0), "a = 0.9": (0.9, 1.4, 2.0, 4.0 / 3.0), "a = -0.9, against it": (-0.9, 6.0, 9.0, 5.0 / 3.0)}

DENSITY = """#version 330 core
#defines
#blocks
uniform sampler2D places;
uniform vec3 shape;
uniform int orbit;
#define medium_torus_inner_radius(i) shape.x
#define medium_torus_peak_radius(i) shape.y
#define medium_torus_gamma(i) shape.z
#define medium_torus_radius(i) 100.0
#define medium_torus_orbit(i) orbit
#define medium_torus_depth(i) 1.0
#define medium_torus_dims(i) vec3(1.0)
#define medium_torus_brightness(i) 1.0
#define medium_torus_colour(i) vec3(1.0)
struct Sight { vec3 place; };
struct Matter { vec3 emission; vec3 absorption; float shift; };
float circling_shift(Sight sight, float l) { return l; }
#include "media/torus.glsl"
out vec4 o;
void main() {
    vec3 x = texelFetch(places, ivec2(gl_FragCoord.xy), 0).xyz;
    o = vec4(torus_density(0, x), medium_torus_scale(0, x), medium_torus_distance(0, x), medium_torus_matter(0, Sight(x)).shift);
}
"""


def twin_of(spin: float, inner: float, peak: float, gamma: float) -> Torus:
    return Torus.between(spin, 2.0 * float(np.float32(inner)), 2.0 * float(np.float32(peak)), float(np.float32(gamma)))


def drawn(ctx, tmp_path, name: str, places: np.ndarray) -> np.ndarray:
    """What the shader has at `places` (h, w, 3): density, scale, distance, angular momentum."""
    spin, inner, peak, gamma = TORI[name]
    path = tmp_path / "density.frag"
    path.write_text(DENSITY)
    root = math.sqrt((1.0 - spin) * (1.0 + spin))
    piece = Piece(ctx, path, hole_spin=spin, hole_w_factors=(1.0 + root, spin * spin / (1.0 + root)), shape=(inner, peak, gamma), orbit=int(spin < 0.0))
    return piece.table("places", places, nearest=True).draw(places.shape[1::-1])


def sines2(places: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """r in M and sin^2(theta), in float64, of the places as the shader gets them."""
    x = places.astype(np.float32).astype(np.float64)
    r2 = (x * x).sum(axis=-1)
    return 2.0 * np.sqrt(r2), (x[..., 0] ** 2 + x[..., 1] ** 2) / r2


@pytest.mark.parametrize("name", TORI)
def test_density_is_the_twins(ctx, tmp_path, name: str) -> None:
    rng, torus = np.random.default_rng(2), twin_of(*TORI[name])
    r = 0.5 * np.exp(rng.uniform(np.log(torus.cusp), np.log(min(torus.outer_radius, 100.0)), (128, 128)))
    theta, phi = np.arccos(rng.uniform(-1.0, 1.0, r.shape)), rng.uniform(0.0, 2.0 * np.pi, r.shape)
    places = np.stack([r * np.sin(theta) * np.cos(phi), r * np.sin(theta) * np.sin(phi), r * np.cos(theta)], axis=-1)
    found, expected = drawn(ctx, tmp_path, name, places), torus.density(*sines2(places))
    assert 0.1 < np.mean(expected > 0.01) < 0.9
    print(name, "density", np.abs(found[..., 0] - expected).max())
    np.testing.assert_allclose(found[..., 0], expected, atol=1e-5)
    np.testing.assert_array_less(found[..., 2][expected > 0.0], 0.0)  # all of it lies within the bounds
    np.testing.assert_allclose(found[..., 3], torus.momentum, rtol=1e-5)  # l, whichever way the hole turns


@pytest.mark.parametrize("name", TORI)
def test_surface_is_the_twins(ctx, tmp_path, name: str) -> None:
    """A hundred-thousandth of the radius within there is matter, as much without there is none: along rings of latitude, at the twin's own surface."""
    torus = twin_of(*TORI[name])
    sine2 = np.linspace(1.0, 0.3, 64)
    inner = np.array([edge(torus, 0.5 * torus.inner_radius, s, towards=torus.centre) for s in sine2])
    outer = np.array([edge(torus, min(torus.outer_radius, 1e3), s, towards=torus.centre) for s in sine2])
    there = np.isfinite(inner) & np.isfinite(outer)
    assert np.count_nonzero(there) > 5
    for radius, within in ((inner[there], 1.0), (outer[there], -1.0)):
        for side, inside in ((1e-5, True), (-1e-5, False)):
            r = 0.5 * radius * (1.0 + within * side)
            places = np.stack([r * np.sqrt(sine2[there]), 0.0 * r, r * np.sqrt(1.0 - sine2[there])], axis=-1)[None]
            found = drawn(ctx, tmp_path, name, places)[0, :, 0]
            assert np.all((found > 0.0) == inside), (found, inside)


def edge(torus: Torus, outside: float, sine2: float, towards: float) -> float:
    """Radius in M, between `outside` and `towards`, at which the density begins; NaN if there is none at this latitude."""
    r = np.geomspace(outside, towards, 2000)
    there = np.flatnonzero(torus.density(r, sine2) > 0.0)
    if not there.size or there[0] == 0:
        return np.nan
    low, high = r[there[0] - 1], r[there[0]]
    for _ in range(60):
        middle = 0.5 * (low + high)
        low, high = (low, middle) if torus.density(middle, sine2) > 0.0 else (middle, high)
    return high


PICTURES = {
    "a = 0": {"hole.spin": 0.0, "rays.model": "schwarzschild_binet", "media.ring.inner_radius": 2.2, "media.ring.peak_radius": L_IS_4, "media.ring.depth": 0.3},
    "a = 0.9": {"hole.spin": 0.9, "rays.model": "kerr", "media.ring.inner_radius": 1.4, "media.ring.peak_radius": 2.0, "media.ring.depth": 1.5},
    "a = 0.9, other form": {"hole.spin": 0.9, "rays.model": "kerr_schild",
                            "media.ring.inner_radius": 3.0, "media.ring.peak_radius": 5.0, "media.ring.depth": 0.5},
}
SIZE = (30, 20)
QUIET = {"disk.enabled": False, "sky.enabled": False, "post.bloom": False, "rays.edges": 1, "rays.tolerance": 0.02, "camera.fov_deg": 30.0}
RING = {"media.ring.kind": "torus", "media.ring.radius": 15.0, "media.ring.dims": (1.0, 0.5, 0.1), "media.ring.colour": (1.0, 0.7, 0.3)}


def twins_picture(scene: Scene, medium: media.Medium) -> np.ndarray:
    """The twin's radiance (h, w, colours) at the camera, highest row first."""
    camera, spin = scene.camera, scene.hole.spin
    look = observe(scene).look
    rays = np.array([look @ pixel_direction(scene, SIZE, (x + 0.5, SIZE[1] - y - 0.5)) for y in range(SIZE[1]) for x in range(SIZE[0])])
    # Of the two forms of Kerr, which gather the same (test_transfer_twin.py), the one that costs less.
    model = "kerr_schild" if scene.rays.model == "kerr" else scene.rays.model
    seen = transfer.gather(model, medium, spin=spin, distance=camera.distance, inclination_deg=camera.inclination_deg,
                           azimuth_deg=camera.azimuth_deg, observer=camera.observer, directions=rays, tolerance=1e-6)
    energy = relativity.photon_constants(rays[:, 1], rays[:, 2], camera.distance, math.radians(camera.inclination_deg), spin, camera.observer).energy
    return (seen.intensity / energy[:, None] ** 4).reshape(SIZE[1], SIZE[0], -1)


@pytest.mark.parametrize("name", [name if name == "a = 0.9" else pytest.param(name, marks=pytest.mark.slow) for name in PICTURES])
def test_picture_of_a_torus_is_the_twins(renderer: Renderer, name: str) -> None:
    """Of the pixels 99 % within 0.3 % of the peak: half floats and steps of a quarter of its scale leave 0.06 %. And none is no number."""
    scene = presets.load(["kerr"], {**QUIET, **RING, **PICTURES[name]})
    ring = scene.media["ring"].values
    medium = media.Doughnut(
        Torus.between(scene.hole.spin, 2.0 * ring["inner_radius"], 2.0 * ring["peak_radius"], ring["gamma"]), limit=ring["radius"],
        absorption=tuple(ring["depth"] * share for share in ring["dims"]), source=tuple(ring["brightness"] * share for share in ring["colour"]),
    )
    renderer.render(scene, 0.0, SIZE)
    found, expected = renderer.radiance(), twins_picture(scene, medium)
    off = np.abs(found - expected) / expected.max(axis=(0, 1))
    print(name, "peak", expected.max(axis=(0, 1)), "99 % within", np.quantile(off, 0.99), "worst", off.max())
    assert np.quantile(off, 0.99) < 0.003


SLAB = {**QUIET, "hole.spin": 0.9, "rays.model": "kerr", "media.slab.kind": "slab", "media.slab.inner_radius": 2.0, "media.slab.outer_radius": 7.0,
        "media.slab.height": 0.5, "media.slab.octaves": 0}
LUMINANCE = np.array([0.2126, 0.7152, 0.0722])


def test_picture_of_a_smooth_slab_is_the_twins(renderer: Renderer) -> None:
    """In luminance, which the colour of its temperature leaves alone. 99 % within 0.5 % of the peak: a surface is found to a thousandth of its height."""
    scene = presets.load(["kerr"], SLAB)
    slab = scene.media["slab"].values
    medium = media.Slab(slab["inner_radius"], slab["outer_radius"], slab["height"], slab["depth"], slab["brightness"])
    renderer.render(scene, 0.0, SIZE)
    found, expected = renderer.radiance() @ LUMINANCE, twins_picture(scene, medium)[..., 0]
    off = np.abs(found - expected) / expected.max()
    print("peak", expected.max(), "99 % within", np.quantile(off, 0.99), "worst", off.max())
    assert np.quantile(off, 0.99) < 0.005


FINE = (192, 128)  # in coarser pixels clouds fade


def test_clouds_without_contrast_change_nothing(renderer: Renderer) -> None:
    def drawn_with(octaves: int, contrast: float, grain: float, time: float = 7.0) -> np.ndarray:
        values = {"media.slab.octaves": octaves, "media.slab.contrast": contrast, "media.slab.grain": grain, "media.slab.depth": 0.4}
        renderer.render(presets.load(["kerr"], {**SLAB, **values}), time, FINE)
        return renderer.radiance()

    smooth = drawn_with(0, 2.0, 0.0)
    np.testing.assert_array_equal(drawn_with(3, 0.0, 0.0), smooth)
    np.testing.assert_array_equal(drawn_with(0, 2.0, 0.0, time=500.0), smooth)
    lit = smooth > 0.01 * smooth.max()
    for clouds, least in ((drawn_with(3, 2.0, 0.0), 0.01), (drawn_with(0, 2.0, 6.0), 0.0)):
        swing = np.abs(clouds / np.maximum(smooth, 1e-6) - 1.0)[lit]
        print("swing", swing.mean(), swing.max())
        assert swing.mean() > least


def test_clouds_are_no_more_wound_up_after_ten_hours(renderer: Renderer) -> None:
    """Light and contrast of the pictures of six moments each, early and late, differ by no more than moments do among themselves."""
    def statistics(start: float) -> tuple[np.ndarray, np.ndarray]:
        scene = presets.load(["kerr"], {**SLAB, "media.slab.octaves": 3, "media.slab.depth": 0.4, "camera.inclination_deg": 40.0})
        pictures = []
        for moment in range(6):
            renderer.render(scene, start + 31.0 * moment, FINE)
            pictures.append(renderer.radiance() @ LUMINANCE)
        return np.array([picture.mean() for picture in pictures]), np.array([np.abs(np.diff(picture, axis=1)).mean() for picture in pictures])

    for early, late in zip(statistics(1.0), statistics(36_000.0)):
        scatter = max(early.std(), late.std())
        print("mean", early.mean(), late.mean(), "scatter", scatter)
        assert abs(early.mean() - late.mean()) < 2.0 * scatter  # of six each: three times the error of their difference


NOISE = """#version 330 core
#defines
#blocks
#include "common/solid_noise.glsl"
uniform vec3 from, right, up;
out vec4 o;
void main() {
    vec2 place = gl_FragCoord.xy - 0.5;
    o = vec4(solid_noise(from + place.x * right + place.y * up, 5u));
}
"""


def test_noise_in_space_has_the_deviation_of_that_on_a_sheet_and_no_steps(ctx, tmp_path) -> None:
    path = tmp_path / "noise.frag"
    path.write_text(NOISE)
    piece = Piece(ctx, path)
    values = piece.set(**{"from": (-200.0, -150.0, 3.3), "right": (0.71, 0.13, 0.09), "up": (-0.11, 0.69, 0.05)}).draw((512, 512))[..., 0]
    assert values.std() == pytest.approx(0.24, rel=0.03)  # a quarter of a million draws, one in four independent
    assert abs(values.mean()) < 0.005 and np.abs(values).max() < 1.0
    # From tetrahedron to tetrahedron: a step of 1/500 changes it by no more than its steepest slope does, 7 or so.
    fine = piece.set(**{"from": (-2.3, 1.7, -0.4), "right": (0.002, 0.0, 0.0), "up": (0.0, 0.0013, 0.0015)}).draw((512, 512))[..., 0]
    assert max(np.abs(np.diff(fine, axis=axis)).max() for axis in (0, 1)) < 0.02


def test_a_slab_is_as_thick_as_the_disk_says_unless_it_says_itself(renderer: Renderer) -> None:
    def picture(**changes: float) -> np.ndarray:
        renderer.render(presets.load(["kerr"], {**SLAB, **{key.replace("__", "."): value for key, value in changes.items()}}), 0.0, SIZE)
        return renderer.radiance()

    own = picture(media__slab__height=0.3, disk__thickness=1.0)
    np.testing.assert_array_equal(picture(media__slab__height=0.0, disk__thickness=0.3), own)


def test_lanes_in_a_slab_change_its_picture_keep_its_light_and_are_nothing_at_0(renderer: Renderer) -> None:
    """Through a thin one, where light goes as density, whose mean lanes leave alone; from near by, as what is finer than a pixel is left out."""
    seen = {**SLAB, "media.slab.height": 0.2, "media.slab.depth": 0.05, "camera.inclination_deg": 40.0, "camera.distance": 20.0, "camera.fov_deg": 16.0}

    def picture(lanes: float) -> np.ndarray:
        renderer.render(presets.load(["kerr"], {**seen, "media.slab.lanes": lanes}), 8.0, SIZE)
        return renderer.radiance() @ LUMINANCE

    smooth, laned = picture(0.0), picture(2.0)
    lit = smooth > 0.02 * smooth.max()
    changed = np.abs(laned[lit] / smooth[lit] - 1.0)
    assert np.quantile(changed, 0.9) > 0.1
    assert abs(laned.sum() / smooth.sum() - 1.0) < 0.1  # a few lanes are in the picture, and no whole number of them


def test_lanes_are_compiled_only_where_a_slab_has_them() -> None:
    """They took a sixth of a moving frame of a slab that has none."""
    bare = presets.load(["kerr"], SLAB)
    laned = bare.with_values({"media.other.kind": "slab", "media.other.lanes": 0.5})
    assert [instances.switches(scene)["MEDIUM_SLAB_LANES"] for scene in (bare, laned)] == [0, 1]
