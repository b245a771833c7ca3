"""Draws frames on and on with other presets, sizes and cameras all the while, and says what they hold in memory.

    python tests/shaders/many_frames.py 10000
    python tests/shaders/many_frames.py 100 4         # every fourth preset alone

Prints a line of JSON at the end of each tenth: frames drawn, resident memory in MB, and the living GL objects of each kind. A process of its own, as
others would leave their memory behind. Linux with EGL.
"""

import ctypes
import gc
import json
import sys
from pathlib import Path

sys.path.insert(0, str(Path(__file__).resolve().parents[2]))

import moderngl  # noqa: E402

from blackhole_gl.rendering.context import create_headless  # noqa: E402
from blackhole_gl.rendering.frame import Renderer  # noqa: E402
from blackhole_gl.scene import presets  # noqa: E402

SIZES = ((48, 30), (40, 40), (70, 40), (33, 21))  # no powers of two, for which llvmpipe compiles programs of their own
FRAMES_A_SCENE = 2


def resident_mb() -> float:
    """Resident memory of this process, after what the C library holds free has gone back to the system."""
    gc.collect()
    ctypes.CDLL(None).malloc_trim(0)
    pages = int(Path("/proc/self/statm").read_text().split()[1])
    return pages * 4096 / 1e6


class Census:
    """Counts GL objects by asking for every name that has been given out; drivers need not give a name out twice."""

    def __init__(self, ctx: moderngl.Context):
        self._ctx = ctx
        egl = ctypes.CDLL("libEGL.so.1")
        egl.eglGetProcAddress.restype = ctypes.c_void_p
        asks = {"texture": b"glIsTexture", "framebuffer": b"glIsFramebuffer", "buffer": b"glIsBuffer", "program": b"glIsProgram", "array": b"glIsVertexArray"}
        kind = ctypes.CFUNCTYPE(ctypes.c_ubyte, ctypes.c_uint)
        self._is = {name: kind(egl.eglGetProcAddress(function)) for name, function in asks.items()}

    def count(self) -> dict[str, int]:
        """Kind → living objects."""
        return {kind: sum(map(self._is[kind], range(1, last + 1))) for kind, last in self._last_names().items()}

    def _last_names(self) -> dict[str, int]:
        texture = self._ctx.texture((1, 1), 4)
        program = self._ctx.program(vertex_shader="#version 330 core\nvoid main() { gl_Position = vec4(0.0); }")
        made = {"texture": texture, "framebuffer": self._ctx.framebuffer([texture]), "buffer": self._ctx.buffer(reserve=4), "program": program}
        made["array"] = self._ctx.vertex_array(program, [])
        names = {kind: item.glo for kind, item in made.items()}
        for item in reversed(made.values()):
            item.release()
        return names


def main() -> None:
    frames, every = int(sys.argv[1]), int((*sys.argv, 1)[2])
    ctx = create_headless()
    census = Census(ctx)
    renderer = Renderer(ctx)
    scenes = [presets.load([info.name]) for info in presets.available()[::every]]
    for frame in range(1, frames + 1):
        turn = frame // FRAMES_A_SCENE
        scene = scenes[turn % len(scenes)].with_values({"camera.azimuth_deg": frame % 360, "camera.inclination_deg": 20.0 + frame % 130})
        size = SIZES[turn % len(scenes) % len(SIZES)]  # the same in every round: a larger picture has more levels of bloom
        renderer.render(scene, 0.1 * frame, size, progressive=frame % 2 == 0)
        if frame % max(frames // 10, 1) == 0:
            print(json.dumps({"frames": frame, "mb": round(resident_mb(), 1), **census.count()}), flush=True)


if __name__ == "__main__":
    main()
