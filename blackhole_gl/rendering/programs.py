"""Plan and scene → composed, compiled, kept programs. A changed file is taken up anew; a mistake in it keeps the last good program."""

from __future__ import annotations

import hashlib
import math
import os
import time as clock
from collections import OrderedDict, deque
from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, field
from functools import lru_cache, partial
from itertools import count
from pathlib import Path

import moderngl

from .. import VERSION
from ..glsl import compose as compose_module
from ..glsl.carried import carry
from ..glsl.compose import Composed, ShaderError, compose
from ..output import cache
from ..planning import Plan
from ..resources import shaders_dir, user_shaders_dir
from . import uniforms
from .draw import Compiled, Draw
from .inputs import FrameInputs, UniformBuffers
from .squares import SquareBuffer
from .structure import Structure, structure_of, told_apart

MOST_KEPT = 96
"""Compiled programs kept, those used last. A frame uses ten, with things in motion twice as many, so the last few scenes come back at once; what else comes
back takes milliseconds, as drivers keep what they compiled on disk."""

_SERIALS = count(1)

_VERTEX = {"star_layer.frag": "star_layer.vert", "turned.frag": "turned.vert"}  # of programs that draw points or a mesh; all others draw a triangle

_BETWEEN = "\0"  # a program's two texts, neither of which may hold it

_MOST_RECIPES = 4 * MOST_KEPT  # switches that a text does not mention give further recipes for the same program
_PLANS = 16  # of a few frames, each with its media, without, with media in longer steps; and what is metered in one of six


class Unready(RuntimeError):
    """A program is still missing, and compiling it was left to a later frame: see `Programs.deadline`."""


@lru_cache(maxsize=_MOST_RECIPES)
def _as_before(structure: Structure) -> Structure:
    """The first that was equal to `structure`."""
    return structure


@dataclass(frozen=True)
class _Texts:
    """What a program is made of; equal where the driver is given the same.

    Attributes:
        compose: gives the vertex and the fragment shader with their lines' places.
    """

    vertex: str
    fragment: str
    compose: Callable[[], tuple[Composed, Composed]] = field(compare=False)

    def explain(self, log: str) -> ShaderError:
        """The driver's compile `log` as an error that names the author's file and line."""
        vertex, fragment = self.compose()
        return (vertex if "vertex_shader" in log else fragment).explain(log)


class Programs:
    """The programs of one GL context, kept by the structure of what they draw: a slider never compiles anything.

    Attributes:
        errors: mistakes found by the last `reload`, until a later one mends them.
        deadline: ``time.perf_counter()`` after which `get` compiles nothing more and raises `Unready` instead: one program since the deadline was set, as
            drawing what is there may take all the time until then, and none at all where it is −∞. Whoever draws a window sets it before
            each frame, and so spreads the programs of a new scene over several.
        foresees: whether those are to be compiled, too, that what is drawn now has no use for and later pictures of the scene may have: else they would be
            compiled amid a movement. Whoever draws a window says so of a scene's first pictures.
        compiled: how many programs have been compiled.
    """

    def __init__(self, ctx: moderngl.Context, root: Path | None = None):
        self.ctx = ctx
        self.roots = root or shaders_dir(), user_shaders_dir()
        self.errors: list[ShaderError] = []
        self.compiled = 0
        self.deadline = math.inf
        self.foresees = False
        self._buffers, self._squares = UniformBuffers(ctx), SquareBuffer(ctx)
        self._composed: OrderedDict[tuple, _Texts] = OrderedDict()
        self._kept: OrderedDict[_Texts, Compiled] = OrderedDict()
        self._ready: dict[tuple, Compiled] = {}  # by recipe: those asked for since something was last compiled
        self._asked: deque[tuple[Plan, tuple, Structure]] = deque(maxlen=_PLANS)
        self._seen = self._times()
        self._content: bytes | None = None

    def get(self, path: str, inputs: FrameInputs, extra: Mapping[str, int] | None = None) -> Draw:
        """What draws fragment shader `path` for `inputs`.

        Args:
            extra: switches beyond the scene's own.

        Raises:
            ShaderError: the text cannot be composed or compiled; it names file and line.
            Unready: it would have to be compiled, and the `deadline` has passed.
        """
        recipe = path, self._structure(inputs.plan), tuple(extra.items()) if extra else ()
        ready = self._ready.get(recipe)
        if ready is None:
            ready = self._made_ready(recipe)
        return Draw(ready, inputs)

    def _made_ready(self, recipe: tuple) -> Compiled:
        if recipe not in self._composed:
            self._composed[recipe] = self._compose(*recipe)
            if len(self._composed) > _MOST_RECIPES:
                self._composed.popitem(last=False)
        self._composed.move_to_end(recipe)
        ready = self._compiled(self._composed[recipe], by=self.deadline)
        self._ready[recipe] = ready
        return ready

    def release(self) -> None:
        """Gives the GL objects back."""
        for compiled in self._kept.values():
            compiled.release()
        self._kept.clear()
        self._ready.clear()
        self._buffers.release()
        self._squares.release()

    def reload(self) -> list[ShaderError]:
        """Looks at the files' times; composes and compiles anew what changed. Returns the mistakes that stand."""
        times = self._times()
        if times == self._seen:
            return self.errors
        self._seen, self.errors, self._content = times, [], None
        self._ready.clear()
        for recipe in self._composed:
            try:
                composed = self._compose(*recipe)
                self._compiled(composed, by=math.inf)
                self._composed[recipe] = composed
            except ShaderError as error:
                if str(error) not in map(str, self.errors):
                    self.errors.append(error)
        return self.errors

    def _structure(self, plan: Plan) -> Structure:
        """A frame asks for several programs with each of few plans: worked out once. One that is as before is the same object, found by its identity."""
        for asked, _, known in reversed(self._asked):
            if asked is plan:
                return known
        own = told_apart(plan)
        like = next((known for _, other, known in reversed(self._asked) if other == own), None)
        found = like or _as_before(structure_of(plan))
        self._asked.append((plan, own, found))
        return found

    def _compose(self, path: str, structure: Structure, extra: tuple) -> _Texts:
        compose = partial(self._composed_anew, path, structure, extra)
        vertex, fragment = self._texts((path, structure, extra), compose)
        return _Texts(vertex, fragment, compose)

    def _texts(self, recipe: tuple, compose: Callable[[], tuple[Composed, Composed]]) -> tuple[str, str]:
        """The texts that `compose` gives: to compose those of a first picture takes a tenth of its time."""
        if self._content is None:
            self._content = _content(self.roots)
        key = self._content + repr(recipe).encode()
        if (kept := cache.found("programs", key)) is not None:
            vertex, _, fragment = kept.decode().partition(_BETWEEN)
            return vertex, fragment
        vertex, fragment = (made.text for made in compose())
        if self._times() == self._seen:  # no file has changed meanwhile
            cache.keep("programs", key, f"{vertex}{_BETWEEN}{fragment}".encode())
        return vertex, fragment

    def _composed_anew(self, path: str, structure: Structure, extra: tuple) -> tuple[Composed, Composed]:
        switches = dict(structure.switches + extra)
        blocks = uniforms.blocks()
        composed = partial(compose, self.roots, chosen=dict(structure.chosen), switches=switches, instances=structure.instances)
        fragment = composed(path, blocks=lambda words: carry(blocks, words).fragment)
        vertex = composed(_VERTEX.get(path, "fullscreen.vert"), blocks=lambda own: carry(blocks, fragment.words, own).vertex)
        return vertex, fragment

    @property
    def deadline(self) -> float:
        return self._deadline

    @deadline.setter
    def deadline(self, by: float) -> None:
        self._deadline, self._compiled_before = by, self.compiled

    def _compiled(self, texts: _Texts, *, by: float) -> Compiled:
        if texts not in self._kept:
            if clock.perf_counter() > by and (by == -math.inf or self.compiled > self._compiled_before):
                raise Unready("the programs of this scene are still being compiled")
            self._kept[texts] = self._compile(texts)
            self._ready.clear()
            if len(self._kept) > MOST_KEPT:
                self._kept.popitem(last=False)[1].release()
        self._kept.move_to_end(texts)
        return self._kept[texts]

    def _compile(self, texts: _Texts) -> Compiled:
        try:
            program = self.ctx.program(vertex_shader=texts.vertex, fragment_shader=texts.fragment)
        except moderngl.Error as error:
            raise texts.explain(str(error)) from None
        for block in uniforms.blocks():
            member = program.get(block.name, None)
            if isinstance(member, moderngl.UniformBlock):
                member.binding = block.binding
        self.compiled += 1
        return Compiled(next(_SERIALS), self.ctx.vertex_array(program, []), self._squares.array(program), self._buffers, self._squares)

    def _times(self) -> tuple:
        return tuple((file, os.stat(file).st_mtime_ns) for root in self.roots for file in _shader_files(root))


def _content(roots: Sequence[Path]) -> bytes:
    """A digest of all that composed texts depend on beside their recipe: shader files, wherever the folders lie, the blocks' members, and what composes."""
    members = [(block.name, block.binding, block.members) for block in uniforms.blocks()]
    digest = hashlib.sha256(repr((VERSION, len(roots), members)).encode())
    ours = [__file__, *map(str, sorted(Path(compose_module.__file__).parent.glob("*.py")))]
    for file, name in [(file, "") for file in ours] + [(file, file.removeprefix(str(root))) for root in roots for file in _shader_files(root)]:
        with open(file, "rb") as stream:
            content = stream.read()
        digest.update(repr((name, len(content))).encode())
        digest.update(content)
    return digest.digest()


def _shader_files(root: Path) -> list[str]:
    """All below `root`, but for links to nothing, which the catalogue has told of; a file that is missing otherwise is just being replaced."""
    files = (os.path.join(folder, name) for folder, _, names in os.walk(root) for name in names if name.endswith((".glsl", ".frag", ".vert")))
    return sorted(file for file in files if not os.path.islink(file) or os.path.exists(file))
