"""Words of the window that not everybody knows, each with a sentence."""

from __future__ import annotations

from collections.abc import Mapping
from types import MappingProxyType

WORDS: Mapping[str, str] = MappingProxyType(
    {
        "r_s, M": "The horizon's radius of a hole that does not spin, and half of it: what lengths are counted in.",
        "a*": "The hole's spin, from −1 to 1, as a share of the largest that there can be.",
        "ISCO": "The innermost stable circular orbit: matter that comes nearer falls in.",
        "order n": "How often a ray has gone half round the hole: 0 is the direct image, 1 and 2 are the first and second ring.",
        "g": "The frequency in which light is seen over that in which it was sent: above 1 it is bluer and brighter.",
        "κ, Δt₀": "How long the steps of a ray are, as an angle and as a length: smaller ones err less and take longer.",
        "steps a ray": "How often the picture's rays were moved on, in the mean.",
        "flat frame": "The unit of cost: the same picture with light running straight.",
    }
)
