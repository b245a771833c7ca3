"""Makes the pictures in docs/pictures/, which the README shows: `make gallery`.

Each is rendered at twice the size it is shown at, averaged, and kept as a JPEG of 200 KB at most.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field
from pathlib import Path

from PIL import Image

from blackhole_gl.render.context import create_headless
from blackhole_gl.render.frame import Renderer
from blackhole_gl.scene import presets

FOLDER = Path(__file__).resolve().parents[1] / "docs" / "pictures"
SIZE = (960, 540)
SAMPLES = 2
LARGEST = 200_000


@dataclass(frozen=True)
class Shot:
    """One picture: its file's stem, the presets, what differs from them, and the scene time in r_s/c."""

    name: str
    presets: tuple[str, ...]
    changes: Mapping[str, object] = field(default_factory=dict)
    time: float = 30.0


SHOTS = (
    Shot("kerr", ("kerr",)),
    Shot("schwarzschild", ("schwarzschild",)),
    Shot("kerr_0998_85", ("kerr_0998_85",)),
    Shot("particle_storm", ("kerr_06", "particle_storm"), {"camera.inclination_deg": 60.0, "camera.fov_deg": 55.0}),
    Shot("m87_like", ("m87_like",)),
    Shot("gargantua_as_filmed", ("gargantua_as_filmed",)),
    Shot("luminet_1979", ("luminet_1979",)),
    Shot("shadow", ("kerr_0998_85",), {"disk.enabled": False, "camera.distance": 6.0, "camera.fov_deg": 70.0, "sky.brightness": 2.0}),
)


def save(picture: Image.Image, path: Path) -> None:
    """Writes a JPEG with the best quality that keeps it within LARGEST."""
    for quality in (92, 88, 84, 78, 70):
        picture.save(path, quality=quality, optimize=True, subsampling=0)
        if path.stat().st_size <= LARGEST:
            return
    raise ValueError(f"{path.name}: {path.stat().st_size} bytes at the lowest quality; {LARGEST} are allowed")


def main() -> None:
    FOLDER.mkdir(parents=True, exist_ok=True)
    renderer = Renderer(create_headless())
    for shot in SHOTS:
        renderer.render_still(presets.load([*shot.presets, "fine"], dict(shot.changes)), shot.time, SIZE, SAMPLES)
        path = FOLDER / f"{shot.name}.jpg"
        save(Image.fromarray(renderer.read_rgb8()), path)
        print(f"{path.relative_to(FOLDER.parents[1])}  {path.stat().st_size // 1000} KB", flush=True)


if __name__ == "__main__":
    main()
