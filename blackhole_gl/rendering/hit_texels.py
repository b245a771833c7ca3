"""How hits lie in texels, on the host: the other half of shaders/common/hit_texels.glsl."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass, fields, replace
from functools import cache

import numpy as np

from ..glsl.declared import Fate
from ..shapes import Bool, Float, Int

Array = np.ndarray

MOST_CROSSINGS = 3
"""Crossings of the disk's plane that a map can keep."""


def momenta_textures(meetings: int) -> int:
    """Textures of the crossings' momenta, which listed rays leave after those of `textures`: GL 3.3 has eight targets at once, and `meetings` may fill them."""
    return 2 if meetings < 2 else 0


def textures(orders: int, meetings: int = 0, times: bool = False) -> int:
    """Textures of a map that keeps `orders` crossings and `meetings` with things and media, and of each, with `times`, how long its light is under way."""
    return 1 + min(orders, 2) + 2 * meetings + times


@cache
def names(orders: int, meetings: int, times: bool) -> tuple[str, ...]:
    """What shaders call them, in their order."""
    of_meetings = [name for k in range(meetings) for name in (f"met{k}", f"way{k}")]
    return *(f"hits{k}" for k in range(textures(orders))), *of_meetings, *["times"] * times


@dataclass(frozen=True)
class HitArrays:
    """A hit map on the host; row 0 is the picture's bottom row, as GL stores it.

    Attributes:
        fate: int (…): a `glsl.declared.Fate`.
        steps: int (…).
        direction: float32 (…, 3): asymptotic unit vectors in the world; zero unless escaped.
        lambda_: float32 (…): L_z/E in M; zero when no crossings are kept.
        crossing: float32 (…, 3, 2): r·(cos φ, sin φ) in r_s, of a tilted disk in its own axes (`physics.tilted_disk`); zero = none.
        inbound: bool (…, 3): whether the light at each crossing still comes in towards the hole, so that k_r < 0, or of a tilted disk whether it goes
            south there, k_θ > 0; means nothing in the view `conservation`.
        delay: float32 (…, 3): how long light is under way from each crossing to the camera, in r_s/c; to one at infinity, less r + ln r of it in r_s.
            NaN without a crossing; None where no times are kept.
        momentum: float32 (…, 3, 2): (k_r, k_θ) at each crossing of the photon that arrives, covariant in Boyer–Lindquist's coordinates with M = 1 and
            |E| = 1; NaN without a crossing. None of a picture's pixels: kept of listed rays alone.
        met: int (…, meetings, 3): (kind, instance, crossings before) of what the ray meets, kinds numbered as in `instances.used`; −1 for none.
        met_place: float32 (…, meetings, 3): where, in r_s in the world; zero without.
        met_rates: float32 (…, meetings, 4): the ray's momentum there, n_rate and w_rate of shaders/common/hits.glsl. All None where there is nothing to meet.
        met_delay: float32 (…, meetings): as `delay`; 0 without; None where no times are kept.
    """

    fate: Int[Array, "*rays"]
    steps: Int[Array, "*rays"]
    direction: Float[Array, "*rays 3"]
    lambda_: Float[Array, "*rays"]
    crossing: Float[Array, "*rays 3 2"]
    inbound: Bool[Array, "*rays 3"]
    delay: Float[Array, "*rays 3"] | None = None
    momentum: Float[Array, "*rays 3 2"] | None = None
    met: Int[Array, "*rays meetings 3"] | None = None
    met_place: Float[Array, "*rays meetings 3"] | None = None
    met_rates: Float[Array, "*rays meetings 4"] | None = None
    met_delay: Float[Array, "*rays meetings"] | None = None

    @property
    def momenta(self) -> Float[Array, "*rays 3 2"]:
        """`momentum` of listed rays.

        Raises:
            ValueError: these are the hits of a picture.
        """
        if self.momentum is None:
            raise ValueError("the hits of a picture have no momenta: they are kept of listed rays alone")
        return self.momentum

    def each(self, function: Callable[[Array], Array]) -> HitArrays:
        """The hits with `function` applied to every array there is."""
        there = {item.name: getattr(self, item.name) for item in fields(self)}
        return replace(self, **{name: function(values) for name, values in there.items() if values is not None})


def fates_and_steps(texels: Float[Array, "*rays 4"]) -> tuple[Int[Array, "*rays"], Int[Array, "*rays"]]:
    """Both int (…), from the first texture's texels (…, 4)."""
    packed = texels[..., 3].astype(np.int32)
    return packed & 3, packed >> 2


def unpacked(texels: Sequence[Float[Array, "*rays 4"]], orders: int, meetings: int, times: bool) -> HitArrays:
    """The hits in the texels (…, 4) of `textures`, directions and places as they lie there."""
    plane = textures(orders)
    first, kept = texels[0], list(texels[1:plane])
    kept += [np.zeros_like(first)] * (2 - len(kept))
    fate, steps = fates_and_steps(first)
    crossing = np.stack([kept[0][..., :2], kept[1][..., :2], kept[1][..., 2:]], axis=-2)
    inbound = (kept[0][..., 3, None].astype(np.int32) >> np.arange(MOST_CROSSINGS) & 1) == 1
    direction = np.where(fate[..., None] == Fate.ESCAPED, first[..., :3], np.float32(0.0))
    found = HitArrays(fate, steps, direction, kept[0][..., 2], crossing, inbound)
    if times:
        kept_times = texels[plane + 2 * meetings]
        found = replace(found, delay=np.where(np.any(crossing != 0.0, axis=-1), kept_times[..., :3], np.float32(np.nan)))
        found = replace(found, met_delay=kept_times[..., [3, 2]][..., :meetings] if meetings else None)
    if not meetings:
        return found
    places = np.stack(texels[plane : plane + 2 * meetings : 2], axis=-2)
    met = met_of(places)
    rates = np.stack(texels[plane + 1 : plane + 2 * meetings : 2], axis=-2)
    return replace(found, met=met, met_place=places[..., :3], met_rates=rates)


def met_of(texels: Float[Array, "*rays 4"]) -> Int[Array, "*rays 3"]:
    """`HitArrays.met` (…, 3) of one meeting, from its texture of places."""
    packed = texels[..., 3].astype(np.int32)
    return np.where(packed[..., None] > 0, np.stack([(packed & 31) - 1, packed >> 8, (packed >> 5) & 3], axis=-1), -1)


def momenta(texels: Sequence[Float[Array, "*rays 4"]], crossing: Float[Array, "*rays 3 2"]) -> Float[Array, "*rays 3 2"]:
    """`HitArrays.momentum` (…, 3, 2) from the texels (…, 4) of `momenta_textures` and the crossings (…, 3, 2); NaN where there are none."""
    if not texels:
        return np.full_like(crossing, np.nan)
    found = np.stack([texels[0][..., :2], texels[0][..., 2:], texels[1][..., :2]], axis=-2)
    return np.where(np.any(crossing != 0.0, axis=-1, keepdims=True), found, np.float32(np.nan))
