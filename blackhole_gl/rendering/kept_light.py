"""Whether a picture's light is another at another time: where it is not, what was shaded once stands."""

from __future__ import annotations

from ..planning import Plan
from ..scene.frozen import changed
from . import instances, transfer
from .inputs import FrameInputs
from .structure import chosen


def stands(plan: Plan) -> bool:
    """Whether time changes no light of a picture by `plan`: nothing turns, streams or moves in it. Views in false colours have scales that follow."""
    moves = chosen(plan, "disk_layer") or transfer.changes(plan) or instances.anything_moves(plan) or any(kind.traits.changes for kind in chosen(plan, "sky"))
    return plan.scene.post.view == "picture" and not moves


def key(inputs: FrameInputs) -> FrameInputs:
    """All of `inputs` that a picture's light depends on where it `stands`."""
    return changed(inputs, time=0.0)
