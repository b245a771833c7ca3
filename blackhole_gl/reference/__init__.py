"""Float64 twins of the ray models, written from the equations and sharing no code with the shaders."""

from .hits import CAPTURED, ESCAPED, UNRESOLVED, ReferenceHits
from .tracing import INNERMOST_CROSSING, MODELS, trace

__all__ = ["CAPTURED", "ESCAPED", "INNERMOST_CROSSING", "MODELS", "UNRESOLVED", "ReferenceHits", "trace"]
