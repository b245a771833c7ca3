"""What stands in the space of the path view: the hole, the photon shell, the disk, as lines and triangles in r_s. No imgui here."""

from __future__ import annotations

from dataclasses import dataclass
from functools import lru_cache

import numpy as np

from ..physics import relativity, tilted_disk
from ..planning import plan as make_plan
from ..scene import Scene
from ..shapes import Float, Int

_MERIDIANS = 12
_TURN = np.linspace(0.0, 2.0 * np.pi, 73)
_REACH = 4.0  # r_s: light bends here; what lies beyond is shown too, and a turn of the wheel brings it near
_RINGS, _SPOKES = 16, 32  # of the ball


@dataclass(frozen=True, eq=False)
class PathWorld:
    """The space that rays of one scene go through.

    Attributes:
        hole_radius: of the black ball.
        ball: unit sphere, corners float64 (V, 3).
        ball_faces: int (T, 3), which corners make each of its triangles.
        shell: outlines of the region that orbits of light fill, float64 (N, 3) each; none in flat space.
        disk: corners of the disk's triangles, float64 (3 T, 3); none without a disk.
        edges: the disk's edges, float64 (N, 3) each.
        reach: how far from the middle the plot's box reaches at first.
    """

    hole_radius: float
    ball: Float[np.ndarray, "V 3"]
    ball_faces: Int[np.ndarray, "T 3"]
    shell: tuple[np.ndarray, ...]
    disk: Float[np.ndarray, "corners 3"]
    edges: tuple[np.ndarray, ...]
    reach: float


@lru_cache(maxsize=4)  # asked for in every frame
def of(scene: Scene) -> PathWorld:
    """What stands in the space of `scene`.

    Raises:
        SceneError: its parts do not fit together.
    """
    plan = make_plan(scene)
    where, hole = plan.space_time, plan.scene.hole
    size = hole.horizon_size if plan.model.traits.marches_in == "cartesian" else 1.0
    with_disk = plan.scene.disk.enabled
    shell = () if where.kind == "flat" else _shell(where.horizon_spin, hole.gravity_strength)
    reach = max(_REACH, *(1.5 * float(np.linalg.norm(line, axis=1).max()) for line in shell), 0.0)
    axes = tilted_disk.axes(plan.scene.disk)
    disk = _annulus(plan.disk_edge, plan.disk_outer) @ axes if with_disk else np.zeros((0, 3))
    edges = (_ring(plan.disk_edge) @ axes, _ring(plan.disk_outer) @ axes) if with_disk else ()
    return PathWorld(where.horizon_radius * size, *_sphere(), shell, disk, edges, reach)


def _ring(radius: float) -> np.ndarray:
    return radius * np.column_stack([np.cos(_TURN), np.sin(_TURN), np.zeros_like(_TURN)])


def _annulus(inner: float, outer: float) -> np.ndarray:
    a, b = _ring(inner), _ring(outer)
    triangles = [np.stack([a[:-1], b[:-1], b[1:]], axis=1), np.stack([a[:-1], b[1:], a[1:]], axis=1)]
    return np.concatenate(triangles).reshape(-1, 3)


def _shell(spin: float, gravity: float) -> tuple[np.ndarray, ...]:
    """Cuts of the shell with half-planes through the axis, and its innermost and outermost orbit, both in the equator."""
    r, cosine = relativity.photon_shell(spin)
    r = gravity * np.concatenate([r, r[::-1]])
    cosine = np.concatenate([cosine, -cosine[::-1]])
    sine = np.sqrt(1.0 - cosine**2)
    turns = np.linspace(0.0, 2.0 * np.pi, _MERIDIANS, endpoint=False)
    cuts = (np.column_stack([r * sine * np.cos(turn), r * sine * np.sin(turn), r * cosine]) for turn in turns)
    return (*cuts, _ring(float(r.min())), _ring(float(r.max())))


def _sphere() -> tuple[np.ndarray, np.ndarray]:
    theta, phi = np.linspace(0.0, np.pi, _RINGS + 1), np.linspace(0.0, 2.0 * np.pi, _SPOKES, endpoint=False)
    t, p = np.meshgrid(theta, phi, indexing="ij")
    corners = np.stack([np.sin(t) * np.cos(p), np.sin(t) * np.sin(p), np.cos(t)], axis=-1).reshape(-1, 3)
    ring, spoke = np.meshgrid(np.arange(_RINGS), np.arange(_SPOKES), indexing="ij")
    here, beside = ring * _SPOKES + spoke, ring * _SPOKES + (spoke + 1) % _SPOKES
    faces = np.concatenate([np.stack([here, here + _SPOKES, beside], axis=-1), np.stack([beside, here + _SPOKES, beside + _SPOKES], axis=-1)])
    return corners, faces.reshape(-1, 3)
