"""How long steps in media may be for their light to be accurate enough, by what was measured (assets/measurements_media.csv)."""

from __future__ import annotations

import csv
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from functools import lru_cache
from pathlib import Path

from ..resources import assets_dir
from ..scene import Scene, met

PLAIN_STEP = 0.5
"""Where a kind of medium was not measured, as those of one's own are not."""


@dataclass(frozen=True)
class MeasuredMedium:
    """A row of the table, whose columns are these fields in this order.

    Attributes:
        scene: what was measured.
        kind: its medium.
        step: ``rays.medium_step``.
        light_99: error of the light at 99 % of the pixels that show any, of the brightest light of the picture.
        cost_flat_ratio: processor time of a still frame with the media marched anew on rays that are kept, over that of one in flat space without them.
    """

    scene: str
    kind: str
    step: float
    light_99: float
    cost_flat_ratio: float


@dataclass(frozen=True)
class MediumStep:
    """What steps a scene's media are marched in.

    Attributes:
        scene: the scene with the step stated.
        reasons: why, a sentence each; none without media.
        warnings: what turns out worse than the scene asks, a sentence each.
    """

    scene: Scene
    reasons: tuple[str, ...] = ()
    warnings: tuple[str, ...] = ()


def chosen(scene: Scene) -> MediumStep:
    """The longest step measured whose light meets ``rays.light_tolerance`` for all kinds of media in `scene`, or the one that it states."""
    stated, allowed = scene.rays.medium_step, scene.rays.light_tolerance
    if not scene.media:
        return MediumStep(scene)
    known = _by_step(tuple(sorted({kind.key for kind in met.kinds(scene, "medium")})))
    if stated:
        error = max((row.light_99 for row in known.get(stated, ())), default=0.0)
        why = f"the steps in media that are stated err by {error:.2g} of the brightest light, more than the {allowed:g} allowed"
        return MediumStep(scene, (f"media: steps of {stated:g} of the length on which they change, as stated",), (why,) if error > allowed else ())
    if not known:
        step, why = PLAIN_STEP, "plain, as of one of them nothing was measured"
        return MediumStep(_with_step(scene, step), (f"media: steps of {step:g} of the length on which they change: {why}",))
    good = [step for step, rows in known.items() if max(row.light_99 for row in rows) <= allowed]
    step = max(good) if good else min(known)
    worst = max(known[step], key=lambda row: row.light_99)
    reason = (
        f"media: steps of {step:g} of the length on which they change: the light errs by {worst.light_99:.2g} of the brightest where it is worst "
        f"({worst.scene}), and costs {max(row.cost_flat_ratio for row in known[step]):.3g} flat frames"
    )
    floor = () if good else (f"{allowed:g} of the brightest light cannot be met in media: {worst.light_99:.2g} is the least that was measured",)
    return MediumStep(_with_step(scene, step), (reason,), floor)


@lru_cache(maxsize=1)
def measurements() -> Sequence[MeasuredMedium]:
    """The rows of the table; none where there is no table."""
    path = assets_dir() / "measurements_media.csv"
    return read(path) if path.is_file() else ()


def read(path: Path) -> Sequence[MeasuredMedium]:
    """The rows of the table at `path`.

    Raises:
        OSError, ValueError: it cannot be read, or a row is none.
    """
    with open(path, newline="", encoding="utf-8") as file:
        rows = csv.DictReader(line for line in file if not line.startswith("#"))
        return tuple(MeasuredMedium(row["scene"], row["kind"], float(row["step"]), float(row["light_99"]), float(row["cost_flat_ratio"])) for row in rows)


def _with_step(scene: Scene, step: float) -> Scene:
    return scene.with_values({"rays.medium_step": step})


@lru_cache(maxsize=16)
def _by_step(kinds: tuple[str, ...]) -> Mapping[float, Sequence[MeasuredMedium]]:
    """Step → the rows of `kinds`, for the steps that all of them were measured with; empty where one was not."""
    steps = [{row.step for row in measurements() if row.kind == kind} for kind in kinds]
    return {step: [row for row in measurements() if row.kind in kinds and row.step == step] for step in sorted(set.intersection(*steps))}
