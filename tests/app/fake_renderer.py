"""A renderer of flat colours, for tests of the window that do not look at physics."""

import math
import time as clock
from dataclasses import dataclass

import numpy as np

from blackhole_gl.glsl.declared import Fate
from blackhole_gl.rendering import views
from blackhole_gl.rendering.pixel_values import OnDisk, PixelValues


@dataclass(frozen=True)
class Report:
    trace_ms: float = 1.0
    shade_ms: float = 1.0
    post_ms: float = 1.0
    traced: bool = False
    sharp: bool = True
    sharpened: bool = False
    method: str = "flat colour"
    reasons: tuple = ("it is quick",)
    warnings: tuple = ()
    stops: float = 0.0
    settled: bool = True


class FakePrograms:
    """Programs that an edit of a shader would change; a test puts mistakes in."""

    def __init__(self):
        self.errors, self.compiled = [], 0

    def reload(self):
        return self.errors


class FakeHitMap:
    """A hit map that has nothing to forget."""

    generation = 1

    def forget(self):
        pass


class FakeExposure:
    """An exposure that takes any adaptation, and asks for none."""


class FakeRenderer:
    """Keeps what it was asked for and fills the target with a colour that depends on the camera's azimuth."""

    def __init__(self, gl):
        self.calls, self.places, self.stars, self.turnable = [], [], [], []
        self.programs = FakePrograms()
        self.hit_map = FakeHitMap()
        self.exposure = FakeExposure()
        self.settled = True
        self.fail = None
        self.glow_may_last = False
        self.us_per_pixel = 0.0
        self.finer, self.finer_of = 0, None

    def render(self, scene, time, size, target=None, viewport=None, *, measure=False, progressive=False, glow_may_last=False, shown=None, may_turn=False):
        if self.fail is not None:
            raise self.fail
        self.calls.append((scene, time, size))
        self.turnable.append(may_turn)
        self.glow_may_last = glow_may_last
        target.use()
        target.clear(0.5 + scene.camera.azimuth_deg / 720.0, 0.3, 0.1, 1.0, viewport=viewport)
        return Report(trace_ms=1e-3 * self.us_per_pixel * size[0] * size[1], traced=self.us_per_pixel > 0.0, settled=self.settled)

    def turns(self, scene):
        return False

    def still(self, scene, time, size, samples, tile):
        self.still_pixels = np.full((size[1], size[0], 3), 100, np.uint8)
        for done in range(10 * samples):
            clock.sleep(0.005)
            yield (done + 1) / (10 * samples)

    def bands(self, moments, size, samples, tile):
        for scene, time in moments:
            for share in self.still(scene, time, size, samples, tile):
                yield share, self.still_pixels if share == 1.0 else None

    def read_rgb8(self):
        return self.still_pixels

    def release(self):
        pass

    def draw_stars(self, target, viewport):
        self.stars.append((self.calls[-1][2], viewport))

    def render_finer(self, scene, time, size, target=None):
        self.finer = self.finer + 1 if self.finer_of == (scene, time, size) else 1
        self.finer_of = scene, time, size
        target.use()
        target.clear(0.5 + scene.camera.azimuth_deg / 720.0, 0.3, 0.1, 1.0)
        return self.finer

    def view_of(self, scene):
        return views.view_of(scene)

    @property
    def last(self):
        return self

    def values_at(self, place):
        self.places.append(place)
        disk = OnDisk(1, 3.25, 0.5, 0.8, 4100.0)
        return PixelValues(Fate.ESCAPED, -2.5, 7.0, math.nan, None, disk, (1.2, 0.4), "")

    def instance_at(self, place):
        return ""

    def pixels_of(self, scene, path):
        return np.zeros((2, 2), bool)

    def fates_and_steps(self):
        return np.ones((2, 2), int), np.full((2, 2), 10)
