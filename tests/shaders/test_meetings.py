"""Things on a ray: a tilted plane against the twins that meet any plane, balls that are never jumped, what hides what, media that dim each colour by itself."""

from __future__ import annotations

import math
import os
import subprocess
import sys
from pathlib import Path

import numpy as np
import pytest

from blackhole_gl import listed_rays, reference
from blackhole_gl.glsl.declared import Fate
from blackhole_gl.physics import observer
from blackhole_gl.physics.space_time import space_time
from blackhole_gl.planning import WORLD, plan
from blackhole_gl.rendering.frame import Renderer
from blackhole_gl.scene import Scene, presets

ROOT = Path(__file__).resolve().parents[2]
RAYS = 1000
MODELS = ("kerr", "kerr_schild", "schwarzschild", "schwarzschild_binet", "flat")
STEPS = {"rays.step_angle": 0.05, "rays.step_length": 0.05, "rays.integrator": "rk4"}
NARROW, WIDE, TILT, NODE = 1.3, 60.0, 50.0, 25.0  # of the ring: nearly a whole plane


def _scene(model: str, **values: object) -> Scene:
    spin = 0.9 if model.startswith("kerr") else 0.0
    stated = {"rays.model": model, "hole.spin": spin, "disk.enabled": False, "camera.inclination_deg": 70.0, **STEPS}
    return presets.load(["kerr"], {**stated, **{key.replace("__", "."): value for key, value in values.items()}})


def _ring(**values: float) -> dict[str, object]:
    given = {"inner_radius": NARROW, "outer_radius": WIDE, "tilt_deg": TILT, "node_deg": NODE, **values}
    return {"things__ring__kind": "annulus", **{f"things__ring__{name}": value for name, value in given.items()}}


def _rays() -> np.ndarray:
    rng = np.random.default_rng(11)
    return np.stack([rng.uniform(0.02, 0.7, RAYS), rng.uniform(-np.pi, np.pi, RAYS)], axis=-1)


def _normal() -> np.ndarray:
    tilt, node = math.radians(TILT), math.radians(NODE)
    return np.array([math.sin(tilt) * math.sin(node), -math.sin(tilt) * math.cos(node), math.cos(tilt)])


@pytest.mark.parametrize("model", MODELS)
def test_a_tilted_ring_is_met_where_the_twin_meets_its_plane(renderer: Renderer, model: str) -> None:
    """The first crossing of the plane between the ring's edges, its place and its momentum: 99 % within 1e-5, as for crossings of z = 0.

    Relative to the distance from the hole, and to the larger of k_r r and k_θ. Rays within 1e-3 of the critical curve part too fast for float32.
    """
    scene, rays = _scene(model, **_ring()), _rays()
    hits, _, made = renderer.trace_listed(scene, listed_rays.local_vectors(rays, scene))
    camera = scene.camera
    twin = reference.trace(
        model,
        spin=space_time(scene).spin,
        distance=camera.distance,
        inclination_deg=camera.inclination_deg,
        directions=observer.local_directions(rays[:, 0], rays[:, 1]),
        planes=[_normal()],
    )
    crossings = twin.crossings.of(1)
    inside = (crossings.r > NARROW) & (crossings.r < WIDE)
    first = np.argmax(inside, axis=1)
    expected = inside.any(axis=1)
    met = hits.met[:, 0, 0] >= 0
    assert made.frame == WORLD
    assert np.mean(met != expected) < 0.01, "beside the edges, and beside the critical curve"
    both = met & expected
    assert both.sum() > 500
    assert np.all(hits.fate[met] == Fate.MET)

    row = np.flatnonzero(both), first[both]
    r, theta, phi = crossings.r[row], crossings.theta[row], crossings.phi[row]
    place = r[:, None] * np.stack([np.sin(theta) * np.cos(phi), np.sin(theta) * np.sin(phi), np.cos(theta)], axis=-1)
    apart = np.linalg.norm(hits.met_place[both, 0] - place, axis=1) / r
    assert np.quantile(apart, 0.99) < 1e-5
    e_theta = np.stack([np.cos(theta) * np.cos(phi), np.cos(theta) * np.sin(phi), -np.sin(theta)], axis=-1)
    rates = hits.met_rates[both, 0].astype(float)
    w, a = 0.5 / r, space_time(scene).spin
    fall = 1.0 if model == "flat" else 1.0 - 2.0 * w + (a * w) ** 2
    k_r, k_theta = rates[:, 3] / fall, -np.sum(rates[:, :3] * e_theta, axis=1)
    size = np.maximum(np.abs(crossings.k_r[row]) * 2.0 * r, np.abs(crossings.k_theta[row]))
    assert np.quantile(np.abs(k_r - crossings.k_r[row]) * 2.0 * r / size, 0.99) < 2e-5
    assert np.quantile(np.abs(k_theta - crossings.k_theta[row]) / size, 0.99) < 2e-5


@pytest.mark.parametrize("model", MODELS)
def test_the_disk_and_a_ring_in_its_plane_are_met_alike(renderer: Renderer, model: str) -> None:
    """Events found in two ways: z = 0 by the march itself, the ring along the curve between its states."""
    rays = listed_rays.local_vectors(_rays(), _scene(model))
    disk, _, _ = renderer.trace_listed(_scene(model, disk__enabled=True), rays)
    ring, _, _ = renderer.trace_listed(_scene(model, **_ring(tilt_deg=0.0, node_deg=0.0)), rays)
    r = np.linalg.norm(disk.crossing[:, 0].astype(float), axis=-1)
    both = (r > 1.01 * NARROW) & (r < 0.99 * WIDE) & (ring.met[:, 0, 0] >= 0)
    assert np.mean(both) > 0.5 and np.mean(((r > 1.01 * NARROW) & (r < 0.99 * WIDE)) != both) < 0.01
    apart = np.linalg.norm(ring.met_place[both, 0, :2] - disk.crossing[both, 0], axis=1) / r[both]
    assert np.quantile(apart, 0.99) < 1e-5, "float32 rounds two ways of finding one root; models in Cartesian space march where the other takes a closed form"


def test_what_is_nearer_along_the_ray_hides_what_is_farther(renderer: Renderer) -> None:
    """A ring round the disk, tilted: before the hole it hides the disk, behind it the disk's near part hides the ring."""
    scene = presets.load(["kerr", "smooth"], {"disk.opacity": 1.0, "camera.inclination_deg": 80.0})
    with_ring = scene.with_values(
        {"things.ring.kind": "annulus", "things.ring.inner_radius": 11.0, "things.ring.outer_radius": 13.0, "things.ring.tilt_deg": 30.0}
    )
    renderer.render(with_ring, 0.0, (240, 135))
    hits = renderer.hits()
    met, crossed = hits.met[..., 0, 0] >= 0, np.linalg.norm(hits.crossing[..., 0, :], axis=-1)
    on_disk = (crossed > plan(scene).disk_inner) & (crossed < 10.0)
    before, behind = met & (hits.met[..., 0, 2] == 0), met & on_disk & (hits.met[..., 0, 2] == 1)
    assert before.sum() > 500 and behind.sum() > 20
    assert np.all(crossed[before] == 0.0), "a ray that has ended crosses nothing"


def test_a_ring_that_shows_no_pixel_changes_none(renderer: Renderer) -> None:
    """It is there, behind the camera: the rays are marched in the world's frame and stopped for its sake, and go where they went."""
    scene = presets.load(["kerr"], {"camera.azimuth_deg": 0.0})
    renderer.render(scene, 0.0, (160, 90))
    plain = renderer.hits()
    ring = {
        "things.ring.kind": "annulus",
        "things.ring.inner_radius": 900.0,
        "things.ring.outer_radius": 901.0,
        "things.ring.tilt_deg": 90.0,
        "things.ring.node_deg": 90.0,
    }
    renderer.render(scene.with_values(ring), 0.0, (160, 90))
    found = renderer.hits()
    seen = found.fate == Fate.MET
    assert np.mean(seen) < 0.05
    np.testing.assert_array_equal(found.fate[~seen], plain.fate[~seen])
    assert np.quantile(np.linalg.norm(found.direction - plain.direction, axis=-1)[~seen], 0.99) < 1e-5


def test_nothing_of_it_is_compiled_or_kept_without_things(renderer: Renderer) -> None:
    """A scene never pays for what it does not show."""
    renderer.render(presets.load(["kerr"]), 0.0, (18, 10))
    assert renderer.hits().met is None and len(renderer.hit_map.textures) == 3


def test_a_slider_of_a_thing_compiles_nothing_and_traces_anew(renderer: Renderer) -> None:
    scene = presets.load(["kerr"], {"things.ring.kind": "annulus"})
    renderer.render(scene, 0.0, (36, 20))
    compiled = renderer.programs.compiled
    wider = scene.with_values({"things.ring.outer_radius": 20.0})
    assert renderer.render(wider, 0.0, (36, 20)).traced and not renderer.render(wider, 1.0, (36, 20)).traced
    second = wider.with_values({"things.other.kind": "annulus", "things.other.tilt_deg": 60.0})
    assert renderer.render(second, 0.0, (36, 20)).traced
    assert renderer.programs.compiled == compiled


@pytest.mark.parametrize("model", ["schwarzschild_table", "weak_field"])
def test_a_model_that_tells_no_paths_gives_way(renderer: Renderer, model: str) -> None:
    made = plan(_scene(model, **_ring()))
    assert made.model.key == "schwarzschild" and any("cannot meet things" in reason for reason in made.reasons)
    renderer.render(made.scene, 0.0, (36, 20))
    assert np.any(renderer.hits().fate == Fate.MET)


FOG = """/*---
label = "Fog"
summary = "A uniform ball about the hole that dims each colour by itself and shines by itself."
source = "own"
slot = "medium"
reach = ["radius"]

[parameters]
radius = { default = 4.0, range = [0.1, 50.0], unit = "r_s", help = "Its radius." }
---*/
float medium_fog_distance(int i, vec3 x) {
    return length(x) - medium_fog_radius(i);
}

float medium_fog_scale(int i, vec3 x) {
    return medium_fog_radius(i);
}

Matter medium_fog_matter(int i, Sight sight) {
    return Matter(vec3(0.1, 0.2, 0.4), vec3(0.1, 0.2, 0.4), 1.0);
}
"""

DRAW_FOG = """
import math
import numpy as np
from blackhole_gl.rendering.context import create_headless
from blackhole_gl.rendering.frame import Renderer
from blackhole_gl.scene import presets

renderer = Renderer(create_headless())
quiet = {"rays.lensing": False, "hole.spin": 0.0, "disk.enabled": False, "sky.enabled": False, "post.bloom": False, "camera.fov_deg": 60.0, "rays.edges": 1}
quiet["rays.medium_step"] = 0.25  # with the 0.5 that it comes with, rays that graze the black ball are off by 1.1e-4
scale = math.tan(math.radians(30.0)) / 60
x, y = np.meshgrid((2 * (np.arange(90) + 0.5) - 90) * scale, (2 * (np.arange(60)[::-1] + 0.5) - 60) * scale)
cosine = 1.0 / np.sqrt(1.0 + x**2 + y**2)

def chord(distance, radius):
    root = np.sqrt(np.maximum(radius**2 - distance**2 * (1.0 - cosine**2), 0.0))
    whole = np.where(root > 0.0, distance * cosine + root - np.maximum(distance * cosine - root, 0.0), 0.0)
    inner = 1.0 - distance**2 * (1.0 - cosine**2)  # the black ball ends the ray
    return np.where(inner > 0.0, distance * cosine - np.sqrt(np.maximum(inner, 0.0)) - np.maximum(distance * cosine - root, 0.0), whole)

def light(way):
    return 1.0 - np.exp(-way[..., None] * np.array([0.1, 0.2, 0.4]))

def gathered(renderer):
    return renderer.transfer.read()[0][0, ::-1]

for distance in (20.0, 2.5):  # outside of it, and inside
    scene = presets.load(["kerr"], {**quiet, "media.haze.kind": "fog", "camera.distance": distance})
    renderer.render(scene, 0.0, (90, 60))
    expected = light(chord(distance, 4.0))
    assert np.quantile(np.abs(renderer.radiance() - expected), 0.99) < 1e-3  # half floats
    there = chord(distance, 4.0) > 0.3  # a grazing ray's chord is as uncertain as the root of where it runs
    off = np.abs(gathered(renderer) - expected)[there]
    assert off.max() < 1e-4, (distance, off.max())

def mean(**values):
    renderer.render(presets.load(["kerr"], {**quiet, "camera.distance": 20.0, **values}), 0.0, (90, 60))
    return renderer.radiance()

alone = {"media.haze.kind": "fog"}
inside = mean(**alone, **{"media.mist.kind": "fog", "media.mist.radius": 2.0})
outside = mean(**{"media.haze.kind": "fog", "media.haze.radius": 2.0, "media.mist.kind": "fog"})
assert np.max(np.abs(inside - outside)) < 1e-3  # whichever is named first
way = chord(20.0, 4.0)
off = np.abs(inside - light(way + chord(20.0, 2.0)))[(way == 0.0) | (way > 0.3)]  # but for what grazes, as above
assert off.max() < 1e-3, off.max()  # one within the other: both have the whole of their ways
ring = {"things.wall.kind": "annulus", "things.wall.inner_radius": 5.0, "things.wall.outer_radius": 30.0}
before = mean(**ring, **{"camera.inclination_deg": 80.0})
behind = mean(**ring, **alone, **{"camera.inclination_deg": 80.0})
assert np.mean(np.abs(behind - before) > 0.01) > 0.02  # a thing behind a medium leaves it its way
"""


def test_a_ball_of_fog_has_the_light_of_its_chords(tmp_path: Path) -> None:
    """Uniform, in flat space: I = 1 − exp(−αc) along a chord c, each colour by itself; what is marched is good to 1e-4, radiance is in half floats."""
    file = tmp_path / "shaders" / "media" / "fog.glsl"
    file.parent.mkdir(parents=True)
    file.write_text(FOG, encoding="utf-8")
    environment = {**os.environ, "BLACKHOLE_GL_CONFIG_DIR": str(tmp_path), "PYTHONPATH": str(ROOT)}
    done = subprocess.run([sys.executable, "-c", DRAW_FOG], cwd=tmp_path, env=environment, capture_output=True, text=True, timeout=120)
    assert done.returncode == 0, done.stderr
