"""How a scene's rays are traced, and why: one `Plan` a frame."""

from .make import forget_measurements, plan, refine_px, unfit_options
from .record import GRID_MARGIN, HALF_MARGIN, HALF_STEP, INNERMOST_CROSSING, MERIDIAN, REACH_STEP, REFINE_STEP, WORLD, Plan
from .steps import MARCH_BOUND, steps_in_motion

__all__ = [
    "GRID_MARGIN",
    "HALF_MARGIN",
    "HALF_STEP",
    "INNERMOST_CROSSING",
    "MARCH_BOUND",
    "MERIDIAN",
    "REACH_STEP",
    "REFINE_STEP",
    "WORLD",
    "Plan",
    "forget_measurements",
    "plan",
    "refine_px",
    "steps_in_motion",
    "unfit_options",
]
