"""How a window's exposure follows its light meter."""

import pytest

from blackhole_gl.app import adaptation


@pytest.fixture
def clock(monkeypatch):
    now = [100.0]
    monkeypatch.setattr(adaptation.clock, "perf_counter", lambda: now[0])
    return now


def test_the_first_picture_is_exposed_at_once(clock):
    assert adaptation.Adaptation()(-2.5) == -2.5


def test_exposure_glides_and_arrives(clock):
    follow, shown = adaptation.Adaptation(), []
    follow(0.0)
    for _ in range(60):
        clock[0] += 1.0 / 30.0
        shown.append(follow(2.0))
    assert 0.1 < shown[0] < 0.5, "no jump"
    assert shown == sorted(shown) and shown[-1] == 2.0
    assert shown.index(2.0) < 50, "within 1.7 s"


def test_a_picture_that_rested_does_not_jump(clock):
    follow = adaptation.Adaptation()
    follow(0.0)
    clock[0] += 3600.0
    assert 0.0 < follow(2.0) < 1.0


def test_what_is_to_be_exact_is_there_at_once(clock):
    follow = adaptation.Adaptation()
    follow(0.0)
    follow.forget()
    assert follow(2.0) == 2.0
