"""glTF and GLB → a plain glTF without pictures, and the bytes that its buffers name. What they say of sizes and files is looked at before it is believed."""

from __future__ import annotations

import base64
import json
import struct
from collections.abc import Mapping
from pathlib import Path
from typing import Any
from urllib.parse import unquote

from ..scene import files
from . import stamps
from .stamps import Unusable

MOST_COUNT = 1 << 22  # entries of one accessor, and nodes

_JSON, _BINARY = 0x4E4F534A, 0x004E4942
_LOOKS = ("materials", "textures", "images", "samplers", "animations", "skins", "cameras", "extensions", "extensionsUsed")


def plain(data: bytes, path: Path, most_bytes: int) -> tuple[bytes, Mapping[str, bytes]]:
    """The glTF in `data`, which is the file at `path`, with nothing in it but shapes; and what its buffers hold, by their URIs.

    Raises:
        Unusable: it is damaged, asks for what is not known here, or names a file outside its own folder.
    """
    text, inner = _chunks(data) if data[:4] == b"glTF" else (data, b"")
    try:
        tree = json.loads(text)
    except (ValueError, RecursionError):
        raise Unusable("its JSON is damaged") from None
    if not isinstance(tree, dict):
        raise Unusable("its JSON is no object")
    if needed := tree.pop("extensionsRequired", None):
        raise Unusable(f"it needs the extensions {needed}, and none is known here")
    for name in _LOOKS:
        tree.pop(name, None)
    accessors = _records(tree, "accessors")
    for entry in accessors:
        if not isinstance(entry.get("count"), int) or not 0 <= entry["count"] <= MOST_COUNT or "bufferView" not in entry or "sparse" in entry:
            raise Unusable("an accessor is sparse, has no buffer view, or has no sensible count")
    for mesh in _records(tree, "meshes"):
        for primitive in _records(mesh, "primitives"):
            for name in ("material", "extensions", "targets"):
                primitive.pop(name, None)
    if len(_records(tree, "nodes")) > MOST_COUNT:
        raise Unusable("it has too many nodes")
    buffers = {}
    for number, entry in enumerate(_records(tree, "buffers")):
        buffers[str(number)] = _buffer(entry.get("uri"), number, inner, path, most_bytes)
        entry["uri"] = str(number)
    return json.dumps(tree).encode(), buffers


def _records(tree: Mapping[str, Any], name: str) -> list[dict[str, Any]]:
    found = tree.get(name, [])
    if not isinstance(found, list) or not all(isinstance(entry, dict) for entry in found):
        raise Unusable(f"its {name} are no list of objects")
    return found


def _buffer(uri: Any, number: int, inner: bytes, path: Path, most_bytes: int) -> bytes:
    if uri is None and number == 0 and inner:
        return inner
    if not isinstance(uri, str):
        raise Unusable(f"buffer {number} is nowhere")
    if uri.startswith("data:"):
        try:
            return base64.b64decode(uri.partition(",")[2], validate=True)
        except ValueError:
            raise Unusable(f"buffer {number} is damaged") from None
    beside = path.parent / unquote(uri)
    if ":" in uri or not files.is_within(beside, path.parent):
        raise Unusable(f"it names {uri[:80]!r}, which is not in its own folder")
    stamps.stamp(beside, most_bytes)
    return stamps.content(beside, most_bytes)


def _chunks(data: bytes) -> tuple[bytes, bytes]:
    """The JSON and the binary chunk of a GLB."""
    found: dict[int, bytes] = {}
    place = 12
    while place + 8 <= len(data):
        length, kind = struct.unpack_from("<II", data, place)
        if place + 8 + length > len(data):
            raise Unusable("it ends too early")
        found.setdefault(kind, data[place + 8 : place + 8 + length])
        place += 8 + length
    if _JSON not in found:
        raise Unusable("it has no JSON chunk")
    return found[_JSON], found.get(_BINARY, b"")
