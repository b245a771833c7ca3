"""Blackhole GL: an interactive viewer of black holes whose pictures can be trusted.

::

    import blackhole_gl as bh

    scene = bh.load("kerr", {"hole.spin": 0.5})
    picture = bh.render(scene, (640, 360))      # uint8 (360, 640, 3)

What there is stands in `blackhole_gl.api`, and is imported when it is first used.
"""

from __future__ import annotations

import os
from typing import TYPE_CHECKING, Any

if TYPE_CHECKING:
    from .api import (
        Fate,
        LightCurve,
        Plan,
        Rays,
        Renderer,
        Scene,
        SceneError,
        ScreenCurve,
        Visibilities,
        critical_curve,
        gpus,
        hits,
        isoradials,
        lightcurve,
        load,
        plan,
        presets,
        radiance,
        render,
        save,
        save_sky,
        show,
        trace,
        visibilities,
    )  # fmt: skip

# Read when NumPy is first imported, which takes 40 % longer where OpenBLAS starts a thread for each core: all our matrices are small.
os.environ.setdefault("OPENBLAS_NUM_THREADS", "1")

VERSION = "0.1.0"

__all__ = [
    "Fate", "LightCurve", "Plan", "Rays", "Renderer", "Scene", "SceneError", "ScreenCurve", "Visibilities", "critical_curve", "gpus", "hits", "isoradials",
    "lightcurve", "load", "plan", "presets", "radiance", "render", "save", "save_sky", "show", "trace", "visibilities",
]  # fmt: skip


def __getattr__(name: str) -> Any:
    if name not in __all__:
        raise AttributeError(f"module {__name__!r} has no attribute {name!r}")
    from . import api

    return getattr(api, name)


def __dir__() -> list[str]:
    return sorted({*globals(), *__all__})
