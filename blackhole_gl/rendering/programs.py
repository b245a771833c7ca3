"""Plan and scene → composed, compiled, kept programs. A changed file is taken up anew; a mistake in it keeps the last good program."""

from __future__ import annotations

import hashlib
import math
import os
import time as clock
from collections import OrderedDict, deque
from collections.abc import Callable, Iterable, Mapping, Sequence
from dataclasses import dataclass, field, fields
from functools import cached_property, lru_cache, partial
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
from ..scene import Scene, catalogue, met
from ..scene import fields as scene_fields
from . import instances, uniforms
from .boxes import Box
from .inputs import FrameInputs, UniformBuffers
from .squares import SquareBuffer, Squares

MOST_KEPT = 96
"""Compiled programs kept, those used last. A frame uses ten, with things in motion twice as many, so the last few scenes come back at once; what else comes
back takes milliseconds, as drivers keep what they compiled on disk."""

Samplers = Mapping[str, moderngl.Texture | moderngl.TextureArray]
"""Sampler's name → texture."""

_SERIALS = count(1)

RAY_SLOTS = ("ray_model", "integrator", "step_control")
SHADE_SLOTS = ("disk_layer", "sky")
MET_SLOTS = ("thing", "medium")

_VERTEX = {"star_layer.frag": "star_layer.vert", "turned.frag": "turned.vert"}  # of programs that draw points or a mesh; all others draw a triangle

_SECTIONS = tuple(section.name for section in fields(Scene) if section.name != "camera")

_BETWEEN = "\0"  # a program's two texts, neither of which may hold it

_MOST_RECIPES = 4 * MOST_KEPT  # switches that a text does not mention give further recipes for the same program
_PLANS = 4  # of a frame: with its media, without, with media in longer steps, and what is metered


class Unready(RuntimeError):
    """A program is still missing, and compiling it was left to a later frame: see `Programs.deadline`."""


@dataclass(frozen=True)
class _Structure:
    """What a plan asks of a program's text: (slot, paths) and (switch, value) pairs, and what reads the tables of instances."""

    chosen: tuple[tuple[str, tuple[str, ...]], ...]
    switches: tuple[tuple[str, int], ...]
    instances: str

    @cached_property
    def _hash(self) -> int:
        return hash((self.chosen, self.switches, self.instances))

    def __hash__(self) -> int:
        return self._hash


@lru_cache(maxsize=_MOST_RECIPES)
def _as_before(structure: _Structure) -> _Structure:
    """The first that was equal to `structure`."""
    return structure


@dataclass(frozen=True, eq=False)
class Compiled:
    """A compiled program with the triangle that covers its target, and squares of it.

    Attributes:
        serial: a number that no other program of this process has, for the keys of what was drawn by it.
        squares: points at what the buffer of squares holds.
    """

    serial: int
    triangle: moderngl.VertexArray
    squares: moderngl.VertexArray

    @cached_property
    def names(self) -> frozenset[str]:
        """Its samplers, loose uniforms and blocks: looking a name up in the program walks through all of them."""
        return frozenset(self.program)

    @cached_property
    def values(self) -> dict[str, object]:
        """What its samplers and loose uniforms were last set to: to set one takes a hundred times as long as to compare."""
        return {}

    @property
    def program(self) -> moderngl.Program:
        """The program, which takes samplers and loose uniforms."""
        return self.triangle.program

    def release(self) -> None:
        """Gives the GL objects back."""
        program = self.program  # which a released triangle no longer knows
        self.triangle.release()
        self.squares.release()
        program.release()


@dataclass(frozen=True, eq=False)
class Draw:
    """A program made ready for one frame's inputs.

    Attributes:
        serial: of its program.
        inputs: what its uniform blocks hold when it draws.
    """

    compiled: Compiled
    inputs: FrameInputs
    _buffers: UniformBuffers
    _squares: SquareBuffer

    @property
    def serial(self) -> int:
        """That of the program."""
        return self.compiled.serial

    @property
    def program(self) -> moderngl.Program:
        """The program, which takes samplers and loose uniforms."""
        return self.compiled.program

    def takes(self, name: str) -> bool:
        """Whether the program has a sampler or a loose uniform of that name."""
        return name in self.compiled.names

    def sample(self, samplers: Samplers, first: int = 0) -> None:
        """Binds those of `samplers` (name → texture) that the program uses, to texture units from `first` on."""
        used = [name for name in samplers if name in self.compiled.names]
        for unit, name in enumerate(used, first):
            samplers[name].use(unit)
            self._give(name, unit)

    def set(self, **uniforms: object) -> None:
        """Sets loose uniforms by name."""
        for name, value in uniforms.items():
            self._give(name, value)

    def _give(self, name: str, value: object) -> None:
        held = self.compiled.values
        if name not in held or held[name] != value:
            self.program[name] = value
            held[name] = value

    def draw(self) -> None:
        """Draws the triangle that covers the bound target."""
        self._buffers.bind(self.inputs, self.compiled.names)
        self.compiled.triangle.render(moderngl.TRIANGLES, vertices=3)

    def draw_boxes(self, boxes: Iterable[Box]) -> None:
        """Draws `boxes` of the bound target alone, by its scissor."""
        ctx = self.compiled.triangle.ctx
        for box in boxes:
            ctx.scissor = box
            self.draw()
        ctx.scissor = None

    def draw_squares(self, squares: Squares) -> None:
        """Draws `squares` of the bound target alone."""
        self._buffers.bind(self.inputs, self.compiled.names)
        self._squares.draw(self.compiled.squares, squares)

    def draw_mesh(self, columns: int, rows: int) -> None:
        """Draws a mesh, by a program whose vertex shader places the two triangles of each of its quads."""
        self._buffers.bind(self.inputs, self.compiled.names)
        self.compiled.triangle.render(moderngl.TRIANGLES, vertices=6 * columns * rows)

    def draw_points(self, count: int) -> None:
        """Draws `count` points, by a program whose vertex shader places them."""
        self._buffers.bind(self.inputs, self.compiled.names)
        self.compiled.triangle.render(moderngl.POINTS, vertices=count)


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
        compiled: how many programs have been compiled.
    """

    def __init__(self, ctx: moderngl.Context, root: Path | None = None):
        self.ctx = ctx
        self.roots = root or shaders_dir(), user_shaders_dir()
        self.errors: list[ShaderError] = []
        self.compiled = 0
        self.deadline = math.inf
        self._buffers, self._squares = UniformBuffers(ctx), SquareBuffer(ctx)
        self._composed: OrderedDict[tuple, _Texts] = OrderedDict()
        self._kept: OrderedDict[_Texts, Compiled] = OrderedDict()
        self._ready: dict[tuple, Compiled] = {}  # by recipe: those asked for since something was last compiled
        self._asked: deque[tuple[Plan, _Structure]] = deque(maxlen=_PLANS)
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
        return Draw(ready, inputs, self._buffers, self._squares)

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

    def _structure(self, plan: Plan) -> _Structure:
        """A frame asks for several programs with each of few plans: worked out once. One that is as before is the same object, found by its identity."""
        for asked, known in self._asked:
            if asked is plan:
                return known
        like = next((known for asked, known in self._asked if _same_text(asked, plan)), None)
        found = like or _as_before(_structure_of(plan))
        self._asked.append((plan, found))
        return found

    def _compose(self, path: str, structure: _Structure, extra: tuple) -> _Texts:
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

    def _composed_anew(self, path: str, structure: _Structure, extra: tuple) -> tuple[Composed, Composed]:
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
        return Compiled(next(_SERIALS), self.ctx.vertex_array(program, []), self._squares.array(program))

    def _times(self) -> tuple:
        return tuple((file, os.stat(file).st_mtime_ns) for root in self.roots for file in _shader_files(root))


def _structure_of(plan: Plan) -> _Structure:
    """What `plan` asks of a program's text."""
    things = met.seen_kinds(plan.scene, "thing")
    groups = [*((slot, chosen(plan, slot)) for slot in (*RAY_SLOTS, *SHADE_SLOTS, "medium")), ("thing", things)]
    groups += [(f"thing_by_{way}", [kind for kind in things if kind.traits.meets == way]) for way in ("distance", "crossing")]
    groups.append(("thing_told_apart", [kind for kind in things if kind.traits.tells_apart]))
    groups.append(("thing_not_placed", [kind for kind in things if kind.traits.meets == "crossing" and not kind.traits.tells_apart]))
    groups.append(("steady_medium", [kind for kind in chosen(plan, "medium") if not kind.traits.changes]))
    paths = ((slot, tuple(plug_in.path for plug_in in found)) for slot, found in groups)
    return _Structure(tuple(paths), tuple(uniforms.switches(plan).items()), instances.glsl(chosen(plan, *MET_SLOTS)))


def _same_text(plan: Plan, other: Plan) -> bool:
    """Whether both surely ask for the same text, as they differ in numbers of the camera and of steps alone: so do the frames of a camera that moves."""
    return _but_for_camera(plan) == _but_for_camera(other) and plan.scene.several(_camera_words()) == other.scene.several(_camera_words())


def _but_for_camera(plan: Plan) -> tuple:
    """What a plan's structure depends on beside its camera."""
    scene = plan.scene
    of_plan = plan.model, plan.integrator, plan.step_control, plan.orders, plan.meetings, plan.space_time.kind
    return *of_plan, *(getattr(scene, section) for section in _SECTIONS)


@lru_cache(maxsize=1)
def _camera_words() -> tuple[str, ...]:
    """The keys of all choices and switches of cameras."""
    return tuple(key for key, item in scene_fields().items() if key.startswith("camera.") and item.kind in ("choice", "switch"))


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


def chosen(plan: Plan, *slots: str) -> list[catalogue.PlugIn]:
    """The plug-ins of `slots` that the plan and its scene use, in the order of `slots`."""
    scene = plan.scene
    rays: dict[str, catalogue.PlugIn | None] = {"ray_model": plan.model, "integrator": plan.integrator, "step_control": plan.step_control}
    found: list[catalogue.PlugIn] = []
    for slot in slots:
        if slot in rays:
            plug_in = rays[slot]
            found += [plug_in] if plug_in else []
        elif slot in MET_SLOTS:
            found += met.kinds(scene, slot)
        elif slot == "disk_layer":
            layers = catalogue.plug_ins(slot)
            found += [layers[key] for key in scene.disk_layers()] if plan.shows_disk else []
        else:
            found += [catalogue.plug_ins("sky")[scene.sky.model]] if scene.sky.enabled else []
    return found
