"""What is to be seen: frozen records, their schema, and presets (TOML ↔ scene)."""

from .records import Camera, Disk, Hole, Playback, Post, Rays, Scene, Sky, fields
from .schema import Field, SceneError, Value, nearest_key

__all__ = ["Camera", "Disk", "Field", "Hole", "Playback", "Post", "Rays", "Scene", "SceneError", "Sky", "Value", "fields", "nearest_key"]
