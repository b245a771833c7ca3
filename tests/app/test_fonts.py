"""Which fonts are taken for letters that the window's own lacks."""

from pathlib import Path

import matplotlib

from blackhole_gl.app import fonts

DEJAVU = Path(matplotlib.get_data_path(), "fonts", "ttf", "DejaVuSans.ttf")


def test_the_users_come_first_and_what_is_no_font_is_left_out(tmp_path, monkeypatch):
    monkeypatch.setenv("BLACKHOLE_GL_CONFIG_DIR", str(tmp_path))
    monkeypatch.setattr(fonts, "_of_system", lambda: [Path("/of/the/system.ttf"), DEJAVU])
    assert fonts.others() == [DEJAVU]
    own = tmp_path / "fonts"
    own.mkdir()
    for name, data in {"b.ttf": DEJAVU.read_bytes(), "a.otf": b"OTTO" + bytes(100), "broken.ttf": b"none", "short.ttc": b"", "notes.txt": b"OTTO"}.items():
        (own / name).write_bytes(data)
    assert fonts.others() == [own / "a.otf", own / "b.ttf", DEJAVU]
