"""Light that leaves a thick atmosphere of electrons: how bright and how polarized it is by its angle (Chandrasekhar 1960, *Radiative Transfer*, §68).

With μ the cosine from the normal, the parts of the light that are polarized in the plane of ray and normal and across it are

    I_l ∝ q H_l(μ),   I_r ∝ (μ + c) H_r(μ),   c = 0.87294

H being those of the characteristic functions ¾(1−μ²) and ⅜(1−μ²), and q such that light along the normal is not polarized. I_r is the larger one:
such light is polarized parallel to the surface.
"""

from __future__ import annotations

from functools import cache

import numpy as np

from ..shapes import Float

Array = np.ndarray

_C = 0.87294
_NODES = 64
_ROUNDS = 60  # of an iteration whose error is halved by each


def limb(rise: Float[Array, "*rays"]) -> Float[Array, "*rays"]:
    """Radiance towards cosines `rise` (…) from the normal over that of a surface alike in all directions with the same flux: 0.414 at 0, 1.269 at 1."""
    nodes, weights = _quadrature()
    return sum(_parts(rise)) / (2.0 * np.sum(weights * nodes * sum(_parts(nodes))))


def degree(rise: Float[Array, "*rays"]) -> Float[Array, "*rays"]:
    """Share (…) of that light that is polarized parallel to the surface: 0.117 at 0, none at 1."""
    along, across = _parts(rise)
    return (across - along) / (across + along)


def _parts(rise: Float[Array, "*rays"]) -> tuple[Float[Array, "*rays"], Float[Array, "*rays"]]:
    """(I_l, I_r), each (…), up to a common factor."""
    normal = np.ones(1)
    q = (1.0 + _C) * _h(normal, 0.375) / _h(normal, 0.75)
    return q * _h(rise, 0.75), (rise + _C) * _h(rise, 0.375)


@cache
def _quadrature() -> tuple[Float[Array, " nodes"], Float[Array, " nodes"]]:
    nodes, weights = np.polynomial.legendre.leggauss(_NODES)
    return 0.5 * (nodes + 1.0), 0.5 * weights


def _h(rise: Float[Array, "*rays"], factor: float) -> Float[Array, "*rays"]:
    """Chandrasekhar's H for the characteristic function `factor` (1 − μ²), at cosines `rise` (…)."""
    nodes, weights = _quadrature()
    return _from_nodes(rise, factor, nodes, weights, _h_at_nodes(factor))


@cache
def _h_at_nodes(factor: float) -> Float[Array, " nodes"]:
    nodes, weights = _quadrature()
    found = np.ones(_NODES)
    for _ in range(_ROUNDS):
        found = 0.5 * (found + _from_nodes(nodes, factor, nodes, weights, found))
    return found


def _from_nodes(rise: Array, factor: float, nodes: Array, weights: Array, at_nodes: Array) -> Array:
    """1/H = √(1 − 2∫ψ) + ∫ μ' ψ(μ') H(μ')/(μ + μ') dμ', with ∫ψ = 2/3 `factor`."""
    share = weights * nodes * factor * (1.0 - nodes**2) * at_nodes
    return 1.0 / (np.sqrt(1.0 - 4.0 / 3.0 * factor) + np.sum(share / (np.asarray(rise)[..., None] + nodes), axis=-1))
