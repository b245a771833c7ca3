"""The key table and the file that changes it."""

import pytest

from blackhole_gl.app import file_commands, recorder
from blackhole_gl.app.commands import COMMANDS
from blackhole_gl.app.keys import ACTIONS, Chord, KeysError, default_bindings, load_bindings, parse_chord, template


def test_no_file_gives_the_defaults(tmp_path):
    assert load_bindings(tmp_path / "keys.toml") == default_bindings()


def test_template_says_the_defaults(tmp_path):
    file = tmp_path / "keys.toml"
    file.write_text(template(), encoding="utf-8")
    assert load_bindings(file) == default_bindings()


def test_named_actions_change_and_others_stay(tmp_path):
    file = tmp_path / "keys.toml"
    file.write_text('disk = "ctrl+shift+d"\nspin = []\nzoom_in = ["PLUS", "HOME"]\n')
    bindings = load_bindings(file)
    assert bindings["disk"] == (Chord("D", ("CTRL", "SHIFT")),)
    assert bindings["spin"] == ()
    assert bindings["zoom_in"] == (Chord("PLUS"), Chord("HOME"))
    assert bindings["pause"] == default_bindings()["pause"]


@pytest.mark.parametrize("encoding", ["utf-8-sig", "utf-16"])
def test_the_file_is_read_as_other_editors_write_it(tmp_path, encoding):
    file = tmp_path / "keys.toml"
    file.write_bytes('disk = "Ö"\r\n'.encode(encoding))
    assert load_bindings(file)["disk"] == (Chord("ö"),)


@pytest.mark.parametrize(
    "text, words",
    [
        ('dsik = "A"', ("dsik", "did you mean disk")),
        ('disk = "SPACEBAR"', ("disk", "SPACEBAR", "did you mean SPACE")),
        ('disk = "HYPER+A"', ("disk", "HYPER", "CTRL")),
        ("disk = 3", ("disk", "got 3")),
        ('disk = "P"', ("pause", "P already belongs to disk")),
        ('disk = "ESC"', ("disk", "ESC")),
        ("disk = ", ("cannot be read",)),
    ],
)
def test_mistakes_name_file_and_entry(tmp_path, text, words):
    file = tmp_path / "keys.toml"
    file.write_text(text)
    with pytest.raises(KeysError) as error:
        load_bindings(file)
    for word in (str(file), *words):
        assert word in str(error.value)


@pytest.mark.parametrize("text, chord", [("+", Chord("PLUS")), ("ctrl++", Chord("PLUS", ("CTRL",))), ("#", Chord("#")), ("Ö", Chord("ö")), ("s", Chord("S"))])
def test_any_character_can_be_bound(text, chord):
    assert parse_chord(text) == chord == parse_chord(str(chord))
    assert len(chord.character) == 1


@pytest.mark.parametrize("text", ["CTRL+", "++S", "ß#"])
def test_what_is_no_chord_is_refused(text):
    with pytest.raises(KeysError):
        parse_chord(text)


def test_every_action_does_something():
    elsewhere = {*file_commands.NAMES, *recorder.NAMES, "quit"}  # they need the clipboard, files or the runner
    assert {action.name for action in ACTIONS if not action.held} == set(COMMANDS) | elsewhere


def test_chords_read_back():
    for chords in default_bindings().values():
        for chord in chords:
            assert parse_chord(str(chord)) == chord


def test_keys_of_free_flight_may_be_others_keys_too_but_not_one_another_s(tmp_path):
    file = tmp_path / "keys.toml"
    file.write_text('fly_up = "R"\n')
    assert load_bindings(file)["fly_up"] == default_bindings()["reset"]
    file.write_text('fly_up = "W"\n')
    with pytest.raises(KeysError, match="fly_up: W already belongs to fly_forward"):
        load_bindings(file)
