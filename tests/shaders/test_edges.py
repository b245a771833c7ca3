"""Several rays in the pixels at edges: the rings are lines and not rows of dots while time runs, and as bright as they are.

The reference is the same picture six times as large, its radiance averaged: 36 rays a pixel, each with its own footprint. The disk is smooth and the sky dark,
as the detail of either depends on the size that a picture is drawn in.
"""

from __future__ import annotations

from functools import cache

import numpy as np
import pytest

from blackhole_gl.glsl.declared import Fate
from blackhole_gl.physics.observer import look_rotation
from blackhole_gl.planning import plan
from blackhole_gl.rendering.frame import Renderer
from blackhole_gl.rendering.inputs import FrameInputs
from blackhole_gl.scene import Scene, met, presets

FINER = 6
SIZE = (640, 360)
SMALL = (240, 136)

SMOOTH = {"disk.turbulence": False, "sky.enabled": False}
SCENES = {
    "kerr, a* = 0.9": {"hole.spin": 0.9},
    "kerr, a* = 0.998": {"hole.spin": 0.998},
    "schwarzschild": {"hole.spin": 0.0, "rays.model": "schwarzschild"},
}


def displayed(radiance: np.ndarray) -> np.ndarray:
    """Grey levels 0…255 of radiance (…, 3): what stands out on a screen, without the tone curves that presets choose."""
    return 255.0 * np.mean(radiance / (1.0 + radiance), axis=-1)


@cache
def reference(renderer: Renderer, scene: Scene, size: tuple[int, int]) -> np.ndarray:
    """`displayed` of the picture with `FINER`² rays a pixel, drawn in parts of its own size, row 0 on top: once for all that ask for it."""
    width, height = size
    made, finer = plan(scene.with_values({"rays.edges": 1})), (FINER * width, FINER * height)
    rows = []
    for y in range(0, finer[1], height):
        parts = []
        for x in range(0, finer[0], width):
            inputs = FrameInputs(made, 1.0, size, finer, (x, y))
            renderer._trace(inputs)
            renderer._shaded(inputs, renderer.hit_map)
            parts.append(renderer.radiance()[::-1])
        rows.append(np.concatenate(parts, axis=1))
    whole = np.concatenate(rows)[::-1]
    return displayed(whole.reshape(height, FINER, width, FINER, 3).mean(axis=(1, 3)))


def edges_of(renderer: Renderer, size: tuple[int, int]) -> np.ndarray:
    """Which pixels have several rays, bool (height, width), row 0 on top."""
    found = np.zeros(size[::-1], bool)
    columns, rows = renderer.edges.pixels.T
    found[rows, columns] = True
    return found[::-1]


def grown(mask: np.ndarray) -> np.ndarray:
    """With all pixels that touch one of them."""
    padded = np.pad(mask, 1)
    height, width = mask.shape
    return np.any([padded[y : y + height, x : x + width] for y in range(3) for x in range(3)], axis=0)


def scan(picture: np.ndarray, ring: np.ndarray, shadow: np.ndarray) -> float:
    """How much the light of the `ring` changes from place to place along it: the deviation from its mean over nine neighbours, of 240 round it."""
    middle = np.argwhere(shadow).mean(axis=0)
    y, x = np.nonzero(ring)
    place = (np.arctan2(y - middle[0], x - middle[1]) / (2.0 * np.pi) % 1.0 * 240).astype(int)
    light = np.bincount(place, picture[ring], 240) / np.maximum(np.bincount(place, minlength=240), 1)
    return float(np.std(light - np.convolve(np.concatenate([light[-4:], light, light[:4]]), np.ones(9) / 9, "valid")))


def rings_of(renderer: Renderer) -> np.ndarray:
    """The pixels of the first and the second ring, and those beside them: where such a crossing lies on the disk and no nearer one hides it."""
    hits, made = renderer.hits(), renderer.hit_map._traced.plan
    r = np.linalg.norm(hits.crossing, axis=-1)
    on_disk = (r >= made.disk_inner) & (r <= made.disk_outer)
    return grown(((on_disk[..., 1] & ~on_disk[..., 0]) | on_disk[..., 2])[::-1])


def check_rings(renderer: Renderer, scene: Scene, size: tuple[int, int]) -> dict[str, float]:
    """Holds a picture while time runs to the reference. The bounds are those that the rings were to be drawn within; returns what was found."""
    fine = reference(renderer, scene, size)
    renderer.render(scene.with_values({"rays.edges": 1}), 1.0, size)
    one, captured, rings = displayed(renderer.radiance()), renderer.fates_and_steps()[0][::-1] == 2, rings_of(renderer)
    renderer.render(scene, 0.0, size)
    traces = renderer.edges.traces
    renderer.render(scene, 1.0, size)
    assert renderer.edges.traces == traces, "rays are kept while time runs"
    several, edges = displayed(renderer.radiance()), edges_of(renderer, size)
    band = grown(grown(captured) & grown(~captured))
    brightest = np.max([np.roll(fine, (y, x), (0, 1)) for y in (-1, 0, 1) for x in (-1, 0, 1)], axis=0)
    found = {
        "pixels": edges.mean(),
        "error": np.abs(several - fine)[rings].mean() / np.abs(one - fine)[rings].mean(),
        "error of the band": np.abs(several - fine)[band].mean() / np.abs(one - fine)[band].mean(),
        "scan": scan(several, band, captured) / scan(fine, band, captured),
        "light": several[band].sum() / fine[band].sum(),
        "brighter than all beside": (several - brightest)[band].max(),
    }
    assert found["pixels"] < 0.02, found
    assert found["error"] < 0.2, found
    assert 0.9 < found["scan"] < 1.1 and 0.9 < found["light"] < 1.1, found
    assert found["brighter than all beside"] < 16.0, found  # grey levels: a sixteenth of the scale stands out from no ring
    return found


@pytest.mark.parametrize("name", SCENES)
def test_rings_are_lines_while_time_runs(renderer: Renderer, name: str) -> None:
    check_rings(renderer, presets.load(["kerr"], {**SMOOTH, **SCENES[name]}), SIZE)


@pytest.mark.slow
@pytest.mark.parametrize("name", SCENES)
def test_rings_are_lines_in_a_window(renderer: Renderer, name: str) -> None:
    found = check_rings(renderer, presets.load(["kerr"], {**SMOOTH, **SCENES[name]}), (1280, 720))
    print(name, found)
    # Known to fall short: sixteen rays are too few for a fifth in the narrow band by the critical curve alone, in two of the three (docs/performance.md).
    assert (found["error of the band"] < 0.2) == (name == "kerr, a* = 0.9"), found


def test_rings_are_finer_under_a_moving_camera_too(renderer: Renderer) -> None:
    """Four rays instead of sixteen; where the camera moves no still reference would be seen, so only half of the error has to go."""
    scene = presets.load(["kerr"], {**SMOOTH, **SCENES["schwarzschild"]})
    fine = reference(renderer, scene, SIZE)
    pictures = []
    for edges in (1, 4):
        renderer.hit_map.forget()
        report = renderer.render(scene.with_values({"rays.edges": edges}), 1.0, SIZE, progressive=True)
        assert not report.sharp
        pictures.append(displayed(renderer.radiance()))
    edges = edges_of(renderer, SIZE)
    assert edges.any()
    one, several = (np.abs(picture - fine)[edges].mean() for picture in pictures)
    assert several < 0.5 * one


@pytest.mark.parametrize("values", [SCENES["schwarzschild"], {**SCENES["schwarzschild"], "camera.inclination_deg": 60.0}])
def test_no_edge_lies_where_crossings_run_into_the_hole(renderer: Renderer, values: dict) -> None:
    """Inside the shadow, where light that went further would have come through the disk's plane once more: nothing is to be seen on either side."""
    renderer.render(presets.load(["kerr"], {**SMOOTH, **values}), 1.0, SIZE)
    hits, edges = renderer.hits(), edges_of(renderer, SIZE)
    captured = (hits.fate == int(Fate.CAPTURED))[::-1]
    none = np.all(hits.crossing[::-1][..., 1:, :] == 0.0, axis=(-2, -1))
    inside = captured & ~grown(~captured)
    run_in = inside & grown(none & captured) & ~none
    assert run_in.sum() > 20 and not np.any(edges & run_in)


@pytest.mark.parametrize("name", SCENES)
@pytest.mark.parametrize("share", [4, 3])
def test_rings_of_a_moving_picture_that_is_drawn_coarse_are_no_beads(renderer: Renderer, share: int, name: str) -> None:
    """A ring is a few hundredths of such a pixel wide: four rays of it met it or did not."""
    scene = presets.load(["kerr"], {**SMOOTH, **SCENES[name]})
    size = 1280 // share, 720 // share
    fine = reference(renderer, scene, size)
    errors = {}
    for edges in (1, 2, 4):
        renderer.hit_map.forget()
        renderer.render(scene.with_values({"rays.edges": edges}), 1.0, size, progressive=True, shown=(1280, 720))
        errors[edges] = np.abs(displayed(renderer.radiance()) - fine)
        there = edges_of(renderer, size)
    one, four, sixteen = (errors[edges][there].mean() for edges in (1, 2, 4))
    assert renderer.edges.rays_a_pixel == 16 and four < 0.6 * one and sixteen < 0.4 * four, "measured are 0.15 to 0.36"
    renderer.render(scene, 1.0, size, progressive=True, shown=size)
    assert renderer.edges.rays_a_pixel == 4, "as many rays on the screen as where the picture is coarse"


def test_one_ray_a_pixel_is_left_alone(renderer: Renderer) -> None:
    renderer.render(presets.load(["kerr"], {"rays.edges": 1}), 1.0, SIZE)
    assert len(renderer.edges.pixels) == 0


def test_odd_numbers_count_as_the_next_even_one(renderer: Renderer) -> None:
    pictures = []
    for edges in (3, 4):
        renderer.render(presets.load(["kerr"], {"rays.edges": edges}), 1.0, SIZE)
        pictures.append(renderer.read_rgb8())
    np.testing.assert_array_equal(*pictures)


def test_silhouettes_of_things_are_edges(renderer: Renderer) -> None:
    """A ring in a tilted plane hides the sky, and has no cover of its own that is smooth."""
    scene = presets.load(["kerr"], {**SMOOTH, "disk.enabled": False, "things.ring.kind": "annulus"})
    fine = reference(renderer, scene, SMALL)
    pictures = []
    for edges in (1, 4):
        renderer.render(scene.with_values({"rays.edges": edges}), 1.0, SMALL)
        pictures.append(displayed(renderer.radiance()))
    edges = edges_of(renderer, SMALL)
    one, several = (np.abs(picture - fine)[edges].mean() for picture in pictures)
    assert edges.any() and several < 0.2 * one


@pytest.mark.parametrize("moving", [False, True])
@pytest.mark.parametrize("values", [{}, {"camera.yaw_deg": 12.0, "camera.roll_deg": 30.0}])
def test_the_rim_of_a_field_is_an_edge(renderer: Renderer, values: dict, moving: bool) -> None:
    """The disk is seen within it and beside it: no fate changes, no ring begins, and still what is seen breaks off."""
    scene = met.without_any(presets.load(["fish_eye"], {**SMOOTH, "disk.enabled": True, **values}))
    fine = reference(renderer, scene, SMALL)
    pictures = []
    for edges in (1, 4):
        renderer.hit_map.forget()
        renderer.render(scene.with_values({"rays.edges": edges}), 1.0, SMALL, progressive=moving)
        pictures.append(displayed(renderer.radiance()))
    rim = rim_of_field(renderer, SMALL) & edges_of(renderer, SMALL)
    assert rim.sum() > 0.95 * rim_of_field(renderer, SMALL).sum()
    one, several = (np.abs(picture - fine)[rim].mean() for picture in pictures)
    # Steps of a quarter and of half a pixel instead of whole ones; grey levels are not linear in bright light, of which a few rays make more than their share.
    assert several < (0.6 if moving else 0.25) * one


def test_the_rim_of_a_field_with_things_in_it_keeps_its_one_ray_while_the_camera_moves(renderer: Renderer) -> None:
    """As their outlines do; at rest it has several."""
    scene, shares = presets.load(["fish_eye"]), []
    for moving in (False, True):
        renderer.hit_map.forget()
        renderer.render(scene, 1.0, SMALL, progressive=moving)
        shares.append(edges_of(renderer, SMALL)[rim_of_field(renderer, SMALL)].mean())
    assert shares[0] > 0.95 and shares[1] < 0.4


def rim_of_field(renderer: Renderer, size: tuple[int, int]) -> np.ndarray:
    """The pixels that the circle goes through at which rays come into the field's sphere, bool (height, width), row 0 on top: by NumPy from the camera."""
    scene, (width, height) = renderer.hit_map._traced.plan.scene, size
    half = np.tan(np.radians(0.5 * scene.camera.fov_deg))
    y, x = np.mgrid[height:-1:-1, 0 : width + 1]
    corner = np.stack([-np.ones(x.shape), half * (1.0 - 2.0 * y / height), half * (2.0 * x - width) / height], axis=-1)
    local = corner @ look_rotation(scene.camera).T
    angle = np.arctan2(np.hypot(local[..., 1], local[..., 2]), -local[..., 0])
    inside = angle < np.arcsin(scene.rays.field_radius / scene.camera.distance)
    corners = inside[1:, 1:].astype(int) + inside[1:, :-1] + inside[:-1, 1:] + inside[:-1, :-1]
    return (corners > 0) & (corners < 4)


def test_rays_that_are_marched_on_for_nothing_have_a_rim_too(renderer: Renderer) -> None:
    """So that steps do not tell which of them came into the sphere."""
    scene = met.without_any(presets.load(["fish_eye"], {"rays.early_end": False, "rays.max_steps": 100}))
    renderer.render(scene, 1.0, SMALL)
    assert edges_of(renderer, SMALL)[rim_of_field(renderer, SMALL)].mean() > 0.95


def test_a_camera_within_a_field_sees_no_rim(renderer: Renderer) -> None:
    scene = presets.load(["fish_eye"], {"camera.distance": 3.0, "camera.fov_deg": 150.0, "camera.yaw_deg": 60.0})
    renderer.render(met.without_any(scene), 1.0, SMALL)
    assert len(renderer.edges.pixels) == 0


def test_a_picture_at_rest_keeps_its_rings(renderer: Renderer) -> None:
    """The samples that follow the first must not bring the dots back, and sharpen everything else."""
    scene = presets.load(["kerr"], {**SMOOTH, **SCENES["schwarzschild"], "post.bloom": False, "post.dither": False})
    renderer.render_still(scene.with_values({"rays.edges": 8}), 1.0, SIZE)
    still = renderer.read_rgb8().astype(int)
    renderer.render(scene, 1.0, SIZE)
    edges = edges_of(renderer, SIZE)
    errors = []
    for asked in (1, 4):
        for _ in range(5):
            renderer.render_finer(scene.with_values({"rays.edges": asked}), 1.0, SIZE)
        errors.append(np.abs(renderer.read_rgb8() - still)[edges].mean())
    assert errors[1] < 0.5 * errors[0]


@pytest.mark.parametrize("values", [{"rays.lensing": False}, {"rays.refine": False}])
def test_pixels_at_edges_have_fewer_rays_while_the_camera_moves(renderer: Renderer, values: dict) -> None:
    """Whatever the map: that of a method that is not refined is sharp in every frame, and sixteen rays were traced anew in each. They are there at rest."""
    scene = presets.load(["kerr"], values)
    rays = []
    for moving in (True, False):
        renderer.render(scene, 1.0, SMALL, progressive=moving)
        rays.append(renderer.edges.rays_a_pixel)
    assert rays == [4, 16]


def test_plain_outlines_of_things_have_one_ray_under_a_moving_camera(renderer: Renderer) -> None:
    """The hole's edge, and what lies beside it, keep several."""
    scene = presets.load(["kerr"], {"disk.enabled": False, "things.ball.kind": "sphere", "things.ball.x": 8.0, "things.ball.y": -4.0})
    found = []
    for moving in (False, True):
        renderer.render(scene, 1.0, SMALL, progressive=moving)
        found.append({tuple(pixel) for pixel in renderer.edges.pixels.tolist()})
    hits = renderer.hits()
    ball = {tuple(pixel) for pixel in np.argwhere(hits.met[..., 0, 0] >= 0)[:, ::-1].tolist()}
    assert len(ball & found[0]) > 30 and not ball & found[1]
    assert len(found[1]) > 100


def test_edges_of_a_sharp_map_take_no_pass_of_their_own(renderer: Renderer, monkeypatch: pytest.MonkeyPatch) -> None:
    """A moving camera has them found anew in every frame: two passes over the whole picture took a fifth of a frame's time in flat space."""
    asked, plain = [], renderer.programs.get
    monkeypatch.setattr(renderer.programs, "get", lambda path, *given: asked.append(path) or plain(path, *given))
    renderer.render(presets.load(["kerr"], {"rays.lensing": False}), 1.0, SMALL, progressive=True)
    assert len(renderer.edges.pixels)
    assert [path for path in asked if path.startswith("edge_")] == ["edge_resolve.frag"]
