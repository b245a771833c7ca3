"""Twins are found by the names they register under, and say themselves what they take."""

from __future__ import annotations

import inspect

import pytest

from blackhole_gl import reference
from blackhole_gl.reference import registry
from blackhole_gl.scene import Scene, catalogue


def test_every_ray_model_has_a_twin_and_every_twin_a_ray_model():
    assert set(reference.models()) == set(catalogue.plug_ins("ray_model"))


OF_THE_DISK = {"rays.kerr_like.flow", "rays.kerr_like.pattern"}
"""Parameters of ray models that act on the disk alone and on no ray."""


@pytest.mark.parametrize("model", reference.models())
def test_a_twin_takes_what_it_declares_and_every_parameter_of_its_model(model):
    twin = reference.twin_of(model)
    accepted = set(inspect.signature(twin.trace).parameters) - {"view"}
    assert set(twin.parameters) == accepted
    for key in twin.parameters.values():
        Scene().get(key)
    assert set(catalogue.plug_ins("ray_model")[model].parameters) - OF_THE_DISK <= set(twin.parameters.values())


def test_a_twin_knows_of_spin_what_its_model_knows():
    for model, plug_in in catalogue.plug_ins("ray_model").items():
        assert reference.twin_of(model).spins == plug_in.traits.spins, model


def test_a_function_becomes_a_twin_by_its_decorator_alone(monkeypatch):
    monkeypatch.setattr(registry, "_TWINS", dict(registry._TWINS))
    straight = reference.twin_of("flat").trace

    @reference.twin("my_model", metric="flat", spins=False, parameters={"size": "hole.horizon_size"})
    def my_model(view, size=1.0):
        return straight(view, 2.0 * size)

    found = reference.trace("my_model", distance=10.0, inclination_deg=60.0, directions=[[-1, 0.18, 0]], size=1.0)
    assert found.fate[0] == reference.CAPTURED
    assert "my_model" in reference.models()
    with pytest.raises(ValueError, match="two twins"):
        reference.twin("my_model", metric=None)(my_model)


def test_an_unknown_model_is_told_which_there_are():
    with pytest.raises(ValueError, match="'newton' has no float64 twin.*flat, kerr, kerr_like.*weak_field"):
        reference.twin_of("newton")


def test_an_unknown_parameter_is_told_which_there_are():
    with pytest.raises(ValueError, match="kerr_like takes no pull; it takes gravity_strength, horizon_size, drag"):
        reference.trace("kerr_like", distance=10.0, inclination_deg=60.0, directions=[[-1, 0, 0]], pull=2.0)
    with pytest.raises(ValueError, match="kerr takes no drag; it takes no parameters"):
        reference.trace("kerr", distance=10.0, inclination_deg=60.0, directions=[[-1, 0, 0]], drag=2.0)


def test_an_unknown_metric_is_told_which_there_are():
    with pytest.raises(ValueError, match="flat, schwarzschild, kerr and None"):
        reference.twin("another", metric="newton")
