"""Who compiles a scene's programs, and when: with made-up work of the other process."""

import math
from concurrent.futures import Future

import pytest

from blackhole_gl.app.preparation import FIRST_SHARE_S, FRAME_SHARE_S, Preparation

SIZE = (8, 8)


class Elsewhere:
    """The other process; its work ends when a test says so."""

    def __init__(self):
        self.futures = []

    def __call__(self, scene, size):
        self.futures.append(Future())
        return self.futures[-1]


@pytest.fixture
def elsewhere():
    return Elsewhere()


@pytest.fixture
def preparation(elsewhere):
    """After the first picture."""
    made = Preparation(elsewhere)
    made.over()
    return made


def test_the_first_picture_waits_for_nobody(elsewhere):
    first = Preparation(elsewhere)
    assert first.deadline(5.0) == 5.0 + FIRST_SHARE_S
    first.missed("scene", SIZE, 5.0)
    assert not elsewhere.futures and not first.waits(6.0)


def test_a_new_scene_is_compiled_elsewhere_first(preparation, elsewhere):
    assert preparation.deadline(1.0) == -math.inf, "the window compiles nothing in a frame of its own accord"
    preparation.missed("scene", SIZE, 1.0)
    assert preparation.since == 1.0 and len(elsewhere.futures) == 1
    assert preparation.waits(1.1) and preparation.waits(1.2)
    elsewhere.futures[0].set_result(None)
    assert not preparation.waits(1.3)
    assert preparation.deadline(1.3) == 1.3 + FRAME_SHARE_S
    preparation.missed("scene", SIZE, 1.3)
    assert len(elsewhere.futures) == 1, "what is still missing the window compiles itself"
    preparation.over()
    assert preparation.since is None and preparation.deadline(2.0) == -math.inf


def test_where_the_other_process_fails_the_window_compiles(preparation, elsewhere):
    preparation.missed("scene", SIZE, 1.0)
    elsewhere.futures[0].set_exception(RuntimeError("no context"))
    assert not preparation.waits(1.1)
    preparation.over()
    assert preparation.deadline(2.0) > 2.0
    preparation.missed("another", SIZE, 2.0)
    assert len(elsewhere.futures) == 1 and not preparation.waits(2.1)


def test_patience_ends(preparation, elsewhere):
    preparation.missed("scene", SIZE, 1.0)
    assert preparation.waits(20.0) and not preparation.waits(60.0)
    assert preparation.deadline(60.0) > 60.0


def test_a_process_that_is_gone_is_not_asked(preparation):
    def gone(scene, size):
        raise RuntimeError("ended")

    left = Preparation(gone)
    left.over()
    left.missed("scene", SIZE, 1.0)
    assert not left.waits(1.1) and left.deadline(1.1) > 1.1
