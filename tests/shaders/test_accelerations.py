"""Early termination, step doubling and bounding volumes change no picture, alone or together; the suite of 2004 measures what they save."""

from __future__ import annotations

import re
from dataclasses import replace

import numpy as np
import pytest

from blackhole_gl import cli
from blackhole_gl.measure import weiskopf
from blackhole_gl.rendering.frame import Renderer
from blackhole_gl.scene import SceneError

SIZE = (64, 48)
# Steps that err so little that doubling may choose others: what differs then are the accelerations themselves.
FINE = {"rays.integrator": "rk4", "rays.step_length": 0.1, "rays.doubling.tolerance": 1e-5, "rays.field_way": 80.0, "rays.max_steps": 800, "rays.edges": 1}


def picture(renderer: Renderer, model: str, values: dict) -> np.ndarray:
    renderer.render(weiskopf.scene_of(model, 10, {**values, **FINE}), 0.0, SIZE)
    assert np.all(renderer.hits().fate != 0)
    return renderer.read_rgb8().astype(int)


@pytest.mark.slow
@pytest.mark.parametrize("model", weiskopf.PUBLISHED)
def test_accelerations_change_no_picture(renderer: Renderer, model: str) -> None:
    known = {name: picture(renderer, model, values) for name, values in weiskopf.ACCELERATIONS.items() if name != "plain"}
    whole = picture(renderer, model, {**weiskopf.ACCELERATIONS["early end"], "rays.bounds": True})
    assert whole.max() > 100, "there is something to see"
    for name, seen in known.items():
        same = np.all(np.abs(seen - whole) <= 1, axis=-1)
        print(f"{model}, {name}: {np.mean(same):.4f} of the pixels")
        assert np.mean(same) >= 0.999, name


def test_a_march_without_an_early_end_takes_all_its_steps(renderer: Renderer) -> None:
    for model in ("lorenz", "schwarzschild"):
        made = weiskopf.plan_of(weiskopf.scene_of(model, 3, weiskopf.ACCELERATIONS["bounds"]))
        renderer.time_trace(made, (16, 12))
        hits = renderer.hits()
        assert np.all(hits.steps == weiskopf.STEPS)
        renderer.time_trace(weiskopf.plan_of(weiskopf.scene_of(model, 3, weiskopf.ACCELERATIONS["all"])), (16, 12))
        assert renderer.hits().steps.mean() < 0.5 * weiskopf.STEPS


def test_the_suite_s_tables_have_a_row_for_every_model_and_number() -> None:
    frames = [weiskopf.Frame(model, name, 10, 2.0 if name == "plain" else 0.5, 100.0) for model in weiskopf.PUBLISHED for name in weiskopf.ACCELERATIONS]
    figure = [weiskopf.Frame("lorenz", "all", count, 0.01 * count, 100.0) for count in weiskopf.COUNTS]
    found = weiskopf.Suite("a machine", "a renderer", 800, 600, 1, tuple(frames), tuple(figure))
    text = weiskopf.text(found)
    assert "| schwarzschild | 2.00 | 4.00 |" in text and "| 4.91 | 3.79 | 1.30 |" in text and "| 1000 | – | 10.00 |" in text
    assert replace(found, rounds=2).as_dict()["rounds"] == 2


@pytest.mark.parametrize(
    "arguments, wanted",
    [(["--suite", "all"], "'all'; allowed is one of frames, weiskopf"), (["--suite", "weiskopf", "-p", "kerr"], "allowed beside it are --size once")],
)
def test_the_command_says_what_it_cannot_measure(arguments: list[str], wanted: str) -> None:
    with pytest.raises(SceneError, match=re.escape(wanted)):
        cli.run(["bench", *arguments])


@pytest.mark.slow
def test_the_suite_runs(renderer: Renderer) -> None:
    found = weiskopf.measure(renderer, (32, 24))
    seconds = {(frame.model, frame.name): frame.seconds for frame in found.table}
    for model in weiskopf.PUBLISHED:
        assert all(seconds[model, "plain"] > seconds[model, name] for name in ("early end", "bounds", "all")), model
