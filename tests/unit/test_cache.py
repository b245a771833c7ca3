"""What is kept from one start to the next is what was made, or made anew."""

from __future__ import annotations

import os
import threading
from pathlib import Path

import pytest

from blackhole_gl.output import cache


@pytest.fixture
def folder(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Path:
    monkeypatch.setattr(cache, "user_cache_dir", lambda: tmp_path)
    return tmp_path / "kind"


def test_what_was_kept_is_found_under_its_key_alone(folder: Path) -> None:
    assert cache.found("kind", b"key") is None
    cache.keep("kind", b"key", b"made")
    assert cache.found("kind", b"key") == b"made"
    assert cache.found("kind", b"another") is None and cache.found("other", b"key") is None


@pytest.mark.parametrize("damage", [lambda data: data[:-1], lambda data: data[:2], lambda data: b"", lambda data: data[:-1] + b"?"])
def test_what_is_damaged_is_as_if_it_were_not_there(folder: Path, damage) -> None:
    cache.keep("kind", b"key", b"made")
    (file,) = folder.iterdir()
    file.write_bytes(damage(file.read_bytes()))
    assert cache.found("kind", b"key") is None
    cache.keep("kind", b"key", b"made")
    assert cache.found("kind", b"key") == b"made"


def test_a_folder_that_cannot_be_written_keeps_nothing(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    (tmp_path / "file").touch()
    monkeypatch.setattr(cache, "user_cache_dir", lambda: tmp_path / "file")
    cache.keep("kind", b"key", b"made")
    assert cache.found("kind", b"key") is None


def test_what_was_used_last_stays(folder: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(cache, "MOST_KEPT", 3)
    for age, key in enumerate([b"d", b"c", b"b", b"a"]):
        cache.keep("kind", key, key)
        for file in folder.iterdir():
            if file.read_bytes().endswith(key):
                os.utime(file, (1000.0 + age, 1000.0 + age))
    assert cache.found("kind", b"d") is None
    assert cache.found("kind", b"c") == b"c"  # used now
    cache.keep("kind", b"e", b"e")
    assert [key for key in (b"a", b"b", b"c", b"d", b"e") if cache.found("kind", key)] == [b"a", b"c", b"e"]


def test_several_writers_leave_one_of_what_they_wrote(folder: Path) -> None:
    """Of one process: those of others write to files of their own until these are whole."""
    made = [bytes([number]) * 100_000 for number in range(4)]
    seen = []

    def write(data: bytes) -> None:
        for _ in range(20):
            cache.keep("kind", b"key", data)
            seen.append(cache.found("kind", b"key"))

    writers = [threading.Thread(target=write, args=(data,)) for data in made]
    for writer in writers:
        writer.start()
    for writer in writers:
        writer.join()
    assert set(seen) <= {None, *made} and any(seen)
    cache.keep("kind", b"key", made[0])
    assert cache.found("kind", b"key") == made[0] and len(list(folder.iterdir())) == 1
