"""Mesh files of strangers: read right, or refused with a sentence; never anything else."""

from __future__ import annotations

import base64
import json
import struct
from pathlib import Path

import numpy as np
import pytest

from blackhole_gl.rendering import mesh_files, meshes
from blackhole_gl.rendering.mesh_files import Mesh, MeshFiles
from blackhole_gl.resources import assets_dir
from blackhole_gl.scene.schema import SceneError

KEY = "things.ship.file"
CORNERS = np.array([[0.0, 0.0, 0.0], [1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0]])
FACES = np.array([[0, 2, 1], [0, 1, 3], [0, 3, 2], [1, 2, 3]])  # counter-clockwise from outside


def read(path: Path) -> Mesh:
    return MeshFiles().read(KEY, str(path))[1]


def obj(corners: np.ndarray = CORNERS, faces: np.ndarray = FACES) -> bytes:
    return "".join([f"v {x} {y} {z}\n" for x, y, z in corners] + [f"f {a + 1} {b + 1} {c + 1}\n" for a, b, c in faces]).encode()


def ply(corners: np.ndarray = CORNERS, faces: np.ndarray = FACES, colour: str = "255 0 0") -> bytes:
    header = f"ply\nformat ascii 1.0\nelement vertex {len(corners)}\nproperty float x\nproperty float y\nproperty float z\n"
    header += "property uchar red\nproperty uchar green\nproperty uchar blue\n"
    header += f"element face {len(faces)}\nproperty list uchar int vertex_indices\nend_header\n"
    return (header + "".join(f"{x} {y} {z} {colour}\n" for x, y, z in corners) + "".join(f"3 {a} {b} {c}\n" for a, b, c in faces)).encode()


def stl(corners: np.ndarray = CORNERS, faces: np.ndarray = FACES) -> bytes:
    records = b"".join(np.concatenate([np.zeros(3), *corners[face]]).astype("<f4").tobytes() + b"\0\0" for face in faces)
    return b"\0" * 80 + struct.pack("<I", len(faces)) + records


def tree(uri: str | None = None, **changes: object) -> dict:
    data = buffer()
    made: dict = {
        "asset": {"version": "2.0"},
        "scene": 0,
        "scenes": [{"nodes": [0]}],
        "nodes": [{"mesh": 0}],
        "meshes": [{"primitives": [{"attributes": {"POSITION": 0}, "indices": 1}]}],
        "accessors": [
            {"bufferView": 0, "componentType": 5126, "count": 4, "type": "VEC3", "min": [0, 0, 0], "max": [1, 1, 1]},
            {"bufferView": 1, "componentType": 5125, "count": 12, "type": "SCALAR"},
        ],
        "bufferViews": [{"buffer": 0, "byteLength": 48}, {"buffer": 0, "byteOffset": 48, "byteLength": 48}],
        "buffers": [{"byteLength": len(data)} if uri is None else {"byteLength": len(data), "uri": uri}],
    }
    return made | changes


def buffer() -> bytes:
    return CORNERS.astype("<f4").tobytes() + FACES.astype("<u4").tobytes()


def glb(given: dict | None = None) -> bytes:
    text = json.dumps(given or tree()).encode()
    text += b" " * (-len(text) % 4)
    body = struct.pack("<II", len(text), 0x4E4F534A) + text + struct.pack("<II", len(buffer()), 0x004E4942) + buffer()
    return struct.pack("<4sII", b"glTF", 2, 12 + len(body)) + body


def gltf(**changes: object) -> bytes:
    return json.dumps(tree("data:application/octet-stream;base64," + base64.b64encode(buffer()).decode(), **changes)).encode()


WHOLE = {".obj": obj, ".ply": ply, ".stl": stl, ".glb": glb, ".gltf": gltf}


@pytest.mark.parametrize("suffix", WHOLE)
def test_every_kind_of_file_gives_the_same_triangles_within_the_unit_ball(tmp_path: Path, suffix: str) -> None:
    path = tmp_path / f"a{suffix}"
    path.write_bytes(WHOLE[suffix]())
    mesh = read(path)
    assert mesh.corners.shape == (4, 3, 3)
    radius = np.linalg.norm(mesh.corners, axis=-1)
    assert radius.max() == pytest.approx(1.0, abs=1e-6)
    outward = np.cross(mesh.corners[:, 1] - mesh.corners[:, 0], mesh.corners[:, 2] - mesh.corners[:, 0])
    assert np.all((outward * (mesh.corners.mean(axis=1) - mesh.corners.mean(axis=(0, 1)))).sum(axis=-1) > 0.0)
    np.testing.assert_allclose(mesh.normals, np.repeat((outward / np.linalg.norm(outward, axis=1, keepdims=True))[:, None], 3, axis=1), atol=1e-5)
    assert (mesh.colours is not None) == (suffix == ".ply")


def test_colours_are_linear_and_round_shapes_are_smooth() -> None:
    mesh = read(assets_dir() / "meshes" / "knot.ply")
    assert len(mesh.corners) == 3072 and mesh.colours is not None and 0.05 < mesh.colours.min() < mesh.colours.max() < 0.9
    across = np.cross(mesh.corners[:, 1] - mesh.corners[:, 0], mesh.corners[:, 2] - mesh.corners[:, 0])
    flat = across / np.linalg.norm(across, axis=1, keepdims=True)
    assert np.mean((mesh.normals * flat[:, None]).sum(axis=-1) < 0.9999) > 0.9


def test_a_buffer_beside_the_file_is_read_and_one_elsewhere_is_not(tmp_path: Path) -> None:
    folder = tmp_path / "mine"
    folder.mkdir()
    (folder / "a b.bin").write_bytes(buffer())
    (tmp_path / "other.bin").write_bytes(buffer())
    path = folder / "a.gltf"
    path.write_text(json.dumps(tree("a%20b.bin")))
    assert len(read(path).corners) == 4
    (folder / "link.bin").symlink_to(tmp_path / "other.bin")
    elsewhere = ("../other.bin", str(tmp_path / "other.bin"), "file:///etc/passwd", "http://127.0.0.1:9/a.bin", "link.bin", "%2e%2e/other.bin", "//host/a")
    for uri in elsewhere:
        path.write_text(json.dumps(tree(uri)))
        with pytest.raises(SceneError, match="not in its own folder"):
            read(path)


@pytest.mark.parametrize(
    "name, data, says",
    [
        ("a.obj", b"", "it is empty"),
        ("a.obj", b"# nothing\n", ""),
        ("a.obj", obj(np.where(CORNERS == 1.0, np.nan, CORNERS)), "no finite number"),
        ("a.stl", stl(np.where(CORNERS == 1.0, np.inf, CORNERS)), "no finite number"),
        ("a.ply", ply(faces=FACES + 7), ""),
        ("a.ply", ply(faces=FACES - 2), ""),
        ("a.obj", obj(faces=FACES + 70), ""),
        ("a.stl", stl(0.0 * CORNERS), "in one place"),
        ("a.obj", obj(CORNERS * [1.0, 0.0, 0.0]), "no triangle has an area"),
        ("a.stl", stl()[:80] + struct.pack("<I", 2**31) + stl()[84:], ""),
        ("a.ply", ply().replace(b"vertex 4", b"vertex 99999999999"), "it says that it has 99999999999 entries"),
        ("a.glb", glb()[:60], "too early"),
        ("a.glb", glb(tree(extensionsRequired=["KHR_draco_mesh_compression"])), "it needs the extensions"),
        ("a.gltf", gltf(accessors=[{"componentType": 5126, "count": 10**12, "type": "VEC3"}] * 2), "no sensible count"),
        ("a.gltf", gltf(accessors=[{"bufferView": 0, "componentType": 5126, "count": 10**6, "type": "VEC3"}] * 2), ""),
        ("a.gltf", b"[" * 100_000, "damaged"),
        ("a.gltf", b"[]", "no object"),
        ("a.obj", b"\x89PNG\r\n\x1a\n" + bytes(range(256)) * 9, ""),
    ],
)
def test_what_is_wrong_with_a_file_is_said_with_its_key_and_what_is_allowed(tmp_path: Path, name: str, data: bytes, says: str) -> None:
    path = tmp_path / name
    path.write_bytes(data)
    with pytest.raises(SceneError) as caught:
        read(path)
    assert caught.value.key == KEY
    assert str(path) in caught.value.message and says in caught.value.message and "allowed is an OBJ" in caught.value.message


def test_the_size_of_a_file_s_numbers_does_not_matter(tmp_path: Path) -> None:
    path = tmp_path / "a.stl"
    for scale in (1e38, 1e-30):
        path.write_bytes(stl(scale * CORNERS))
        assert np.linalg.norm(read(path).corners, axis=-1).max() == pytest.approx(1.0, abs=1e-6)


def test_too_much_is_refused_before_it_is_read(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    path = tmp_path / "a.stl"
    with path.open("wb") as stream:
        stream.truncate(100 << 20)
    with pytest.raises(SceneError, match=f"it has {100 << 20} bytes"):
        read(path)
    monkeypatch.setattr(mesh_files, "MOST_TRIANGLES", 3)
    path.write_bytes(stl())
    with pytest.raises(SceneError, match="more than 3 triangles"):
        read(path)
    with pytest.raises(SceneError, match="it is no file"):
        read(tmp_path)
    with pytest.raises(SceneError, match="No such file"):
        read(tmp_path / "none.obj")


@pytest.mark.parametrize("suffix", WHOLE)
def test_damaged_files_are_read_or_refused_and_nothing_else(tmp_path: Path, suffix: str) -> None:
    rng, whole = np.random.default_rng(4), np.frombuffer(WHOLE[suffix](), np.uint8)
    path = tmp_path / f"a{suffix}"
    for turn in range(60):
        data = whole[: rng.integers(1, len(whole))].copy() if turn % 2 else whole.copy()
        places = rng.integers(0, len(data), rng.integers(1, 6))
        data[places] = rng.integers(0, 256, len(places))
        path.write_bytes(data.tobytes())
        try:
            mesh = read(path)
        except SceneError as error:
            assert error.key == KEY and "allowed is" in error.message
        else:
            assert np.all(np.isfinite(mesh.corners)) and np.all(np.isfinite(mesh.normals)) and np.abs(mesh.corners).max() <= 1.0 + 1e-6


def test_triangles_know_those_beyond_their_sides() -> None:
    """Of a pyramid each has three neighbours, with which it shares the side opposite to that corner; without its base the sides there have none."""
    top, base = (0.0, 0.0, 1.0), [(1.0, 0.0, 0.0), (0.0, 1.0, 0.0), (-1.0, -1.0, 0.0)]
    sides = [(base[k], base[(k + 1) % 3], top) for k in range(3)]
    whole = np.array([*sides, (base[2], base[1], base[0])], np.float32)
    beyond = meshes.beyond_sides(whole)
    for number, corners in enumerate(whole):
        for opposite, other in enumerate(beyond[number]):
            shared = {tuple(corner) for place, corner in enumerate(corners) if place != opposite}
            assert other != number and shared <= {tuple(corner) for corner in whole[other]}
    np.testing.assert_array_equal(meshes.beyond_sides(whole[:3]), [[1, 2, -1], [2, 0, -1], [0, 1, -1]])
    assert meshes.beyond_sides(whole[:0]).shape == (0, 3)
