"""How bright the matter in a scene is, as a light meter beside the camera would find it: what automatic exposure goes by."""

from __future__ import annotations

import math
from collections.abc import Callable

import moderngl
import numpy as np

from ..planning import Plan
from ..scene import Playback, Post, Scene, Sky
from ..scene.frozen import changed
from . import coarse_transfer
from .hit_map import HitMap
from .inputs import FrameInputs
from .programs import Programs
from .shading import ShadePass
from .tables import Tables
from .target import Target
from .temperatures import TemperatureProfile

SIZE = (72, 54)
"""Width and height in pixels of the picture that is metered."""

BRIGHT = (0.8, 0.98)
"""What is exposed for: of the lit pixels, in order of their light, those between these shares. Their mean in stops hardly jitters as the camera moves: by
0.002 stops from frame to frame of a slow flight, where the light of the one at 0.9 does by 0.004."""

ADAPTS = 0.6
"""The share of the stops from there to the key light that is made up for. With all of it a fast hole, whose disk is a hundred times darker but for one
bright spot, would wash out the sky behind; and a dark scene is to look darker than a bright one."""

EVERY = 6
"""Frames of a moving camera from one metering to the next: waiting for the GPU in each would slow it down."""

MOST_STOPS = 8.0
"""The most that is made up for, either way."""

LUMINANCE = np.array([0.2126, 0.7152, 0.0722])
"""Of linear red, green and blue by Rec. 709."""
_MARGIN = 1.1  # of the view over what it is to hold

# r_s; beside the hole a narrow view is all shadow, and nothing in it shines. Where it is wide for that the rings that shine are thin, and need more pixels: of
# `SIZE` alone exposure would jump by half a stop between frames of a dive, of so many times it goes evenly (0.04 stops).
_SHADOW_RADIUS, _WIDEST_DEG, _FINER = 2.6, 150.0, 4


class Exposure:
    """Plans with their exposure made up.

    Args:
        tables, temperatures: what the metered picture is drawn with; they stay their owner's.

    Attributes:
        adaptation: metered stops → those that the next frame shows. In a window exposure follows; else it is there at once.
        stops: what the last plan got; 0 where exposure is fixed.
        settled: whether the next frame of the same would get no other.
    """

    def __init__(self, ctx: moderngl.Context, programs: Programs, tables: Tables, temperatures: TemperatureProfile):
        self.adaptation: Callable[[float], float] = _at_once
        self.stops, self.settled = 0.0, True
        self._meter = Meter(ctx, programs, tables, temperatures)
        self._made: tuple[Plan, float, Plan] | None = None

    def of(self, plan: Plan, *, patient: bool = False, at_once: bool = False) -> Plan:
        """`plan` as it is to be drawn; itself where its exposure is fixed. The same plan gives the same object as long as its stops are the same.

        Args:
            patient: as for `Meter.stops`.
            at_once: leave `adaptation` out.

        Raises:
            As `Meter.stops`.
        """
        post = plan.scene.post
        if post.exposure_mode != "automatic" or post.view != "picture":
            self.stops, self.settled = 0.0, True
            return plan
        metered = self._meter.stops(plan, patient=patient)
        self.stops = metered if at_once else self.adaptation(metered)
        self.settled = self._meter.is_current and self.stops == metered
        if self._made is None or self._made[0] is not plan or self._made[1] != self.stops:
            self._made = plan, self.stops, _exposed(plan, self.stops)
        return self._made[2]

    def release(self) -> None:
        """Gives the GL objects back."""
        self._meter.release()


def _at_once(stops: float) -> float:
    return stops


class Meter:
    """Draws what shines in a scene, small and without its sky, and says how many stops bring it to the scene's key light.

    It looks at the hole from where the camera is, whatever way the camera looks, at scene time 0: so exposure follows the hole and the camera's place, and
    neither a turning disk, nor a turning head, nor the window's shape change it. It needs the programs that draw the picture, and no
    others; where orders are shown apart it meters all of them, so that each is as bright as in the whole picture.

    Attributes:
        is_current: whether the last answer was metered for its own view.
    """

    def __init__(self, ctx: moderngl.Context, programs: Programs, tables: Tables, temperatures: TemperatureProfile):
        self._ctx = ctx
        self.is_current = True
        self._hit_map = HitMap(ctx, programs, tables)
        self._shade = ShadePass(ctx, programs, tables, temperatures)
        self._target: Target | None = None
        self._view: Plan | None = None  # what was metered last
        self._bright = 0.0  # its bright parts, in stops above radiance 1
        self._waited = 0

    def stops(self, plan: Plan, *, patient: bool = False) -> float:
        """Stops that automatic exposure adds to what `plan` shows; 0 where nothing shines. Waits for the GPU where the view has changed.

        Args:
            patient: for a camera that moves: another view is metered only every `EVERY` calls, and `is_current` says whether this one was.

        Raises:
            ValueError, ShaderError, Unready: as the picture's own drawing.
        """
        view = _view(plan)
        self._waited += 1
        if view != self._view and (self._view is None or self._waited >= EVERY or not patient):
            self._bright, self._view, self._waited = self._metered(view), view, 0
        self.is_current = view == self._view
        if math.isinf(self._bright):
            return 0.0
        return min(max(ADAPTS * (math.log2(plan.scene.post.key_light) - self._bright), -MOST_STOPS), MOST_STOPS)

    def release(self) -> None:
        """Gives the GL objects back."""
        self._hit_map.release()
        self._shade.release()
        if self._target is not None:
            self._target.release()
        self._target = self._view = None

    def _metered(self, view: Plan) -> float:
        """The mean of the bright parts in stops above radiance 1; −∞ where nothing shines."""
        if not view.shows_disk and not view.meetings:
            return -math.inf
        size = _size(view)
        if self._target is None or self._target.size != size:
            if self._target is not None:
                self._target.release()
            self._target = Target.of(self._ctx, [self._ctx.texture(size, 4, dtype="f2")])
        inputs = FrameInputs.whole(view, 0.0, size)
        media = coarse_transfer.of(inputs, moving=False, passes=False)
        rest = coarse_transfer.rest_of(inputs, media)
        self._ctx.disable(moderngl.BLEND | moderngl.DEPTH_TEST | moderngl.CULL_FACE)
        self._hit_map.trace(rest)
        self._shade.draw(rest, self._hit_map, self._target.frame, media)
        light = np.frombuffer(self._target.texture.read(), np.float16).reshape(-1, 4)[:, :3].astype(float) @ LUMINANCE
        lit = np.sort(light[light > 0.0])
        first, last = (min(round(share * lit.size), lit.size - 1) for share in BRIGHT)
        return float(np.mean(np.log2(lit[first : max(last, first + 1)]))) if lit.size else -math.inf


def _exposed(plan: Plan, stops: float) -> Plan:
    """`plan` with `stops` more of exposure, and the glow's threshold moved with it, so that what glows is what looks bright."""
    post = plan.scene.post
    exposed = changed(post, exposure=post.exposure + stops, bloom_threshold=post.bloom_threshold * 2.0**-stops)
    return changed(plan, scene=changed(plan.scene, post=exposed))


def _view(plan: Plan) -> Plan:
    """`plan` for what is metered: the hole in the middle, all that shines in the picture or as much as the camera's angle takes in, and nothing else."""
    scene = plan.scene
    camera = changed(scene.camera, yaw_deg=0.0, pitch_deg=0.0, roll_deg=0.0, projection="perspective", azimuth_deg=plan.azimuth_deg)
    radius = _MARGIN * max(plan.disk_outer if plan.shows_disk else 0.0, plan.reach)
    if math.isinf(camera.distance):
        camera = changed(camera, field_m=min(camera.field_m, 4.0 * radius))
    else:
        taken_in = min(camera.fov_deg, _angle_deg(radius, camera.distance))
        camera = changed(camera, fov_deg=max(taken_in, _shadow_deg(camera.distance)))
    disk = changed(scene.disk, orders_shown="all")
    shown = Scene(scene.hole, camera, scene.rays, disk, Sky(enabled=False), Post(), Playback(), scene.parameters, scene.things, scene.media)
    return changed(plan, scene=shown, refine_px=0.0)


def _size(view: Plan) -> tuple[int, int]:
    """Of the metered picture."""
    camera = view.scene.camera
    wide = math.isfinite(camera.distance) and camera.fov_deg <= _shadow_deg(camera.distance)
    return (_FINER * SIZE[0], _FINER * SIZE[1]) if wide else SIZE


def _shadow_deg(distance: float) -> float:
    """The least angle that is metered there."""
    return min(_angle_deg(_SHADOW_RADIUS, distance), _WIDEST_DEG)


def _angle_deg(radius: float, distance: float) -> float:
    """Of what reaches `radius` on both sides, at `distance`."""
    return math.degrees(2.0 * math.atan(radius / distance))
