"""Has the shapes in array types (blackhole_gl/shapes.py) checked at every call, in modules where they are the contract: NumPy in, NumPy out.

Not in those whose functions are called thousands of times for a ray, the integrator, its events and the marched systems: it would double the time of every
test that asks a twin. What goes into a march and comes out of it is checked all the same, by `marching` and `hits`.

To be imported before any of these modules is.
"""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

from beartype import beartype
from jaxtyping import install_import_hook

CHECKED = (
    "blackhole_gl.listed_rays",
    "blackhole_gl.physics.disk_profile",
    "blackhole_gl.physics.observer",
    "blackhole_gl.physics.orbit_table",
    "blackhole_gl.reference.flat",
    "blackhole_gl.reference.hits",
    "blackhole_gl.reference.marching",
    "blackhole_gl.reference.observers",
    "blackhole_gl.reference.registry",
    "blackhole_gl.reference.schemes",
    "blackhole_gl.reference.tracing",
    "blackhole_gl.reference.weak_field",
    "blackhole_gl.rendering.hit_texels",
)

_KINDS = ("Bool[", "Float[", "Int[")


def arrays_alone(function: Callable[..., Any]) -> Callable[..., Any]:
    """`function`, checked for its arrays. All other types are pyrefly's: at run time whole numbers, which pass for float, would be refused."""
    function.__annotations__ = {name: hint for name, hint in function.__annotations__.items() if any(kind in str(hint) for kind in _KINDS)}
    return beartype(function)


install_import_hook(CHECKED, f"{__name__}.arrays_alone")
