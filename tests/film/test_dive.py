"""The dive of the examples goes evenly, into the horizon and through it."""

from __future__ import annotations

import numpy as np
import pytest

from blackhole_gl.rendering.frame import Renderer
from studies import dive

SIZE = (160, 90)
FINE = (320, 180)  # in pixels twice as large the belt of light near the end, thinner than one, flickers


def test_every_moment_of_the_dive_has_light(renderer: Renderer) -> None:
    flown = dive.dive()
    assert flown.at(0.0).scene.camera.distance == pytest.approx(30.0) and flown.at(flown.seconds).scene.camera.distance < 0.11
    for share in (0.0, 0.5, 0.85, 0.9, 0.95, 1.0):
        seen = dive.at(renderer, flown, share * flown.seconds, SIZE)
        assert seen.finite and seen.mean > 3.0 and seen.unresolved == 0.0, f"at r = {seen.distance:.3g} r_s"


@pytest.mark.slow
def test_no_two_frames_of_the_dive_jump(renderer: Renderer) -> None:
    """Of 600 frames, the last 150: from 2.7 r_s on, where the exposure once jumped by 0.8 of mean ꟻLIP. (All of them: ``python -m studies.dive``.)"""
    flown = dive.dive()
    seconds = dive.moments(flown, 600)[450:]
    frames = [dive.at(renderer, flown, float(moment), FINE) for moment in seconds]
    assert all(seen.finite and seen.mean > 3.0 and seen.unresolved == 0.0 for seen in frames)
    differences = np.array([dive.difference(one, other) for one, other in zip(frames, frames[1:])])
    odd = np.flatnonzero((dive.standing_out(differences) > dive.STANDS_OUT) & (differences > dive.LEAST))
    pairs = [dive.halved(lambda moment: dive.at(renderer, flown, moment, FINE), float(seconds[k]), float(seconds[k + 1]), 4) for k in odd]
    assert not [pair for pair in pairs if pair.is_jump]


def test_a_jump_is_told_from_what_only_moves_fast() -> None:
    def frame(at: float) -> dive.Seen:
        picture = np.zeros((40, 60, 3), np.uint8)
        picture[:, round(40 * at) : round(40 * at) + 8] = 200
        return dive.Seen(picture + np.uint8(50 * (at > 0.6)), 1.0, True, 0.0)

    assert not dive.halved(frame, 0.1, 0.5, 3).is_jump
    assert dive.halved(frame, 0.59, 0.61, 3).is_jump
