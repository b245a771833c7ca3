"""What is to be seen: frozen records, named instances, their schema, and presets (TOML ↔ scene)."""

from .frozen import FrozenMap
from .instances import Instance
from .records import Scene, fields, refuse_other
from .schema import Field, SceneError, Value, nearest_key
from .sections import Camera, Disk, Hole, Playback, Polarization, Post, Rays, Sky, Source

__all__ = [
    "Camera", "Disk", "Field", "FrozenMap", "Hole", "Instance", "Playback", "Polarization", "Post", "Rays", "Scene", "SceneError", "Sky", "Source", "Value",
    "fields", "nearest_key", "refuse_other",
]  # fmt: skip
