"""Twins of the integrators: one step of each scheme in float64, from its tableau.

    k_i = f(y + h sum_j a_ij k_j),   y' = y + h sum_i b_i k_i,   and with b* instead of b the embedded result of lower order

and of Nystrom's schemes for y'' = f(y):

    k_i = f(y + c_i h y' + h^2 sum_j a_ij k_j),   y -> y + h y' + h^2 sum_i b_i k_i,   y' -> y' + h sum_i b'_i k_i

Sources: Kutta 1901; Nystrom 1925 (Hairer, Norsett & Wanner, Solving Ordinary Differential Equations I, II.14); Bogacki & Shampine 1989;
Dormand & Prince 1980; velocity Verlet is Swope et al. 1982.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from fractions import Fraction as F

import numpy as np

from ..shapes import Float

Array = np.ndarray
RightHandSide = Callable[[Array], Array]


@dataclass(frozen=True)
class Tableau:
    """An explicit Runge-Kutta scheme: rows of a below the diagonal, weights b, and embedded weights b* (empty without)."""

    a: tuple[tuple[F, ...], ...]
    b: tuple[F, ...]
    embedded: tuple[F, ...] = ()


_BS3 = (F(2, 9), F(1, 3), F(4, 9))
_DOPRI5 = (F(35, 384), F(0), F(500, 1113), F(125, 192), F(-2187, 6784), F(11, 84))

TABLEAUX = {
    "euler": Tableau(((),), (F(1),)),
    "rk4": Tableau(((), (F(1, 2),), (F(0), F(1, 2)), (F(0), F(0), F(1))), (F(1, 6), F(1, 3), F(1, 3), F(1, 6))),
    "bs3": Tableau(((), (F(1, 2),), (F(0), F(3, 4)), _BS3), (*_BS3, F(0)), (F(7, 24), F(1, 4), F(1, 3), F(1, 8))),
    "dopri5": Tableau(
        (
            (),
            (F(1, 5),),
            (F(3, 40), F(9, 40)),
            (F(44, 45), F(-56, 15), F(32, 9)),
            (F(19372, 6561), F(-25360, 2187), F(64448, 6561), F(-212, 729)),
            (F(9017, 3168), F(-355, 33), F(46732, 5247), F(49, 176), F(-5103, 18656)),
            _DOPRI5,
        ),
        (*_DOPRI5, F(0)),
        (F(5179, 57600), F(0), F(7571, 16695), F(393, 640), F(-92097, 339200), F(187, 2100), F(1, 40)),
    ),
}


@dataclass(frozen=True)
class NystromTableau:
    """An explicit Runge-Kutta-Nystrom scheme: nodes c, rows of a below the diagonal, weights of places b and of rates b'."""

    c: tuple[F, ...]
    a: tuple[tuple[F, ...], ...]
    b: tuple[F, ...]
    b_rate: tuple[F, ...]


NYSTROM_TABLEAUX = {
    "nystrom4": NystromTableau((F(0), F(1, 2), F(1)), ((), (F(1, 8),), (F(0), F(1, 2))), (F(1, 6), F(1, 3), F(0)), (F(1, 6), F(4, 6), F(1, 6))),
    "nystrom5": NystromTableau(
        (F(0), F(1, 5), F(2, 3), F(1)),
        ((), (F(1, 50),), (F(-1, 27), F(7, 27)), (F(3, 10), F(-2, 35), F(9, 35))),
        (F(14, 336), F(100, 336), F(54, 336), F(0)),
        (F(14, 336), F(125, 336), F(162, 336), F(35, 336)),
    ),
}

SCHEMES = ("euler", "verlet", "bs3", "rk4", "dopri5", "nystrom4", "nystrom5")


def step(scheme: str, rhs: RightHandSide, state: Float[Array, " rows *points"], h: float) -> Float[Array, " rows *points"]:
    """The state after a step of `h`. For ``verlet`` and Nystrom's schemes the first half of the rows are places, the second half their rates."""
    if scheme == "verlet":
        return _verlet(rhs, state, h)
    if scheme in NYSTROM_TABLEAUX:
        return _nystrom(NYSTROM_TABLEAUX[scheme], rhs, state, h)
    tableau = TABLEAUX[scheme]
    return _combined(state, h, tableau.b, _stages(tableau, rhs, state, h))


def pair(
    scheme: str, rhs: RightHandSide, state: Float[Array, " rows *points"], h: float
) -> tuple[Float[Array, " rows *points"], Float[Array, " rows *points"]]:
    """(result, embedded result of lower order) of a step of `h`."""
    tableau = TABLEAUX[scheme]
    stages = _stages(tableau, rhs, state, h)
    return _combined(state, h, tableau.b, stages), _combined(state, h, tableau.embedded, stages)


def _stages(tableau: Tableau, rhs: RightHandSide, state: Array, h: float) -> list[Array]:
    stages: list[Array] = []
    for row in tableau.a:
        stages.append(rhs(_combined(state, h, row, stages)))
    return stages


def _combined(state: Array, h: float, weights: tuple[F, ...], stages: list[Array]) -> Array:
    return state + h * sum((float(weight) * stage for weight, stage in zip(weights, stages)), np.zeros_like(state))


def _nystrom(tableau: NystromTableau, rhs: RightHandSide, state: Array, h: float) -> Array:
    half = len(state) // 2
    place, rate = state[:half], state[half:]
    forces: list[Array] = []
    for c, row in zip(tableau.c, tableau.a):
        at = _combined(place + float(c) * h * rate, h * h, row, forces)
        forces.append(rhs(np.concatenate([at, rate]))[half:])
    return np.concatenate([_combined(place + h * rate, h * h, tableau.b, forces), _combined(rate, h, tableau.b_rate, forces)])


def _verlet(rhs: RightHandSide, state: Array, h: float) -> Array:
    half = len(state) // 2
    place, rate = state[:half], state[half:]
    force = rhs(state)[half:]
    moved = place + h * rate + 0.5 * h * h * force
    return np.concatenate([moved, rate + 0.5 * h * (force + rhs(np.concatenate([moved, rate]))[half:])])
