"""Frame dragging of `kerr_like`: three effects with a switch each, and none of them without dragging."""

from __future__ import annotations

import numpy as np
import pytest

from blackhole_gl.rendering.frame import Renderer
from blackhole_gl.scene import Scene, presets

SIZE = (160, 90)
EFFECTS = ("twist", "flow", "pattern")


def scene_with(*effects: str, drag: float = 6.0, **values: object) -> Scene:
    chosen = {f"rays.kerr_like.{name}": name in effects for name in EFFECTS}
    own = {key.replace("__", ".", 1): value for key, value in values.items()}
    return presets.load(["kerr"]).with_values({"rays.model": "kerr_like", "rays.kerr_like.drag": drag, "sky.enabled": False, **chosen, **own})


def light(renderer: Renderer, scene: Scene, time: float = 47.0) -> np.ndarray:
    renderer.render(scene, time, SIZE)
    return renderer.radiance().astype(float)


@pytest.mark.parametrize("law", ["exact", "s0", "s1"])
@pytest.mark.parametrize("effect", EFFECTS)
def test_each_effect_changes_the_picture_and_without_dragging_not_one_bit(renderer: Renderer, effect: str, law: str) -> None:
    none = light(renderer, scene_with(disk__frequency_shift=law))
    np.testing.assert_array_equal(light(renderer, scene_with(effect, drag=0.0, disk__frequency_shift=law)), none)
    assert np.mean(np.abs(light(renderer, scene_with(effect, disk__frequency_shift=law)) - none).max(axis=-1) > 0.01) > 0.05


def test_the_effects_are_apart(renderer: Renderer) -> None:
    """The flow changes no pattern and the pattern no flow: a smooth disk knows none of the latter, and a disk without Doppler effects none of the former."""
    smooth = {"disk__turbulence": False}
    np.testing.assert_array_equal(light(renderer, scene_with("pattern", **smooth)), light(renderer, scene_with(**smooth)))
    still = {"disk__beaming": False, "disk__doppler_colour": False, "disk__redshift": False}
    np.testing.assert_array_equal(light(renderer, scene_with("flow", **still)), light(renderer, scene_with(**still)))


def test_dragged_matter_is_brighter_where_it_approaches(renderer: Renderer) -> None:
    smooth = {"disk__turbulence": False, "disk__redshift": False}
    dragged, plain = light(renderer, scene_with("flow", **smooth)), light(renderer, scene_with(**smooth))
    middle = SIZE[0] // 2
    assert dragged[:, :middle].sum() > 1.05 * plain[:, :middle].sum()
    assert dragged[:, middle:].sum() < 0.98 * plain[:, middle:].sum()
