"""How a scene's rays are traced, and why: one `Plan` a frame."""

from .make import MARCH_BOUND, forget_measurements, plan, refine_px, steps_in_motion, unfit_options
from .record import GRID_MARGIN, HALF_MARGIN, HALF_STEP, INNERMOST_CROSSING, MERIDIAN, REACH_STEP, REFINE_STEP, WORLD, Plan

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
