"""Scenes and pictures on disk and in the clipboard, as the window's buttons and keys reach them."""

from __future__ import annotations

from dataclasses import replace
from datetime import datetime
from pathlib import Path

import numpy as np

from ..output import png
from ..rendering.annotation import annotated
from ..rendering.views import View
from ..scene import Scene, presets
from . import files_outside, preset_switch
from .state import WindowState


def path_of(text: str) -> Path:
    """The file that the panel's file field means: a bare name lies among the user's presets, and ``.toml`` may be left out."""
    path = Path(text.strip()).expanduser()
    if path.suffix.lower() not in presets.FILES:
        path = path.with_name(path.name + ".toml") if path.name else path
    return path if path.is_absolute() or len(path.parts) > 1 else presets.user_presets_dir() / path


def save(state: WindowState) -> None:
    """Saves the scene as a preset; a file that is already there is replaced only when asked a second time."""
    if not state.file.strip():
        state.complain("The file field is empty: type a name, then save.")
        return
    path = path_of(state.file)
    if path.exists() and state.replace_file != str(path):
        state.replace_file = str(path)
        state.say(f"{path} exists. Save again to replace it.")
        return
    state.replace_file = ""
    own = path.parent == presets.user_presets_dir()
    if own and path.stem in {info.name for info in presets.available() if info.path.parent != path.parent}:
        state.complain(f"{path.stem} is the name of a preset that comes with the program, which would hide yours: type another.")
        return
    try:
        presets.save(state.scene, path, time=state.time, paused=state.paused)
    except presets.SceneError as error:
        state.complain(str(error))
        return
    layered = {group: name for group, name in state.chosen.items() if group in preset_switch.LAYERED}
    state.put_in_force(state.scene, layered | ({presets.USER_GROUP: path.stem} if own else {}))
    state.say(f"Saved {path}")


def load(state: WindowState) -> None:
    """Shows the scene of the file named in the file field, a preset or a picture that was saved here."""
    path = path_of(state.file)
    any_file = files_outside.allowed(state, str(path))
    try:
        scene, preset = presets.load([path], any_file=any_file), presets.read(path, any_file=any_file)
        refused = preset.refused(Scene())
    except presets.SceneError as error:
        state.complain(str(error))
        return
    _open(state, scene, preset)
    files_outside.tell(state, f"Loaded {path}", str(path), preset, refused, "Load it again")


def open_chosen(state: WindowState, path: Path) -> None:
    """Shows the scene of `path`."""
    state.file = str(path)
    load(state)


def save_chosen(state: WindowState, path: Path) -> None:
    """Saves the scene to `path`, which the user has agreed to have replaced; the name ends in ``.toml`` whatever was typed."""
    state.file = str(path if path.suffix.lower() == ".toml" else path.with_name(path.name + ".toml"))
    state.replace_file = str(path_of(state.file))
    save(state)


def text_of(state: WindowState) -> str:
    """The scene as TOML for the clipboard."""
    state.say("The scene is in the clipboard, as TOML.")
    return presets.dumps(state.scene, time=state.time, paused=state.paused)


def take(state: WindowState, text: str) -> None:
    """Shows the scene that `text` (TOML, from the clipboard) says."""
    try:
        preset = presets.parse(text, "clipboard")
        if not preset.values:
            raise presets.PresetError("; ".join(["holds no value of a scene", *preset.skipped[:1], "copy a preset's text first"]), source="clipboard")
        preset = replace(preset, any_file=files_outside.allowed(state, text))
        scene, refused = preset.over(Scene()), preset.refused(Scene())
    except presets.SceneError as error:
        state.complain(str(error))
        return
    _open(state, scene, preset)
    files_outside.tell(state, "Took the scene from the clipboard.", text, preset, refused, "Paste it again")


def _open(state: WindowState, scene: Scene, preset: presets.Preset) -> None:
    """Shows `scene`, which no preset with a name says, from the time of the `preset` that it was in."""
    state.put_in_force(scene, {})
    state.play_from(preset)


def save_picture(state: WindowState, pixels: np.ndarray, view: View | None, folder: Path) -> None:
    """Writes `pixels` ((height, width, 3) uint8, top row first), which show the diagnostic `view` if there is one, with the scene inside to a new file in
    `folder`; labels and the view's scale are drawn in as the scene asks."""
    path = new_picture(folder)
    try:
        png.write(path, annotated(pixels, state.scene, view), presets.picture_text(state.scene, state.time, folder.absolute(), paused=state.paused))
    except OSError as error:
        state.complain(f"{path}: cannot be written: {error.strerror or error}")
        return
    state.say(f"Saved {path}")


def new_picture(folder: Path) -> Path:
    """A name for a picture in `folder` that is not taken yet."""
    stem = datetime.now().strftime("blackhole-%Y%m%d-%H%M%S")
    path, count = folder / f"{stem}.png", 1
    while path.exists():
        count += 1
        path = folder / f"{stem}-{count}.png"
    return path
