"""Models, integrators and step controls: the catalogue knows which fit, every one that fits works, and the others are refused with the reason."""

from __future__ import annotations

import math
from collections.abc import Iterable

import numpy as np
import pytest

from blackhole_gl import listed_rays
from blackhole_gl.planning import plan
from blackhole_gl.rendering.frame import Renderer
from blackhole_gl.scene import catalogue, presets
from tests.portability.every_program import pairs

MARCHED = [key for key, model in catalogue.plug_ins("ray_model").items() if model.traits.kind == "differential"]
HOLES = [key for key in MARCHED if not catalogue.plug_ins("ray_model")[key].traits.field]


def test_what_does_not_fit_and_why() -> None:
    assert "kerr_schild" in catalogue.reasons_against("kerr_schild", "verlet", "mino")[0]
    assert "rates" in catalogue.reasons_against("post_newtonian_drag", "verlet", "radius")[0]
    assert "rk4 has none" in catalogue.reasons_against("kerr", "rk4", "embedded")[0]
    assert "march in cartesian" in catalogue.reasons_against("kerr", "rk4", "fixed")[0]
    assert len(catalogue.reasons_against("kerr_schild", "verlet", "embedded")) == 2
    assert catalogue.reasons_against("flat", "verlet", "embedded") == []


@pytest.mark.parametrize("model", MARCHED)
def test_a_model_s_own_step_control_fits_it(model: str) -> None:
    own = catalogue.plug_ins("ray_model")[model].traits.step_control
    assert catalogue.reasons_against(model, "rk4", own) == []


@pytest.mark.parametrize("model", HOLES)
def test_every_part_that_fits_traces_rays(renderer: Renderer, model: str) -> None:
    check(renderer, model, pairs(model))


@pytest.mark.slow
@pytest.mark.parametrize("model", HOLES)
def test_every_pair_that_fits_traces_rays(renderer: Renderer, model: str) -> None:
    check(renderer, model, pairs(model, every_pair=True))


def check(renderer: Renderer, model: str, methods: Iterable[tuple[str, str]]) -> None:
    """Rays well away from the shadow's edge get their fate and about their direction by each pair of integrator and step control."""
    b = np.array([0.5, 1.5, 7.0, 9.0, 12.0])
    rays = np.stack([np.arcsin(b / 20.0), np.array([0.3, 2.0, 3.5, 5.0, 1.0])], axis=-1)
    values = {"rays.model": model, "rays.step_angle": 0.05, "rays.step_length": 0.05, "rays.max_steps": 20000, "camera.distance": 20.0, "hole.spin": 0.3}
    twin = None
    for integrator, control in methods:
        scene = presets.load(["kerr"], values | {"rays.integrator": integrator, "rays.step_control": control})
        assert (plan(scene).integrator.key, plan(scene).step_control.key) == (integrator, control)
        found = listed_rays.trace_by_shader(renderer, scene, rays)
        twin = twin or listed_rays.trace_by_reference(scene, rays)
        np.testing.assert_array_equal(found.fate, twin.fate, err_msg=f"{model}, {integrator}, {control}")
        off = np.nanmax(np.linalg.norm(found.direction - twin.direction, axis=1))
        bound = 0.2 if integrator == "euler" else 3e-3
        assert math.isfinite(off) and off < bound, f"{model}, {integrator}, {control}: {off:.1e} rad"
