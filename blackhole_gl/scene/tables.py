"""What plug-ins have Python make for them, as their headers declare it: textures to look things up in, constants, numbers of a frame."""

from __future__ import annotations

import importlib
import inspect
from collections.abc import Callable, Mapping
from dataclasses import dataclass, field, replace
from functools import cache, cached_property
from typing import Any, Literal

from .headers import CatalogueError
from .schema import nearest_key

TIME = "time"
"""What `of` calls the scene time in r_s/c, among keys of a scene: for numbers that no ray depends on."""

HOME = "blackhole_gl."
"""Modules that headers may name begin so: what a shader file names is run, and shader files are passed on."""


@dataclass(frozen=True)
class Made:
    """What a function of ours makes from values of a scene.

    Attributes:
        name: the GLSL name: of the sampler, or of the number.
        file: the plug-in's file, for errors.
        make: the function, ``blackhole_gl.physics.orbit_table:table``.
        of: keys of the scene whose values are its arguments; it is made anew when one of them changes, and only then.
    """

    name: str
    file: str = field(compare=False)
    make: str
    of: tuple[str, ...] = ()

    @property
    def place(self) -> str:
        """What errors begin with."""
        return f"{self.file}: {self.name}"

    def arguments(self, scene: Any) -> tuple[Any, ...]:
        """The values of `of` in `scene`.

        Raises:
            CatalogueError: a key that no scene has.
        """
        try:
            return scene.several(self.of)
        except ValueError:
            known = scene.values()
            unknown = next(key for key in self.of if key not in known)
            near = nearest_key(unknown, known)
            hint = f"; did you mean {near}?" if near else ""
            raise CatalogueError(f"{self.place}: of: got {unknown!r}; allowed are keys of a scene{hint}") from None

    def made(self, arguments: tuple[Any, ...]) -> Any:
        """What `make` makes of `arguments`.

        Raises:
            CatalogueError: there is no such function, or it takes other arguments.
        """
        return _function(self.make, len(self.of), self.place)(*arguments)


@dataclass(frozen=True)
class Table(Made):
    """A texture; `make` gives an array (rows, columns, 1 to 4 components) of uint8 (0…1 in GLSL), float16 or float32.

    Attributes:
        filter: ``mipmap`` is trilinear.
        repeat_x: whether columns go on beyond the last with the first.
        constants: a mapping of ours, ``blackhole_gl.physics.orbit_table:CONSTANTS``, from names to whole numbers that GLSL knows as ``#define``.
    """

    filter: Literal["nearest", "linear", "mipmap"] = "nearest"
    repeat_x: bool = False
    constants: str | None = None

    def defines(self) -> Mapping[str, int]:
        """Its `constants`.

        Raises:
            CatalogueError: there is no such mapping, or it holds something else.
        """
        if self.constants is None:
            return {}
        place = f"{self.place}: constants"
        found = named(self.constants, place)
        if not isinstance(found, Mapping) or any(type(value) is not int for value in found.values()):
            raise CatalogueError(f"{place}: {self.constants} is no mapping from names to whole numbers")
        return found


@dataclass(frozen=True)
class Number(Made):
    """A number of every frame, in a uniform block; `make` gives a float, or as many as `type` has. Among the keys in `of` may be `TIME`."""

    type: Literal["float", "int", "vec2", "vec4", "mat4"] = "float"

    def at(self, scene: Any, time: float) -> Any:
        """Its value at scene time `time` (r_s/c).

        Raises:
            CatalogueError: as `arguments` and `made`.
        """
        if TIME not in self.of:
            return self.made(self.arguments(scene))
        values = iter(self._timeless.arguments(scene))
        return self.made(tuple(time if key == TIME else next(values) for key in self.of))

    @cached_property
    def _timeless(self) -> Number:
        """The same of keys of the scene alone."""
        return replace(self, of=tuple(key for key in self.of if key != TIME))


@cache
def _function(reference: str, count: int, place: str) -> Callable[..., Any]:
    found = named(reference, f"{place}: make")
    try:
        inspect.signature(found).bind(*range(count))
    except TypeError as error:
        raise CatalogueError(f"{place}: make: {reference} cannot be called with the {count} values of `of`: {error}") from None
    return found


def named(reference: str, place: str) -> Any:
    """What ``module:name`` names.

    Raises:
        CatalogueError: not of that form, not in this package, or not there; it begins with `place`.
    """
    module, colon, name = reference.partition(":")
    if not colon or not module.startswith(HOME):
        raise CatalogueError(f"{place}: got {reference!r}; allowed is {HOME}MODULE:NAME, something in this program")
    try:
        return getattr(importlib.import_module(module), name)
    except (ImportError, AttributeError) as error:
        raise CatalogueError(f"{place}: {reference} cannot be found: {error}") from None
