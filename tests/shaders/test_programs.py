"""Programs are compiled when they may be, and no more of them are kept than a few scenes need."""

import math

import pytest

from blackhole_gl.planning import plan
from blackhole_gl.rendering import frame, programs, structure
from blackhole_gl.rendering.inputs import FrameInputs
from blackhole_gl.scene import Scene, presets

SIZE = (18, 12)


@pytest.fixture
def renderer(ctx):
    made = frame.Renderer(ctx)
    yield made
    made.release()
    made.programs.release()


def test_nothing_is_compiled_after_the_deadline(renderer):
    renderer.programs.deadline = -math.inf
    with pytest.raises(programs.Unready):
        renderer.render(Scene(), 0.0, SIZE)
    assert renderer.programs.compiled == 0
    renderer.programs.deadline = math.inf
    renderer.render(Scene(), 0.0, SIZE)
    compiled = renderer.programs.compiled
    assert compiled > 0
    renderer.programs.deadline = -math.inf
    renderer.render(Scene().with_values({"camera.distance": 15.0, "disk.opacity": 0.2}), 1.0, SIZE)
    assert renderer.programs.compiled == compiled, "a slider compiles nothing"


def test_however_late_it_is_a_frame_compiles_one_program(renderer):
    """Or a scene whose drawing takes longer than the time until the deadline would never have all of its programs."""
    frames = 0
    while True:
        before, renderer.programs.deadline = renderer.programs.compiled, 0.0
        try:
            renderer.render(Scene(), 0.0, SIZE)
            break
        except programs.Unready:
            assert renderer.programs.compiled == before + 1
            frames += 1
            assert frames < 50
    assert frames > 5


def test_rays_at_edges_take_the_programs_of_all_others(renderer):
    """A scene has a third less to compile than when those in blocks had programs of their own."""
    alone, several = (Scene().with_values({"rays.edges": edges}) for edges in (1, 4))
    renderer.render(alone, 0.0, SIZE)
    before = renderer.programs.compiled
    renderer.render(several, 0.0, SIZE)
    assert renderer.edges.rays_a_pixel == 16 and renderer.programs.compiled == before + 1, "their mean alone is something new"


def test_the_programs_used_last_are_kept(renderer, monkeypatch):
    renderer.render(Scene(), 0.0, SIZE)
    needed = renderer.programs.compiled
    monkeypatch.setattr(programs, "MOST_KEPT", needed)
    renderer.render(Scene(), 1.0, SIZE)
    assert renderer.programs.compiled == needed
    other = Scene().with_values({"post.tone_map": "agx"})
    renderer.render(other, 0.0, SIZE)
    compiled = renderer.programs.compiled
    assert compiled > needed and len(renderer.programs._kept) == needed
    renderer.render(other, 1.0, SIZE)
    assert renderer.programs.compiled == compiled


MOVES = (
    {"camera.inclination_deg": 40.0, "camera.azimuth_deg": 77.0},
    {"camera.distance": 3.5},
    {"camera.fov_deg": 20.0, "camera.yaw_deg": 12.0},
    {"camera.observer": "fall"},
    {"camera.projection": "dome"},
    {"camera.distance": 60.0},
)


@pytest.mark.parametrize("preset", ["kerr", "schwarzschild", "gargantua_s1", "plunging_matter", "fish_eye", "cloudy_slab", "real_sky", "tilted_disk"])
def test_what_is_taken_for_the_same_text_is_the_same(preset):
    """Frames of a moving camera are not asked in full for what they are made of."""
    here, like = plan(presets.load([preset])), 0
    for values in MOVES:
        there = plan(presets.load([preset], values))
        if structure.told_apart(here) == structure.told_apart(there):
            like += 1
            assert structure.structure_of(here) == structure.structure_of(there), values
    assert like


def test_a_camera_that_only_moves_is_asked_once_for_what_its_programs_are_made_of(renderer, monkeypatch):
    asked, plain = [], structure.structure_of
    monkeypatch.setattr(programs, "structure_of", lambda made: asked.append(made) or plain(made))
    scene = presets.load(["kerr"])
    for turn in range(5):
        made = plan(scene.with_values({"camera.inclination_deg": 60.0 + turn, "camera.azimuth_deg": 10.0 * turn}))
        renderer.programs.get("trace.frag", FrameInputs.whole(made, 0.0, SIZE))
    assert len(asked) == 1
    renderer.programs.get("trace.frag", FrameInputs.whole(plan(scene.with_values({"disk.enabled": False})), 0.0, SIZE))
    assert len(asked) == 2
