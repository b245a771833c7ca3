"""What is saved or shared opens as it was: the same pixels, from a picture, a file and the clipboard."""

import numpy as np
import pytest

from blackhole_gl.app import preset_switch, scene_files
from blackhole_gl.app.state import WindowState
from blackhole_gl.rendering.frame import Renderer
from blackhole_gl.scene import presets

SIZE = (96, 54)
VALUES = {
    "camera.azimuth_deg": -33.3333333, "camera.yaw_deg": 4.125, "camera.pitch_deg": -2.7, "camera.roll_deg": 11.1, "camera.distance": 17.123456789,
    "disk.outer_radius": 8.7654321, "post.exposure": 0.1 + 0.2, "playback.rate": 1.7, "things.ring.kind": "annulus",
}  # fmt: skip


def picture(renderer: Renderer, state: WindowState) -> np.ndarray:
    renderer.render_still(state.scene, state.time, SIZE, 1)
    return renderer.read_rgb8()


@pytest.mark.parametrize("by", ["picture", "file", "clipboard", "command line"])
def test_what_is_shared_opens_as_the_same_picture(renderer: Renderer, tmp_path, monkeypatch, by: str) -> None:
    monkeypatch.setenv("BLACKHOLE_GL_CONFIG_DIR", str(tmp_path))
    state = preset_switch.start(presets.load(["kerr_06", "particle_storm"]).with_values(VALUES), ["kerr_06", "particle_storm"])
    state.time, state.paused = 1234.56789, True
    shown, text = picture(renderer, state), scene_files.text_of(state)
    opened = preset_switch.start(presets.load(["kerr"]), ["kerr"])
    assert not np.array_equal(picture(renderer, opened), shown)
    if by == "clipboard":
        scene_files.take(opened, text)
    else:
        if by == "file":
            state.file = "saved.toml"
            scene_files.save(state)
            (path,) = presets.user_presets_dir().glob("*.toml")
        else:
            scene_files.save_picture(state, shown, None, tmp_path)
            (path,) = tmp_path.glob("*.png")
        opened.file = str(path)
        if by == "command line":
            opened = preset_switch.start(presets.load([path]), [path])
        else:
            scene_files.load(opened)
    assert (opened.scene, opened.time, opened.paused) == (state.scene, state.time, True)
    np.testing.assert_array_equal(picture(renderer, opened), shown)
