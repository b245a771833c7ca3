"""Where a medium's pattern is looked at along rays that stay: told once by a march, summed anew at each moment.

A camera at rest before a pattern that moves asks for the same places in every frame; all but the pattern there is the same, too.
"""

from __future__ import annotations

from dataclasses import dataclass, field

import moderngl
import numpy as np

from ..planning import Plan
from ..scene import met
from ..shapes import Float, Int
from . import instances
from .draw import Draw, Samplers
from .ray_lists import WIDE, RayList, numbers_of, rows_of
from .target import Target

MOST_SAMPLES = 64
"""Of a ray; rays that go round the hole for longer lose what is behind."""

MOST_KEPT = 8_000_000
"""Samples of all rays of a list, 32 bytes each: where there would be more nothing is kept."""

_A_FRAME = 15_000  # rays that are marched on between two pictures, two samples each
_TOLD = 8  # textures that a march fills: two samples of three, and where the ray goes on in two


def can_keep(plan: Plan) -> bool:
    """Whether the scene's media are one alone that has a pattern, the same at one time everywhere: samples keep no times of light."""
    stays = not plan.times and not instances.anything_moves(plan)
    return stays and len(plan.scene.media) == 1 and all(kind.traits.changes for kind in met.kinds(plan.scene, "medium"))


@dataclass(eq=False)
class _Going:
    """A march under way.

    Attributes:
        rays: numbers, in the list as it was given, of those that go on.
        last, momenta: where and how, as shaders/transfer.frag told it.
        samples: of each number, whose they are, their places and stretches, and as half floats gains and losses.
    """

    rays: np.ndarray
    last: np.ndarray
    momenta: np.ndarray
    begins: bool = True
    samples: list[tuple[np.ndarray, np.ndarray, np.ndarray, np.ndarray]] = field(default_factory=list)


class KeptSamples:
    """The samples of a list of rays.

    Args:
        size: of the picture or grid that the rays are of.

    Attributes:
        list: the rays, once all is told: those with most samples first.
        is_whole: whether all is told.
    """

    def __init__(self, ctx: moderngl.Context, size: tuple[int, int]):
        self._ctx = ctx
        self.list = RayList(ctx, size)
        self._marched = RayList(ctx, size)
        self._target: Target | None = None
        self._asked: tuple[moderngl.Texture, ...] = ()
        self._atlas: tuple[moderngl.Texture, ...] = ()
        self._first_rows = np.zeros(MOST_SAMPLES + 1, int)
        self._pixels: Int[np.ndarray, " pixels"] = np.empty(0, np.int64)
        self._going: _Going | None = None
        self.is_whole = False

    @property
    def begun(self) -> bool:
        """Whether it is known which rays there are."""
        return self.is_whole or self._going is not None

    @property
    def samplers(self) -> dict[str, moderngl.Texture]:
        """What shaders/transfer_samples.frag reads, by name."""
        return dict(zip(("places", "gains", "loses"), self._atlas))

    def forget(self) -> None:
        """The rays are others from now on."""
        for texture in self._atlas:
            texture.release()
        self._atlas, self._going, self.is_whole = (), None, False

    def begin(self, pixels: Int[np.ndarray, " pixels"]) -> None:
        """To be told of the rays of `pixels`."""
        self.is_whole = False
        self._pixels = pixels
        none = np.zeros((len(pixels), 4), np.float32)
        self._going = _Going(np.arange(len(pixels)), none, none)

    def march_on(self, march: Draw, samplers: Samplers, spacing: tuple[float, float]) -> None:
        """Tells of some more by `march`, shaders/transfer.frag with samples, which looks things up in `samplers`, or lays all out; `spacing` is its own."""
        going, spent = self._going, 0
        while going is not None and spent < _A_FRAME and len(going.rays) and len(going.samples) < MOST_SAMPLES:
            spent += len(going.rays)
            told = self._march(march, samplers, going, spacing)
            for number in (0, 1):
                places, gains, loses = told[3 * number : 3 * number + 3]
                there = places[:, 3] >= 0.0
                going.samples.append((going.rays[there], places[there], gains[there].astype(np.float16), loses[there].astype(np.float16)))
            on = told[6, :, 3] >= 0.0
            going.rays, going.last, going.momenta, going.begins = going.rays[on], told[6, on].copy(), told[7, on].copy(), False
        if going is not None and not spent and (not len(going.rays) or len(going.samples) >= MOST_SAMPLES):
            self._lay(going)
            self._going, self.is_whole = None, True

    def sum(self, draw: Draw, target: moderngl.Framebuffer, footprint: float) -> None:
        """Draws shaders/transfer_samples.frag into `target`, of the size of the list."""
        self._ctx.disable(moderngl.BLEND | moderngl.DEPTH_TEST)
        draw.set(first_rows=self._first_rows.tolist())
        if "footprint" in draw.program:  # a pattern may have nothing so fine
            draw.set(footprint=footprint)
        target.use()
        self._ctx.scissor = 0, 0, WIDE, self.list.rows
        draw.draw()
        self._ctx.scissor = None

    def release(self) -> None:
        """Gives the GL objects back."""
        for item in (self.list, self._marched, self._target, *self._asked, *self._atlas):
            if item is not None:
                item.release()
        self._target, self._asked, self._atlas, self._going, self.is_whole = None, (), (), None, False

    def _march(self, march: Draw, samplers: Samplers, going: _Going, spacing: tuple[float, float]) -> Float[np.ndarray, "8 rays 4"]:
        """What is told of the rays that are still going, in their order."""
        self._marched.hold(self._pixels[going.rays])
        size, rows = self._marched.size, self._marched.rows
        if self._target is None or self._target.size != size:
            for item in (self._target, *self._asked):
                if item is not None:
                    item.release()
            self._target = Target.of(self._ctx, [_texture(self._ctx, size, "f4") for _ in range(_TOLD)])
            self._asked = _texture(self._ctx, size, "f4"), _texture(self._ctx, size, "f4")
        numbers = numbers_of(rows)[: len(going.rays)]
        for texture, values in zip(self._asked, (going.last, going.momenta)):
            asked = np.zeros((WIDE * rows, 4), np.float32)
            asked[numbers] = values
            texture.write(asked.tobytes(), (0, 0, WIDE, rows))
        march.sample({**samplers, "ray_pixels": self._marched.pixels, "last_places": self._asked[0], "last_momenta": self._asked[1]})
        march.set(ray_spacing=spacing, begins=going.begins)
        self._ctx.disable(moderngl.BLEND | moderngl.DEPTH_TEST)
        self._target.frame.use()
        self._ctx.scissor = 0, 0, WIDE, rows
        march.draw()
        self._ctx.scissor = None
        read = (self._target.frame.read((0, 0, WIDE, rows), 4, attachment=place, dtype="f4") for place in range(_TOLD))
        return np.stack([np.frombuffer(texels, np.float32).reshape(-1, 4)[numbers] for texels in read])

    def _lay(self, going: _Going) -> None:
        """Puts all samples where `sum` looks for them, rays with most of them first."""
        counts = np.zeros(len(self._pixels), int)
        for rays, *_ in going.samples:
            counts[rays] += 1
        order = np.argsort(-counts, kind="stable")
        place = np.empty(len(order), int)
        place[order] = np.arange(len(order))
        self.list.hold(self._pixels[order])
        rows = [rows_of(int(np.count_nonzero(counts > number))) for number in range(MOST_SAMPLES)]
        self._first_rows = np.concatenate([[0], np.cumsum(rows)])
        height = max(int(self._first_rows[-1]), 1)
        laid = [np.zeros((WIDE * height, 4), kind) for kind in (np.float32, np.float16, np.float16)]
        laid[0][:, 3] = -1.0
        numbers = numbers_of(max(rows[0], 2))
        had = np.zeros(len(order), int)
        for rays, *sample in going.samples:
            at = numbers[place[rays]] + WIDE * self._first_rows[had[rays]]
            for all_of_them, values in zip(laid, sample):
                all_of_them[at] = values
            had[rays] += 1
        for texture in self._atlas:
            texture.release()
        self._atlas = tuple(_texture(self._ctx, (WIDE, height), kind, values) for kind, values in zip(("f4", "f2", "f2"), laid))


def _texture(ctx: moderngl.Context, size: tuple[int, int], kind: str, values: np.ndarray | None = None) -> moderngl.Texture:
    texture = ctx.texture(size, 4, values, dtype=kind)
    texture.filter = moderngl.NEAREST, moderngl.NEAREST
    return texture
