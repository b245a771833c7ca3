"""How a scene's rays are traced, and why."""

from .make import INNERMOST_CROSSING, MARCH_BOUND, REFINE_STEP, RayPlan, effective_disk_radii, march_bound, plan, refine_px, resolved, unfit_options

__all__ = [
    "INNERMOST_CROSSING",
    "MARCH_BOUND",
    "REFINE_STEP",
    "RayPlan",
    "effective_disk_radii",
    "march_bound",
    "plan",
    "refine_px",
    "resolved",
    "unfit_options",
]
