"""The shade pass: hit map and time → linear radiance."""

from __future__ import annotations

from collections.abc import Mapping, Sequence

import moderngl
import numpy as np

from .boxes import Box, box_of, joined
from .classes import BEYOND_MATTER, EVERYWHERE, FLAT_SKY, MATTER, NO_THINGS, OPEN_THINGS, SKY, THINGS, Where
from .coarse_transfer import CoarseTransfer, MediaApart
from .draw import Draw, Samplers
from .hit_map import AS_SHARP, HitMap
from .inputs import FrameInputs
from .overlays import Overlays
from .post import TONE_TABLE
from .programs import Programs
from .sorting import PixelSorting, Sorted
from .squares import Patches, Squares
from .structure import RAY_SLOTS, SHADE_SLOTS, chosen
from .tables import Tables
from .target import Elsewhere, Target
from .temperatures import TemperatureProfile
from .transfer import TransferPass

_SECOND_OUTPUT = 0x88F9  # GL_SRC1_COLOR, which moderngl has no name for

_STRETCHES = {"STRETCHES": 1}
"""The switch of what reads the light of media and has hits that know of none."""

_A_FRAME = 40_000  # rays through media that are marched exactly between two pictures

NO_SWITCHES: Mapping[str, int] = {}

SKY_BEHIND = {"SKY_BEHIND": 1}


class ShadePass:
    """Draws shaders/shade_*.frag.

    First every pixel is sorted by what it needs, into a depth buffer; then the depth test lets the disk's and the sky's
    shaders run only where they are needed. The sorting is kept as long as the hit map and the disk's edges are, and from its second frame on the
    disk is drawn within its bounds alone; a refined hit map brings a sorting and bounds of its own (shaders/refine_classes.frag).

    Args:
        tables, temperatures: what those shaders read; they stay their owner's.

    Attributes:
        sorting: of the pixels of sharp maps.
        transfer, coarse_transfer: what the media of the last frame add, drawn as exactly as the rest or at a resolution of their own.
    """

    def __init__(self, ctx: moderngl.Context, programs: Programs, tables: Tables, temperatures: TemperatureProfile):
        self._ctx, self._programs = ctx, programs
        self._tables, self._temperatures = tables, temperatures
        self.sorting = PixelSorting(ctx, programs)
        self.transfer = TransferPass(ctx)
        self.coarse_transfer = CoarseTransfer(ctx, programs)
        self._overlays = Overlays(ctx, programs)
        self._elsewhere = Elsewhere(ctx)
        self._stretches: Mapping[str, moderngl.Texture] = {}  # what the media of this frame add
        self._sorted: Sorted | None = None  # the pixels of the last sharp map
        self._boxes: dict[Where, Box] = {}  # not known before the second frame of the same pixels
        self._frame: moderngl.Framebuffer | None = None
        self._sky: Target | None = None
        self._sky_key: tuple | None = None
        self._sky_sorting: tuple | None = None  # key of the pixels that it is of
        self._sky_generation = 0
        self._sky_kept = False

    def draw(self, inputs: FrameInputs, hit_map: HitMap, target: moderngl.Framebuffer, media: MediaApart | None = None) -> None:
        """Shades `hit_map` into `target` (RGBA16F, of the map's size). Alpha: the share of the sky's light that comes through, where single stars were left
        out because the picture is to be shown enlarged; else 0, or without meaning in a picture that is not.

        Args:
            media: those that are marched apart from the rest, and are not in `inputs`.
        """
        classes = hit_map.classes or self._sorted_pixels(inputs, hit_map)
        self._stretches = {}
        apart = media is not None
        if media is not None and not media.exact:
            self.coarse_transfer.draw(media, hit_map, self._samplers(media.inputs, hit_map))
            self._stretches = self.coarse_transfer.samplers
        elif media is not None:
            self._march_media(media.inputs, hit_map, classes, EVERYWHERE, {"FROM_CAMERA": 1})
        elif inputs.plan.scene.media:
            self._march_media(inputs, hit_map, classes, THINGS, {})
        frame = self._attached(target, classes)
        ctx = self._ctx
        ctx.enable(moderngl.DEPTH_TEST)
        self._lay_sky(inputs, hit_map, target, frame, classes)
        self._overlays.draw_sky(inputs, hit_map, frame)
        frame.use()
        ctx.enable(moderngl.BLEND)
        if inputs.plan.shows_disk:
            switches, behind = (_STRETCHES, _SECOND_OUTPUT) if apart else (NO_THINGS, moderngl.SRC_ALPHA)
            self._draw_matter(inputs, hit_map, MATTER, {**hit_map.switches(), **switches}, behind, self._pieces_of(hit_map, MATTER))
        if apart:
            self._draw_media(inputs, hit_map, None if media is None or media.exact else self.coarse_transfer.shown)
        if inputs.plan.meetings:
            self._draw_things(inputs, hit_map)
        ctx.disable(moderngl.DEPTH_TEST | moderngl.BLEND)
        ctx.blend_func = moderngl.SRC_ALPHA, moderngl.ONE_MINUS_SRC_ALPHA  # with a second output set nothing can be drawn into several targets, blending or not
        ctx.depth_func = "<"
        self._overlays.draw_hole(inputs, hit_map, frame)

    def draw_sky_in(self, squares: Squares, inputs: FrameInputs, hit_map: HitMap, frame: moderngl.Framebuffer) -> None:
        """Draws the sky of a sharp map without things in `squares` of `frame`, which has the pixels' classes as its depth."""
        frame.use()
        frame.depth_mask = False
        self._ctx.enable(moderngl.DEPTH_TEST)
        self._draw_classes(self._prepared_sky(inputs, hit_map, hit_map.switches()), SKY, squares=squares)
        self._ctx.disable(moderngl.DEPTH_TEST)
        self._ctx.depth_func = "<"

    def draw_disk_in(self, squares: Squares, inputs: FrameInputs, hit_map: HitMap, frame: moderngl.Framebuffer, sky: moderngl.Texture) -> None:
        """The same of the disk, before the light that `sky` holds."""
        frame.use()
        frame.depth_mask = False
        self._ctx.enable(moderngl.DEPTH_TEST)
        matter = self._programs.get("shade_matter.frag", inputs, {**hit_map.switches(), **SKY_BEHIND})
        matter.sample({**self._samplers(inputs, hit_map), "sky_behind": sky})
        hit_map.tell_blocks(matter)
        self._draw_classes(matter, MATTER, squares=squares)
        self._ctx.disable(moderngl.DEPTH_TEST)
        self._ctx.depth_func = "<"

    def _draw_matter(
        self, inputs: FrameInputs, hit_map: HitMap, where: Where, switches: Mapping[str, int], behind: int, pieces: Sequence[Box] | Patches | None
    ) -> None:
        """The disk, things and media, and what they let through of the sky `behind` them: of all colours alike, or of each its own.

        Alpha becomes the share of the sky's light that is left, where stars may be.
        """
        self._ctx.blend_func = moderngl.ONE, behind, moderngl.ZERO, moderngl.SRC_ALPHA  # type: ignore[assignment]  # moderngl's stubs know of two
        matter = self._prepared("shade_matter.frag", inputs, hit_map, switches)
        self._draw_classes(matter, where, pieces)

    def _draw_things(self, inputs: FrameInputs, hit_map: HitMap) -> None:
        """Things, and media that the hit map knows. One that fills cells hides what is behind."""
        filled = hit_map.switches_where_filled()
        self._draw_matter(inputs, hit_map, THINGS if filled is None else OPEN_THINGS, AS_SHARP, _SECOND_OUTPUT, self._pieces_of(hit_map, THINGS))
        if filled is not None:
            self._ctx.disable(moderngl.BLEND)
            self._draw_classes(self._prepared("shade_matter.frag", inputs, hit_map, filled), THINGS, hit_map.filled)
            self._ctx.enable(moderngl.BLEND)

    def _draw_media(self, inputs: FrameInputs, hit_map: HitMap, shown: Sequence[Box] | None) -> None:
        """The media where no disk is seen, before all else: in what is `shown` of them alone, where that is known."""
        self._ctx.blend_func = moderngl.ONE, _SECOND_OUTPUT, moderngl.ZERO, moderngl.SRC_ALPHA  # type: ignore[assignment]  # moderngl's stubs know of two
        self._draw_classes(self._prepared("shade_media.frag", inputs, hit_map, hit_map.switches()), BEYOND_MATTER if inputs.plan.orders else EVERYWHERE, shown)

    def march_apart(self, inputs: FrameInputs, media: MediaApart, hit_map: HitMap) -> bool:
        """Marches some of the rays of exact `media`, which are not in `inputs`, before `draw` needs them all. Returns whether none is left."""
        self._stretches = {}
        classes = hit_map.classes or self._sorted_pixels(inputs, hit_map)
        return self._march_media(media.inputs, hit_map, classes, EVERYWHERE, {"FROM_CAMERA": 1}, _A_FRAME)

    def prepare_coarse(self, media: MediaApart, hit_map: HitMap) -> bool:
        """The same of the `media` of a picture that only time changes, as `CoarseTransfer.prepare` tells."""
        self._stretches = {}
        return self.coarse_transfer.prepare(media, hit_map, self._samplers(media.inputs, hit_map))

    def _march_media(
        self, inputs: FrameInputs, hit_map: HitMap, classes: moderngl.Texture, where: Where, switches: Mapping[str, int], most: int | None = None
    ) -> bool:
        march = self._prepared("transfer.frag", inputs, hit_map, {**hit_map.switches(), **switches})
        march.set(meeting_reach=inputs.plan.reach)
        whole = self.transfer.draw(march, hit_map, classes, where, most)
        self._stretches = self.transfer.samplers
        return whole

    def _lay_sky(
        self, inputs: FrameInputs, hit_map: HitMap, target: moderngl.Framebuffer, frame: moderngl.Framebuffer, classes: moderngl.Texture
    ) -> None:
        """The sky into the target, of which `frame` is the one with the pixels' `classes`.

        Few skies depend on time: where the same one is asked for again it is kept, and copied from then on.
        """
        scene = inputs.plan.scene
        if not scene.sky.enabled:
            self._clear(frame)
            return
        sky = self._programs.get("shade_sky.frag", inputs, hit_map.switches())
        parameters = tuple(sorted((key, value) for key, value in scene.parameters.items() if key.startswith("sky.")))
        skies = chosen(inputs.plan, "sky")
        self._tables.of_slots(inputs, SHADE_SLOTS)
        time = inputs.time if any(kind.traits.changes for kind in skies) else 0.0
        key = (sky.serial, inputs.plan.turn_deg, inputs.finer, scene.sky, parameters, self._tables.pictures.made, time)
        before, self._sky_sorting = self._sky_sorting, self._sorted.key if self._sorted is not None else None
        changed = self._sorted.changed if self._sorted is not None and self._sorted.key != before and self._sorted.before == before else None
        stale = before != self._sky_sorting and changed is None
        if key != self._sky_key or stale or not hit_map.is_sharp:
            self._sky_key, self._sky_kept = key, False
            self._draw_sky(frame, inputs, hit_map)
            return
        if self._sky is None:
            self._sky = Target.of(self._ctx, [self._ctx.texture(target.size, 4, dtype="f2")], classes)
        if not self._sky_kept:
            self._draw_sky(self._sky.frame, inputs, hit_map)
            self._sky_kept = True
        elif changed:
            self._draw_sky(self._sky.frame, inputs, hit_map, changed)
        self._ctx.copy_framebuffer(target, self._sky.frame)

    def _draw_sky(self, frame: moderngl.Framebuffer, inputs: FrameInputs, hit_map: HitMap, squares: Squares | None = None) -> None:
        """All of it, or in `squares` of a sharp map alone."""
        if squares is None:
            self._clear(frame)
        else:
            frame.use()
        where_flat = hit_map.switches_where_flat()
        in_parts = inputs.plan.meetings > 0  # without things it is nearly everywhere
        if where_flat is not None:
            self._draw_classes(self._prepared_sky(inputs, hit_map, where_flat), FLAT_SKY, self._pieces_of(hit_map, FLAT_SKY) if in_parts else None)
            self._elsewhere.begin()  # the largest part of it: the rest is made ready meanwhile
            frame.use()
        sky = self._prepared_sky(inputs, hit_map, hit_map.switches())
        if squares is not None:
            self._draw_classes(sky, EVERYWHERE, squares=squares)
            return
        self._draw_classes(sky, SKY, self._pieces_of(hit_map, SKY) if in_parts else None)
        if in_parts:
            self._draw_classes(self._prepared_sky(inputs, hit_map, AS_SHARP), OPEN_THINGS, self._pieces_of(hit_map, OPEN_THINGS))

    def _clear(self, frame: moderngl.Framebuffer) -> None:
        frame.use()
        frame.depth_mask = False
        frame.color_mask = True, True, True, True
        frame.clear(0.0, 0.0, 0.0, 0.0)

    def release(self) -> None:
        """Gives the GL objects back."""
        self._release_targets()
        self.sorting.release()
        self.transfer.release()
        self.coarse_transfer.release()
        self._elsewhere.release()
        self._sorted = None

    def _prepared_sky(self, inputs: FrameInputs, hit_map: HitMap, switches: Mapping[str, int]) -> Draw:
        prepared = self._prepared("shade_sky.frag", inputs, hit_map, switches)
        if prepared.takes("finer"):  # a sky with stars
            prepared.set(finer=min(inputs.finer))
        return prepared

    def stars(self, inputs: FrameInputs, hit_map: HitMap, switches: Mapping[str, int] = NO_SWITCHES) -> tuple[Draw, Samplers]:
        """What draws the single stars of a picture that is to be shown enlarged, and was drawn without them; its samplers are still to be bound."""
        return self._programs.get("star_layer.frag", inputs, {**hit_map.switches(), **TONE_TABLE, **switches}), self._samplers(inputs, hit_map)

    def _prepared(self, path: str, inputs: FrameInputs, hit_map: HitMap, switches: Mapping[str, int]) -> Draw:
        prepared = self._programs.get(path, inputs, switches)
        prepared.sample(self._samplers(inputs, hit_map))
        hit_map.tell_blocks(prepared)
        return prepared

    def _samplers(self, inputs: FrameInputs, hit_map: HitMap) -> Samplers:
        scene = inputs.plan.scene
        declared = self._tables.of_slots(inputs, SHADE_SLOTS)
        found: dict[str, moderngl.Texture | moderngl.TextureArray] = {**hit_map.samplers(), **declared}
        if inputs.plan.meetings:
            found |= hit_map.tables.of_instances(inputs)
        if scene.media:
            found |= self._tables.of_slots(inputs, RAY_SLOTS)
        return {**found, **self._stretches, "temperature_profile": self._temperatures.of(inputs.plan)}

    def _pieces_of(self, hit_map: HitMap, where: Where) -> Sequence[Box] | Patches | None:
        """Parts of the picture that hold all pixels that are `where`; None where that is not known."""
        if not hit_map.is_sharp:
            return hit_map.pieces(where)
        return [self._boxes[where]] if where in self._boxes else None

    def _draw_classes(
        self, prepared: Draw, where: Where, pieces: Sequence[Box] | Patches | None = None, squares: Squares | None = None
    ) -> None:
        """Draws `where` the pixel's class says, inside `pieces` or in `squares` alone, if such are given."""
        self._ctx.depth_func = where.comparison
        prepared.set(triangle_depth=2.0 * where.depth - 1.0)
        if squares is not None:
            prepared.draw_squares(squares)
        elif isinstance(pieces, Patches):
            prepared.draw_patches(pieces)
        elif pieces is not None:
            prepared.draw_boxes(pieces)
        else:
            prepared.draw()

    def _sorted_pixels(self, inputs: FrameInputs, hit_map: HitMap) -> moderngl.Texture:
        found, last = self.sorting.of(inputs, hit_map), self._sorted
        self._sorted = found
        if last is not None and last.depth is not found.depth:
            self._release_targets()
        changed = found.changed if last is not None and found is not last and found.before == last.key else None
        if found is not last and changed is None:
            self._boxes = {}
        elif not self._boxes:
            self._boxes = {where: _box_of(found.depth, where) for where in (MATTER, THINGS)}
        elif changed:
            self._boxes = {where: joined(box, changed.box(found.depth.size)) for where, box in self._boxes.items()}
        return found.depth

    def _attached(self, target: moderngl.Framebuffer, classes: moderngl.Texture) -> moderngl.Framebuffer:
        """The framebuffer of the target's picture and the pixels' classes, made unless it is there."""
        picture = target.color_attachments[0]
        if self._frame is None or self._frame.color_attachments[0] is not picture or self._frame.depth_attachment is not classes:
            if self._frame is not None:
                self._frame.release()
            self._frame = self._ctx.framebuffer([picture], classes)
        return self._frame

    def _release_targets(self) -> None:
        for item in (self._sky, self._frame):
            if item is not None:
                item.release()
        self._sky, self._frame, self._sky_key, self._sky_kept = None, None, None, False


def _box_of(classes: moderngl.Texture, where: Where) -> Box:
    """The smallest that holds all pixels of a class. Waits for the GPU."""
    depth = np.frombuffer(classes.read(), np.float32).reshape(classes.height, classes.width)
    return box_of(where.holds(depth), classes.size)
