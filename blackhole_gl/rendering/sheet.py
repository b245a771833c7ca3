"""A sheet that labels and colour scales are drawn on, to be laid over a picture."""

from __future__ import annotations

import numpy as np
from PIL import Image, ImageDraw, ImageFont

from ..output.streams import spelled
from .labels import Labels
from .views import Colour, Scale, View, tick_text

_FINER = 3  # the drawing is made larger by this and averaged, which smooths its lines
_ROWS = 32  # of the picture that it is laid over at a time: a pixel's share of the sheet takes 700 bytes meanwhile
_LEAST_TEXT = 11.0  # pixels
_TEXT_SHARE = 1.0 / 42.0  # of the picture's height
_TEXT: Colour = (0.86, 0.87, 0.90)
_BACKDROP = (12, 12, 13, 165)
_PIECES = 128
_LACKED = "\ue123"  # of no script: what a font draws for a letter that it lacks


class Sheet:
    """A transparent sheet, in pixels of the picture that it is laid over."""

    def __init__(self, width: int, height: int):
        self._size = width, height
        self._sheet = Image.new("RGBA", (_FINER * width, _FINER * height))
        self._pen = ImageDraw.Draw(self._sheet)
        self._em = max(_LEAST_TEXT, _TEXT_SHARE * height)
        self._font = ImageFont.load_default(_FINER * self._em)

    def over(self, pixels: np.ndarray) -> np.ndarray:
        """`pixels` with the sheet laid over them."""
        found = pixels.copy()
        for top in range(0, len(pixels), _ROWS):
            rows = found[top : top + _ROWS]
            drawn = self._sheet.crop((0, _FINER * top, _FINER * self._size[0], _FINER * (top + len(rows))))
            if drawn.getbbox() is not None:
                rows[:] = _laid_over(rows, np.asarray(drawn, float))
        return found

    def labels(self, shown: Labels) -> None:
        """Curves first, then names on their backdrops."""
        scale = float(self._size[1])
        for curve in shown.curves:
            for piece in pieces(scale * curve.places):
                self._line([(x, y) for x, y in piece.tolist()], curve.colour, 0.09 * curve.width)
        for name in shown.names:
            at, place = (scale * name.at[0], scale * name.at[1]), (scale * name.place[0], scale * name.place[1])
            self._line([at, place], name.colour, 0.06)
            self._boxed(name.text, place, name.colour, "rm" if name.is_on_the_left else "lm")
        if shown.note:
            self._boxed(shown.note, (0.5 * self._size[0], (1.5 + 1.8 * shown.note_line) * self._em), _TEXT, "mm")

    def legend(self, view: View) -> None:
        """At the bottom right; nothing in pictures that have no room for it."""
        em, pad = self._em, 0.7 * self._em
        lines = [view.title, *(meaning for meaning, _ in view.legend)]
        width = max([20.0 * em if view.scale else 0.0, self._wide(view.title), *(1.4 * em + self._wide(line) for line in lines[1:])])
        height = 1.3 * em * len(lines) + (2.4 * em if view.scale else 0.0)
        left, top = self._size[0] - width - 2.0 * pad, self._size[1] - height - 2.0 * pad
        if left < 0.0 or top < 0.0:
            return
        self._box(left - 0.5 * pad, top - 0.5 * pad, self._size[0] - 0.5 * pad, self._size[1] - 0.5 * pad, _BACKDROP)
        left, top = left + 0.25 * pad, top + 0.25 * pad
        self._text(view.title, (left, top), _TEXT, "la")
        top += 1.4 * em
        if view.scale is not None:
            self._bar(view.scale, left, top, width)
            top += 2.4 * em
        for meaning, colour in view.legend:
            self._box(left, top + 0.1 * em, left + 0.9 * em, top + em, (*_bytes(colour), 255), outline=True)
            self._text(meaning, (left + 1.4 * em, top), _TEXT, "la")
            top += 1.3 * em

    def _bar(self, scale: Scale, left: float, top: float, width: float) -> None:
        em = self._em
        for k, colour in enumerate(scale.colours(_PIECES)):
            self._box(left + width * k / _PIECES, top, left + width * (k + 1) / _PIECES, top + 0.8 * em, (*_bytes(colour), 255))
        free = left - 1.0
        for index, tick in enumerate(scale.ticks):
            x, text = left + width * scale.place(tick), tick_text(scale, index)
            start = min(max(x - 0.5 * self._wide(text), left), left + width - self._wide(text))
            self._line([(x, top + 0.8 * em), (x, top + 1.05 * em)], _TEXT, 0.07)
            if start > free:
                self._text(text, (start, top + 1.1 * em), _TEXT, "la")
                free = start + self._wide(text) + 0.4 * em

    def _boxed(self, text: str, place: tuple[float, float], colour: Colour, anchor: str) -> None:
        """`text` on a backdrop, moved as little as brings it into the picture."""
        text = self._written(text)
        half, wide = 0.75 * self._em, self._wide(text) + 0.6 * self._em
        left = place[0] - {"l": 0.0, "m": 0.5, "r": 1.0}[anchor[0]] * wide
        left = min(max(left, 2.0), max(self._size[0] - wide - 2.0, 2.0))
        y = min(max(place[1], half + 2.0), self._size[1] - half - 2.0)
        self._box(left, y - half, left + wide, y + half, _BACKDROP)
        self._text(text, (left + 0.3 * self._em, y), colour, "lm")

    def _written(self, text: str) -> str:
        """`text` with the letters that the font lacks spelled out."""
        missing = self._drawn(_LACKED)
        return "".join(letter if self._drawn(letter) != missing else spelled(letter) for letter in text)

    def _drawn(self, letter: str) -> bytes:
        return bytes(self._font.getmask(letter))  # type: ignore  # a sequence of pixels, which Pillow's own types do not say

    def _wide(self, text: str) -> float:
        return self._font.getlength(text) / _FINER

    def _text(self, text: str, place: tuple[float, float], colour: Colour, anchor: str) -> None:
        self._pen.text((_FINER * place[0], _FINER * place[1]), text, (*_bytes(colour), 255), self._font, anchor)

    def _line(self, places: list[tuple[float, float]], colour: Colour, width_em: float) -> None:
        self._pen.line([(_FINER * x, _FINER * y) for x, y in places], (*_bytes(colour), 225), max(round(_FINER * width_em * self._em), 2), "curve")

    def _box(self, left: float, top: float, right: float, bottom: float, colour: tuple[int, ...], *, outline: bool = False) -> None:
        corners = tuple(_FINER * value for value in (left, top, right, bottom))
        self._pen.rectangle(corners, colour, (*_bytes(_TEXT), 255) if outline else None, 2)


def _laid_over(pixels: np.ndarray, sheet: np.ndarray) -> np.ndarray:
    """Rows of a picture with those of the `sheet` laid over them."""
    # Colours with their opacity, or what is beside a line would darken it.
    share = sheet[..., 3:] / 255.0
    height, width = pixels.shape[:2]
    blocks = np.concatenate([sheet[..., :3] * share, share], axis=-1).reshape(height, _FINER, width, _FINER, 4).mean(axis=(1, 3))
    return np.round(pixels * (1.0 - blocks[..., 3:]) + blocks[..., :3]).astype(np.uint8)


def pieces(places: np.ndarray) -> list[np.ndarray]:
    """The runs of places (N, 2) that are before the camera, of two and more."""
    there = np.isfinite(places[:, 0])
    cuts = np.flatnonzero(np.diff(there)) + 1
    return [run for run in np.split(places, cuts) if len(run) > 1 and np.isfinite(run[0, 0])]


def _bytes(colour: Colour | np.ndarray) -> tuple[int, int, int]:
    red, green, blue = (round(255.0 * float(channel)) for channel in colour)
    return red, green, blue
