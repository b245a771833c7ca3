"""Makes the pictures in docs/pictures/, which the README shows: `make gallery`.

Each is rendered at twice the size it is shown at, averaged, and kept as a JPEG of 200 KB at most. Those of the window are as it is on the screen.

    python tools/make_gallery.py [NAME …]    those of these names alone
"""

from __future__ import annotations

import os
import subprocess
import sys
import tempfile
from collections.abc import Mapping
from dataclasses import dataclass, field
from pathlib import Path

from PIL import Image

from blackhole_gl.rendering.annotation import annotated
from blackhole_gl.rendering.context import create_headless
from blackhole_gl.rendering.frame import Renderer
from blackhole_gl.scene import presets

WINDOW = Path(__file__).resolve().parent / "window_pictures.py"
WINDOW_SHOTS = ("window", "path_view", "side_by_side")
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
    Shot("default_look", ("kerr", "default_look")),
    Shot("minimal_bloom", ("kerr_0998_85", "minimal_bloom")),
    Shot("smooth", ("kerr", "smooth")),
    Shot("swirling_lanes", ("kerr_06", "swirling_lanes"), {"camera.inclination_deg": 55.0, "camera.fov_deg": 55.0}, time=200.0),
    Shot("points_and_rings", ("kerr_06", "points_and_rings"), {"camera.inclination_deg": 62.0, "camera.fov_deg": 46.0}),
    Shot("clouds", ("kerr", "clouds")),
    Shot("amber_dust", ("kerr_06", "amber_dust"), {"camera.inclination_deg": 66.0, "camera.fov_deg": 46.0}),
    Shot("dragged_points", ("dragged_points",)),
    Shot("m87_like", ("m87_like",)),
    Shot("gargantua_as_filmed", ("gargantua_as_filmed",)),
    Shot("luminet_1979", ("luminet_1979",)),
    Shot("plunging_matter", ("plunging_matter",)),
    Shot("hot_spot", ("hot_spot",)),
    Shot("tilted_disk", ("tilted_disk",)),
    Shot("m87_eht", ("m87_eht",)),
    Shot("sgr_a_eht", ("sgr_a_eht",)),
    Shot("shadow", ("kerr_0998_85",), {"disk.enabled": False, "camera.distance": 6.0, "camera.fov_deg": 70.0, "sky.brightness": 2.0, "post.exposure": 1.5}),
    Shot("labels", ("kerr",), {"post.labels": True}),
    Shot("field_round_the_axis", ("kerr", "smooth"), {"polarization.ticks": True, "polarization.field_vertical": 0.0, "polarization.field_toroidal": 1.0}),
    Shot("field_along_the_axis", ("kerr_06", "smooth"), {"polarization.ticks": True, "camera.inclination_deg": 25.0, "camera.fov_deg": 64.0}),
    Shot("m87_polarized", ("m87_eht",), {"polarization.ticks": True}),
    Shot("objects_black_hole", ("objects_black_hole",)),
    Shot("objects_refraction", ("objects_refraction",)),
    Shot("mirage", ("mirage",)),
    Shot("galaxies_through_a_hole", ("galaxies_through_a_hole",)),
    Shot("objects_potential", ("objects_potential",)),
    Shot("objects_lorenz", ("objects_lorenz",)),
    Shot("crystal_ball", ("crystal_ball",)),
    Shot("galaxies_through_a_screen_lens", ("galaxies_through_a_screen_lens",)),
    Shot("fish_eye", ("fish_eye",)),
    Shot("explosion", ("explosion",)),
    Shot("objects_roessler", ("objects_roessler",)),
    Shot("objects_undistorted", ("objects_undistorted",)),
    Shot("orbiting_star", ("orbiting_star",)),
    Shot("neutron_star", ("neutron_star",)),
    Shot("knot_behind_a_hole", ("knot_behind_a_hole",)),
    Shot("polish_doughnut", ("polish_doughnut",)),
    Shot("cloudy_slab", ("cloudy_slab",), time=24.0),
    Shot("jet", ("jet",)),
    Shot("orbit_at_isco", ("orbit_at_isco",)),
    Shot("hover", ("hover",)),
    Shot("inside_the_horizon", ("inside_the_horizon",)),
    Shot("real_sky", ("real_sky",)),
    Shot("constellations", ("real_sky",), {"sky.catalogue.constellations": True, "sky.catalogue.yaw_deg": 96.0, "camera.inclination_deg": 85.0}),
    *(Shot(f"gold_{number}", (f"gold_{number}",)) for number in range(1, 6)),
)


def save(picture: Image.Image, path: Path) -> None:
    """Writes a JPEG with the best quality that keeps it within LARGEST."""
    for quality in (92, 88, 84, 78, 70):
        picture.save(path, quality=quality, optimize=True, subsampling=0)
        if path.stat().st_size <= LARGEST:
            return
    raise ValueError(f"{path.name}: {path.stat().st_size} bytes at the lowest quality; {LARGEST} are allowed")


def render(shots: list[Shot]) -> None:
    """Makes pictures without a window."""
    renderer = Renderer(create_headless())
    for shot in shots:
        scene = presets.load([*shot.presets, "fine"], dict(shot.changes))
        renderer.render_still(scene, shot.time, SIZE, SAMPLES)
        keep(Image.fromarray(annotated(renderer.read_rgb8(), scene, renderer.view_of(scene))), shot.name)


def photograph(name: str) -> None:
    """Makes a picture of the window, with nothing of the user's own in it."""
    with tempfile.TemporaryDirectory() as folder:
        path = Path(folder) / "window.png"
        environment = {**os.environ, "BLACKHOLE_GL_CONFIG_DIR": folder}
        subprocess.run([sys.executable, str(WINDOW), name, str(path)], check=True, env=environment)
        keep(Image.open(path), name)


def keep(picture: Image.Image, name: str) -> None:
    """Puts a picture where the README looks for it, and says so."""
    path = FOLDER / f"{name}.jpg"
    save(picture, path)
    print(f"{path.relative_to(FOLDER.parents[1])}  {path.stat().st_size // 1000} KB", flush=True)


def main() -> None:
    FOLDER.mkdir(parents=True, exist_ok=True)
    wanted = set(sys.argv[1:]) or {*(shot.name for shot in SHOTS), *WINDOW_SHOTS}
    render([shot for shot in SHOTS if shot.name in wanted])
    for name in WINDOW_SHOTS:
        if name in wanted:
            photograph(name)


if __name__ == "__main__":
    main()
