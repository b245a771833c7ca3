"""What a search finds, and in which order."""

from blackhole_gl.app.search import Entry, found

ENTRIES = [
    Entry("Inner radius", "setting", "disk.inner_radius", "Where the disk begins.", lambda: None),
    Entry("Outer radius", "setting", "disk.outer_radius", "Where the disk ends.", lambda: None),
    Entry("Exposure", "setting", "post.exposure", "Brightness of the picture, in stops.", lambda: None),
    Entry("Full screen", "command", "F11", "Full screen", lambda: None),
    Entry("Radius of rings", "view", "rings", "", lambda: None),
]


def titles(text: str) -> list[str]:
    return [entry.title for entry in found(ENTRIES, text)]


def test_nothing_typed_lists_all():
    assert titles("  ") == [entry.title for entry in ENTRIES]


def test_by_label_key_and_help():
    assert titles("outer") == ["Outer radius"]
    assert titles("post.exp") == ["Exposure"]
    assert titles("brightness") == ["Exposure"]
    assert titles("f11") == ["Full screen"]


def test_every_word_counts_and_their_order_does_not():
    assert titles("radius outer") == ["Outer radius"]
    assert titles("outer exposure") == []


def test_what_begins_with_the_word_comes_first():
    assert titles("radius") == ["Radius of rings", "Inner radius", "Outer radius"]
    assert titles("disk") == ["Inner radius", "Outer radius"]
