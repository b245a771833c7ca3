"""A plot of curves as a picture: axes, ticks and lines, as much as a command needs to show what it wrote."""

from __future__ import annotations

import math
from collections.abc import Mapping

import numpy as np
from PIL import Image, ImageDraw, ImageFont

_FINER = 2  # drawn so much larger and averaged, which smooths lines
_PAPER, _INK, _GRID = (255, 255, 255), (40, 40, 46), (222, 222, 226)
_COLOURS = ((214, 110, 30), (50, 105, 200), (60, 150, 80), (150, 80, 160))
_LEFT, _RIGHT, _TOP, _BOTTOM = 0.09, 0.02, 0.08, 0.12  # margins, of the width and of the height


def plotted(x: np.ndarray, lines: Mapping[str, np.ndarray], names: tuple[str, str], size: tuple[int, int] = (960, 480)) -> np.ndarray:
    """`lines` (name → values) over `x`, with `names` of the two axes, as uint8 (height, width, 3). The axis upwards begins at 0 where no value is below."""
    width, height = (_FINER * side for side in size)
    image = Image.new("RGB", (width, height), _PAPER)
    pen, font = ImageDraw.Draw(image), ImageFont.load_default(0.028 * height)
    values = np.concatenate([np.asarray(line, float) for line in lines.values()])
    span = float(x[0]), float(x[-1]) if x[-1] > x[0] else float(x[0]) + 1.0
    low, high = min(float(values.min()), 0.0), float(values.max())
    high = high if high > low else low + 1.0
    high += 0.05 * (high - low)

    def place(at: float, value: float) -> tuple[float, float]:
        across, up = (at - span[0]) / (span[1] - span[0]), (value - low) / (high - low)
        return width * (_LEFT + (1.0 - _LEFT - _RIGHT) * across), height * (1.0 - _BOTTOM - (1.0 - _BOTTOM - _TOP) * up)

    for at in ticks(*span):
        pen.line([place(at, low), place(at, high)], _GRID, _FINER)
        pen.text((place(at, low)[0], place(at, low)[1] + 0.01 * height), f"{at:g}", _INK, font, "ma")
    for value in ticks(low, high):
        pen.line([place(span[0], value), place(span[1], value)], _GRID, _FINER)
        pen.text((place(span[0], value)[0] - 0.01 * height, place(span[0], value)[1]), f"{value:g}", _INK, font, "rm")
    pen.rectangle([place(span[0], high), place(span[1], low)], outline=_INK, width=_FINER)
    for number, (name, line) in enumerate(lines.items()):
        colour = _COLOURS[number % len(_COLOURS)]
        pen.line([place(float(at), float(value)) for at, value in zip(x, line, strict=True)], colour, 2 * _FINER, "curve")
        pen.text((width * (_LEFT + 0.01 + 0.3 * number), 0.045 * height), name, colour, font, "lm")
    pen.text((0.5 * width, height * (1.0 - 0.015)), names[0], _INK, font, "ms")
    pen.text((width * (1.0 - _RIGHT), 0.045 * height), names[1], _INK, font, "rm")
    return np.asarray(image.resize(size, Image.Resampling.BOX))


def ticks(low: float, high: float) -> np.ndarray:
    """Round numbers from `low` to `high`, five to eleven."""
    rough = (high - low) / 5.0
    unit = 10.0 ** math.floor(math.log10(rough))
    step = next(unit * factor for factor in (5.0, 2.0, 1.0) if unit * factor <= rough)
    return step * np.arange(math.ceil(low / step - 1e-9), math.floor(high / step + 1e-9) + 1)
