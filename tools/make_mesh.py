"""Makes assets/meshes/knot.ply: a torus knot (2, 3) of 3,072 triangles, its colours running along it.

    python tools/make_mesh.py
"""

from __future__ import annotations

from pathlib import Path

import numpy as np

ALONG, AROUND, THICKNESS = 128, 12, 0.28
FILE = Path(__file__).resolve().parents[1] / "assets" / "meshes" / "knot.ply"


def curve(t: np.ndarray) -> np.ndarray:
    """The knot's middle line, (…, 3), for t in 0…2π."""
    ring = 1.0 + 0.45 * np.cos(3.0 * t)
    return np.stack([ring * np.cos(2.0 * t), 0.45 * np.sin(3.0 * t), ring * np.sin(2.0 * t)], axis=-1)


def vertices() -> tuple[np.ndarray, np.ndarray]:
    """Places (N, 3) and colours (N, 3), uint8, ring by ring."""
    t = 2.0 * np.pi * np.arange(ALONG) / ALONG
    middle, ahead = curve(t), curve(t + 1e-4) - curve(t - 1e-4)
    ahead /= np.linalg.norm(ahead, axis=1, keepdims=True)
    outward = middle * [1.0, 0.0, 1.0]  # never along the line, so that the tube closes without a twist
    side = np.cross(ahead, outward)
    side /= np.linalg.norm(side, axis=1, keepdims=True)
    other = np.cross(side, ahead)
    angle = 2.0 * np.pi * np.arange(AROUND) / AROUND
    ring = np.cos(angle)[:, None, None] * side + np.sin(angle)[:, None, None] * other
    phases = t[:, None] + np.array([0.0, 2.1, 4.2])
    colours = np.round(255.0 * (0.62 + 0.3 * np.cos(phases))).astype(np.uint8)
    return (middle + THICKNESS * ring).transpose(1, 0, 2).reshape(-1, 3), np.repeat(colours, AROUND, axis=0)


def faces() -> np.ndarray:
    """Corners (F, 3), counter-clockwise from outside."""
    along, around = np.meshgrid(np.arange(ALONG), np.arange(AROUND), indexing="ij")
    here, next_ring = along * AROUND, (along + 1) % ALONG * AROUND
    beside = (around + 1) % AROUND
    a, b, c, d = here + around, next_ring + around, next_ring + beside, here + beside
    return np.stack([np.stack([a, c, b], axis=-1), np.stack([a, d, c], axis=-1)], axis=2).reshape(-1, 3)


def main() -> None:
    places, colours = vertices()
    corners = faces()
    header = (
        f"ply\nformat binary_little_endian 1.0\nelement vertex {len(places)}\nproperty float x\nproperty float y\nproperty float z\n"
        "property uchar red\nproperty uchar green\nproperty uchar blue\n"
        f"element face {len(corners)}\nproperty list uchar ushort vertex_indices\nend_header\n"
    )
    points = np.zeros(len(places), [("place", "<f4", 3), ("colour", "u1", 3)])
    points["place"], points["colour"] = places, colours
    triangles = np.zeros(len(corners), [("count", "u1"), ("corners", "<u2", 3)])
    triangles["count"], triangles["corners"] = 3, corners
    FILE.parent.mkdir(exist_ok=True)
    FILE.write_bytes(header.encode() + points.tobytes() + triangles.tobytes())


if __name__ == "__main__":
    main()
