"""Types of arrays that tell their shapes: ``Float[np.ndarray, "N 3"]`` is N vectors, ``Int[np.ndarray, "*rays"]`` of any shape, the same for every ``*rays``.

They are jaxtyping's. Importing that takes longer than importing the twins, and a running program has no use for it: annotations are text there that
nobody reads. So it is imported where types are looked at: by a type checker, and by the tests (tests/shape_checks.py), which have every call checked.
"""

from __future__ import annotations

import sys
from typing import TYPE_CHECKING

if TYPE_CHECKING or "jaxtyping" in sys.modules:
    from jaxtyping import Bool, Complex, Float, Int
else:
    Bool = Complex = Float = Int = None  # names to import, and no more

__all__ = ["Bool", "Complex", "Float", "Int"]
