"""What the diagnostic views show: their colours, scales and legends. Shader and window both take them from here; no GL here."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from types import MappingProxyType

import numpy as np

from ..physics import accretion
from ..scene import Scene

Colour = tuple[float, float, float]  # sRGB, 0…1

Ends = tuple[float, float]
"""Of a scale."""

MAGENTA: Colour = (1.0, 0.0, 1.0)
RED: Colour = (0.90, 0.12, 0.10)
GREY: Colour = (0.22, 0.22, 0.24)
DARK: Colour = (0.10, 0.10, 0.11)
SLATE: Colour = (0.16, 0.22, 0.32)
BROWN: Colour = (0.40, 0.28, 0.14)

_ROUND = tuple(digit * 10.0**power for power in range(10) for digit in (1.0, 2.0, 5.0))

# Ends of the scale of temperatures, of the disk's own highest one: cold rims recede, and what comes near is seen hotter than it is.
_OF_THE_HOTTEST = (0.25, 1.6)

# Viridis (S. van der Walt and N. Smith 2015, CC0) by a polynomial of degree 6 in each channel, fitted here to the 256 published
# colours so that the largest error is least: 0.011.
_VIRIDIS = np.array(
    (
        (0.277, -0.137, 2.083, -13.165, 20.142, -5.887, -2.329),
        (0.004, 1.489, -0.729, -2.018, 7.300, -7.897, 2.756),
        (0.338, 0.954, 5.122, -40.525, 97.290, -101.283, 38.240),
    )
)

# Ends and middle of the diverging map as Oklab (lightness, green–red, blue–yellow): straight lines between them, on which equal steps
# look equal (B. Ottosson, "A perceptual color space for image processing", 2020).
_RED_END, _MIDDLE, _BLUE_END = np.array((0.42, 0.15, 0.08)), np.array((0.94, 0.0, 0.0)), np.array((0.42, -0.03, -0.17))

_OKLAB_TO_ROOTS = np.array(((1.0, 0.3963377774, 0.2158037573), (1.0, -0.1055613458, -0.0638541728), (1.0, -0.0894841775, -1.2914855480)))
_CUBES_TO_LINEAR = np.array(
    ((4.0767416621, -3.3077115913, 0.2309699292), (-1.2684380046, 2.6097574011, -0.3413193965), (-0.0041960863, -0.7034186147, 1.7076147010))
)


@dataclass(frozen=True)
class Scale:
    """A colour scale.

    Attributes:
        low, high: values at its two ends, in `unit`; what lies beyond has the colour of the end.
        is_log: whether equal factors, not equal differences, have equal lengths.
        is_diverging: dark at both ends and light in the middle, instead of dark to light.
        ticks: the values written beside it.
    """

    low: float
    high: float
    unit: str
    is_log: bool
    is_diverging: bool
    ticks: tuple[float, ...]

    def place(self, value: float) -> float:
        """Where on the scale `value` lies, 0…1."""
        low, high, here = (np.log((self.low, self.high, value)) if self.is_log else np.array((self.low, self.high, value))).tolist()
        return min(max((here - low) / (high - low), 0.0), 1.0)

    def colours(self, count: int) -> np.ndarray:
        """`count` sRGB colours (count, 3) from its low to its high end."""
        places = np.linspace(0.0, 1.0, count)
        return _diverging(places) if self.is_diverging else _sequential(places)


@dataclass(frozen=True)
class View:
    """A diagnostic view.

    Attributes:
        title: what is shown.
        scale: None where colours stand for kinds and not for values.
        legend: (meaning, colour) of colours off the scale, in the order in which its shader numbers them.
        has_mean: whether colours of several rays through a pixel may be averaged. Not where a single ray is what one looks for.
    """

    title: str
    scale: Scale | None
    legend: tuple[tuple[str, Colour], ...] = ()
    has_mean: bool = False


_VIEWS: Mapping[str, View] = MappingProxyType(
    {
        "order": View(
            "Crossings of the disk (dim: of its plane only); colours add up",
            None,
            (("direct picture", (0.80, 0.36, 0.10)), ("first ring", (0.12, 0.62, 0.42)), ("second ring", (0.30, 0.34, 0.90)), ("none", DARK)),
            has_mean=True,
        ),
        "g_factor": View(
            "Frequency shift g of the first visible crossing", Scale(0.4, 2.5, "", True, True, (0.4, 0.6, 1.0, 1.6, 2.5)), (("no disk", GREY),), has_mean=True
        ),
        "difference": View(
            "Displacement from the most accurate method",
            Scale(1e-3, 10.0, "px", True, False, (1e-3, 1e-2, 0.1, 1.0, 10.0)),
            (("something else is hit", RED), ("nothing to compare", GREY)),
        ),
        "conservation": View(
            "Relative drift of a conserved quantity",
            Scale(1e-8, 1e-2, "", True, False, (1e-8, 1e-6, 1e-4, 1e-2)),
            (("not measured for this model", GREY), ("unresolved", MAGENTA)),
        ),
        "unresolved": View("Fates of rays", None, (("unresolved", MAGENTA), ("escaped", SLATE), ("captured", DARK), ("meets the disk", BROWN))),
    }
)


def view_of(scene: Scene, steps: Ends | None = None) -> View | None:
    """The view that `scene` asks for by ``post.view``; None for the picture itself.

    Args:
        steps: ends of the scale of steps, from `ends_of`; what the scene allows when None.
    """
    if scene.post.view == "steps":
        low, high = steps or (1.0, float(scene.rays.max_steps))
        return View("Steps of a ray", Scale(low, high, "", True, False, _round_numbers(low, high)), (("unresolved", MAGENTA),), True)
    if scene.post.view == "temperature":
        low, high = (share * accretion.hottest(scene) for share in _OF_THE_HOTTEST)
        return View("Temperature of the disk's light", Scale(low, high, "K", True, False, _round_numbers(low, high)), (("no disk", GREY),), True)
    return _VIEWS.get(scene.post.view)


def scale_of(view: str) -> Scale:
    """The colour scale of the view of that name.

    Raises:
        ValueError: it has none.
    """
    scale = _VIEWS[view].scale if view in _VIEWS else None
    if scale is None:
        raise ValueError(f"got the view {view!r}; allowed is one whose colours stand for values")
    return scale


def tick_text(scale: Scale, index: int) -> str:
    """The number at tick `index`, the last one with its unit."""
    text = f"{scale.ticks[index]:g}".replace("e-0", "e-")
    return f"{text} {scale.unit}" if scale.unit and index == len(scale.ticks) - 1 else text


def has_mean(scene: Scene) -> bool:
    """Whether what `scene` asks for may be the mean of several rays through a pixel: the picture, or a view that has one."""
    view = view_of(scene)
    return view is None or view.has_mean


def ends_of(values: np.ndarray) -> Ends:
    """Ends of a logarithmic scale for `values`, any shape, each at least 1: round numbers round all but the largest thousandth, so that they seldom change."""
    if values.size == 0:
        return 1.0, 10.0
    low, high = max(float(values.min()), 1.0), max(float(np.quantile(values, 0.999)), 1.0)
    below = max(number for number in _ROUND if number <= low)
    return below, min(number for number in _ROUND if number >= high and number > below)


def _round_numbers(low: float, high: float) -> tuple[float, ...]:
    """1, 2, 5, 10 … from `low` to `high`."""
    return tuple(number for number in _ROUND if low <= number <= high)


def linear_light(colours: np.ndarray) -> np.ndarray:
    """sRGB values (…, 3) in 0…1 as linear light (IEC 61966-2-1)."""
    colours = np.asarray(colours, float)
    return np.where(colours <= 0.04045, colours / 12.92, ((colours + 0.055) / 1.055) ** 2.4)


def _sequential(places: np.ndarray) -> np.ndarray:
    return np.clip(np.vander(places, _VIRIDIS.shape[1], increasing=True) @ _VIRIDIS.T, 0.0, 1.0)


def _diverging(places: np.ndarray) -> np.ndarray:
    side = (2.0 * places - 1.0)[:, None]
    lab = _MIDDLE + np.where(side < 0.0, -side * (_RED_END - _MIDDLE), side * (_BLUE_END - _MIDDLE))
    light = np.clip((lab @ _OKLAB_TO_ROOTS.T) ** 3 @ _CUBES_TO_LINEAR.T, 0.0, 1.0)
    return np.where(light <= 0.0031308, 12.92 * light, 1.055 * light ** (1.0 / 2.4) - 0.055)
