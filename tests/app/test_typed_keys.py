"""Which key gave which character, and what it means for shortcuts."""

from blackhole_gl.app.typed_keys import Press, Typing

A, S, EQUAL, BRACKET, ADD = range(5)
PRINTED = {A: "a", S: "s", EQUAL: "=", BRACKET: "]"}


class Keyboard:
    """A keyboard and the frames that pass over it."""

    def __init__(self):
        self.typing, self.down = Typing(PRINTED, keypad=(ADD,)), set()

    def frame(self, characters: str = "", new: tuple[int, ...] = ()) -> list[Press]:
        self.down.update(new)
        return self.typing.take(characters, new, self.down.__contains__)


def test_the_key_of_a_sign_is_the_one_that_gave_it():
    assert Keyboard().frame("+", (BRACKET,)) == [Press("+", BRACKET)]


def test_a_held_key_repeats_itself_without_another_press():
    keyboard = Keyboard()
    keyboard.frame("s", (S,))
    assert keyboard.frame("s") == keyboard.frame("ss") == []
    keyboard.down.clear()
    assert keyboard.frame("s", (S,)) == [Press("s", S)]


def test_a_character_may_come_some_frames_after_its_key():
    keyboard = Keyboard()
    assert keyboard.frame(new=(BRACKET,)) == []
    assert keyboard.frame("+") == [Press("+", BRACKET)]


def test_a_key_that_gave_nothing_takes_no_later_character():
    keyboard = Keyboard()
    for _ in range(4):
        keyboard.frame(new=(A,) if not keyboard.down else ())
    assert keyboard.frame("é") == [Press("é", None)]


def test_two_keys_of_one_frame_each_have_their_own_character():
    assert Keyboard().frame("sa", (A, S)) == [Press("s", S), Press("a", A)]


def test_the_keypad_has_names_of_its_own():
    assert Keyboard().frame("+", (ADD,)) == []


def test_capitals_are_the_same_letter_and_other_scripts_stand_for_the_place():
    assert Keyboard().frame("S", (S,)) == [Press("s", S)]
    assert Keyboard().frame("ы", (S,)) == [Press("s", S)]  # a Russian keyboard
    assert Keyboard().frame("ö", (S,)) == [Press("ö", S)]
