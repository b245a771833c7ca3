"""Float64 twins of the ray models, written from the equations and sharing no code with the shaders.

A twin registers itself (`registry.twin`): its file in this folder is all that has to be added.
"""

import importlib
import pkgutil

from .hits import CAPTURED, ESCAPED, UNRESOLVED, Crossings, ReferenceHits
from .marching import INNERMOST_CROSSING
from .registry import models, twin, twin_of
from .tracing import trace

__all__ = ["CAPTURED", "ESCAPED", "INNERMOST_CROSSING", "UNRESOLVED", "Crossings", "ReferenceHits", "models", "trace", "twin", "twin_of"]

for _module in pkgutil.iter_modules(__path__):
    importlib.import_module(f"{__name__}.{_module.name}")
