"""Which function is the twin of which ray model: what a twin is given, what it gives back, and how it is found.

A twin says of itself what it is:

    @twin("my_model", metric=None, parameters={"strength": "rays.my_model.strength"})
    def my_model(view: View, strength: float = 1.0) -> Traced: ...

A file with that in this folder is all there is to adding one: importing the package imports its modules.
"""

from __future__ import annotations

import math
from collections.abc import Callable, Mapping
from dataclasses import dataclass, field, replace

import numpy as np

from ..shapes import Float
from .events import LightRays
from .hits import Traced
from .observers import Momenta, Place, at_rest, momenta

Array = np.ndarray

METRICS = ("flat", "schwarzschild", "kerr")


@dataclass(frozen=True)
class View:
    """The rays that a twin is to trace, and the camera that they leave from.

    Attributes:
        rays: (N, 3) unit look directions (n_r, n_theta, n_phi) in the observer's frame; (N, 2) alpha, beta in M where the camera is at infinity.
        place: the camera's place, r in r_s.
        spin: a*; 0 where the twin says that it has none.
        observer: "static", "zamo", "circular", "rain" or "fall", as used.
        horizon: r in r_s of the metric's horizon; of Kerr's, with this spin, where a model has no such metric; 0 where there is no hole.
        planes: (P, 3) unit normals of the planes through the hole whose crossings are asked for; the equatorial one first.
        balls: (B, 4) centre and radius, in r_s, of the spheres whose crossings are asked for, behind those of the planes.
        velocity: in (r, theta, phi), of the camera in the frame of that observer. fall_from: of "fall", in r_s.
        orders: crossings kept of each plane and ball.
        tolerance: error allowed per step of the integrator.
    """

    rays: Float[Array, "N columns"]
    place: Place
    spin: float
    observer: str
    horizon: float
    planes: Float[Array, "P 3"]
    orders: int
    tolerance: float
    balls: Float[Array, "B 4"] = field(default_factory=lambda: np.zeros((0, 4)))
    velocity: tuple[float, float, float] = (0.0, 0.0, 0.0)
    fall_from: float = math.inf

    @property
    def surfaces(self) -> int:
        """How many surfaces' crossings are asked for."""
        return len(self.planes) + len(self.balls)

    @property
    def at_infinity(self) -> bool:
        return math.isinf(self.place.r)

    @property
    def place_in_m(self) -> Place:
        """The camera's place with r in M."""
        return replace(self.place, r=2.0 * self.place.r)

    def momenta(self, spin: float) -> Momenta:
        """Those of the rays, (N,) each, with the spin that they have. Finite distance only."""
        return momenta(self.rays, self.place_in_m, spin, self.observer, self.velocity, 2.0 * self.fall_from)

    def energies(self, metric: str | None) -> Float[Array, " N"]:
        """E of the rays' light over that which the camera measures, (N,), in one of `METRICS`; NaN in none."""
        if metric is None or self.at_infinity:
            return np.full(len(self.rays), math.nan if metric is None else 1.0)
        if metric == "flat":
            v = np.array(self.velocity)
            return (1.0 - self.rays @ v) / math.sqrt(1.0 - v @ v)
        return self.momenta(-self.spin if metric == "kerr" else 0.0).energy

    @property
    def resting_rays(self) -> Float[Array, "N columns"]:
        """`rays` as who is at rest in the camera's place sees them: for the models of flat space and of Schwarzschild's."""
        if self.at_infinity:
            return self.rays
        r = self.place.r
        of_kind = {
            "circular": (0.0, 0.0, math.sqrt(0.5 / max(r - 1.0, 1e-9))),
            "rain": (-math.sqrt(1.0 / r), 0.0, 0.0),
            "fall": (-math.sqrt(max(1.0 / r - 1.0 / self.fall_from, 0.0) / (1.0 - 1.0 / self.fall_from)), 0.0, 0.0),
        }
        return at_rest(at_rest(self.rays, self.velocity), of_kind.get(self.observer, (0.0, 0.0, 0.0)))

    @property
    def screen(self) -> Float[Array, "N 2"]:
        """(N, 2) alpha, beta in r_s of a camera at infinity."""
        return 0.5 * self.rays


@dataclass(frozen=True)
class Twin:
    """A twin and what it says about itself.

    Attributes:
        trace: gives what the rays of a `View` meet, from it and from parameters by name.
        metric: one of `METRICS`, in which its photons' momenta are null; None for a model whose rays are no light in any metric.
        spins: whether the hole's spin means anything to it.
        has_hole: whether there is one; in a field there is not.
        parameters: what `trace` calls its parameters → the scene keys that hold their values.
        light: gives the rays of a `View` at the camera, for what goes along them (`transfer`), with the same parameters; None for a model whose rays are
            no light, or not those asked for.
    """

    trace: Callable[..., Traced]
    metric: str | None
    spins: bool = True
    has_hole: bool = True
    parameters: Mapping[str, str] = field(default_factory=dict)
    light: Callable[..., LightRays] | None = None


_Trace = Callable[..., Traced]
_TWINS: dict[str, Twin] = {}


def twin(
    *models: str, metric: str | None, spins: bool = True, has_hole: bool = True, parameters: Mapping[str, str] | None = None,
    light: Callable[..., LightRays] | None = None,
) -> Callable[[_Trace], _Trace]:
    """Makes the decorated function the twin of `models`; see `Twin` for what it declares.

    Raises:
        ValueError: one of the models has a twin already, or there is no such metric.
    """
    if metric is not None and metric not in METRICS:
        raise ValueError(f"twin of {', '.join(models)}: got the metric {metric!r}; allowed are {', '.join(METRICS)} and None")

    def register(trace: _Trace) -> _Trace:
        for model in models:
            if model in _TWINS:
                raise ValueError(f"ray model {model!r} has two twins: {_TWINS[model].trace.__module__} and {trace.__module__}")
            _TWINS[model] = Twin(trace, metric, spins, has_hole, dict(parameters or {}), light)
        return trace

    return register


def models() -> tuple[str, ...]:
    """The ray models that have a twin, in alphabetical order."""
    return tuple(sorted(_TWINS))


def twin_of(model: str) -> Twin:
    """The twin of the ray model with the key `model`.

    Raises:
        ValueError: it has none; the text lists those that do.
    """
    if model not in _TWINS:
        raise ValueError(f"ray model {model!r} has no float64 twin; those with one: {', '.join(models())}")
    return _TWINS[model]
