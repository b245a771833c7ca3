"""The disk's temperature against the radius, as the texture that shaders/common/disk_temperature.glsl reads."""

from __future__ import annotations

import moderngl

from ..physics import disk_profile
from ..planning import Plan


class TemperatureProfile:
    """The texture, made when it is first asked for and written anew where the disk has another profile."""

    def __init__(self, ctx: moderngl.Context):
        self._ctx = ctx
        self._texture: moderngl.Texture | None = None
        self._key: tuple | None = None

    def of(self, plan: Plan) -> moderngl.Texture:
        """T/T_peak in one row, float32 and filtered linearly, for the disk of `plan`."""
        disk = plan.scene.disk
        key = (disk.temperature_law, plan.space_time.matter_spin(disk), disk.orbit, plan.disk_inner, plan.disk_outer, plan.disk_edge, disk.inner_torque)
        if self._texture is not None and key == self._key:
            return self._texture
        values = disk_profile.table(*key[:5], edge=plan.disk_edge, torque=disk.inner_torque)
        if self._texture is None or self._texture.width != len(values):
            self.release()
            self._texture = self._ctx.texture((len(values), 1), 1, dtype="f4", alignment=4)
            self._texture.filter = (moderngl.LINEAR, moderngl.LINEAR)
            self._texture.repeat_x = self._texture.repeat_y = False
        self._texture.write(values.tobytes())
        self._key = key
        return self._texture

    def release(self) -> None:
        """Gives the GL object back."""
        if self._texture is not None:
            self._texture.release()
        self._texture, self._key = None, None
