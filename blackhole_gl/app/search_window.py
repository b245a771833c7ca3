"""The search over all settings and commands: a field to type in, and what fits below it. Up and down choose, Enter picks, ESC leaves.

Items: ``//Search/##wanted``; a row is named by its kind and key, ``###setting disk.outer_radius``.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence

from imgui_bundle import hello_imgui, imgui

from ..scene import Scene, presets
from ..scene.schema import Field
from . import preset_switch, search, sought, theme, tool_window, widgets, window_settings
from .keys import ACTIONS, Bindings, shown
from .state import WindowState

_WIDTH_EM, _ROWS = 36.0, 12
_FLAGS = imgui.WindowFlags_


class SearchWindow:
    """What is typed and chosen in it."""

    def __init__(self) -> None:
        self._text = ""
        self._chosen = 0
        self._entries: Sequence[search.Entry] | None = None  # None while the window is closed
        self._has_keys = False

    def expects_keys(self, state: WindowState) -> bool:
        """Whether it is opening, and keys are meant for its field, which takes them some frames later: where those are long, words are typed meanwhile."""
        return state.show_search and not self._has_keys

    def draw(self, state: WindowState, make: Callable[[], Sequence[search.Entry]]) -> None:
        """Draws the window when it is wanted. `make`: makes what can be found, once each time it opens."""
        if not state.show_search:
            self._entries, self._has_keys = None, False
            return
        opens = self._entries is None
        if self._entries is None:
            self._text, self._chosen, self._entries = "", 0, make()
        em, viewport = hello_imgui.em_size(), imgui.get_main_viewport()
        width = min(_WIDTH_EM * em, 0.95 * viewport.size.x)
        imgui.set_next_window_pos((viewport.get_center().x, viewport.pos.y + 4.0 * em), imgui.Cond_.always.value, (0.5, 0.0))
        imgui.set_next_window_size((width, 0.0))
        if opens:
            imgui.set_next_window_focus()
        entries = self._entries
        state.show_search = tool_window.draw("Search", lambda: self._contents(entries, width, opens), _FLAGS.no_resize, _FLAGS.no_move, _FLAGS.no_nav)

    def _contents(self, entries: Sequence[search.Entry], width: float, opens: bool) -> bool:
        """Draws the field and the rows; whether the window stays."""
        if opens:
            imgui.set_keyboard_focus_here()
        imgui.set_next_item_width(-1.0)
        entered, text = imgui.input_text_with_hint("##wanted", "A setting, preset, view or command", self._text, imgui.InputTextFlags_.enter_returns_true.value)
        self._has_keys |= imgui.is_item_active()
        if text != self._text:
            self._text, self._chosen = text, 0
        fit = search.found(entries, self._text)
        moved = imgui.is_key_pressed(imgui.Key.down_arrow) - imgui.is_key_pressed(imgui.Key.up_arrow)
        self._chosen = min(max(self._chosen + moved, 0), max(len(fit) - 1, 0))
        picked = fit[self._chosen] if entered and fit else None
        imgui.begin_child("##found", (0.0, (_ROWS + 0.5) * imgui.get_text_line_height_with_spacing()))
        for index, entry in enumerate(fit):
            if self._row(entry, index == self._chosen, scroll=bool(moved) or opens):
                picked = entry
        if not fit:
            imgui.text_colored(theme.DIM, "Nothing has all of these words.")
        imgui.end_child()
        self._about(fit)
        if picked is not None:
            picked.pick()
        return picked is None and not imgui.is_key_pressed(imgui.Key.escape, False)

    def _row(self, entry: search.Entry, chosen: bool, *, scroll: bool) -> bool:
        clicked, _ = imgui.selectable(f"{entry.title}###{entry.kind} {entry.key}", chosen)
        if chosen and scroll:
            imgui.set_scroll_here_y(0.5)
        right = f"{entry.key}   {entry.kind}"
        imgui.same_line(imgui.get_content_region_avail().x - imgui.calc_text_size(right).x)
        imgui.text_colored(theme.DIM, right)
        return clicked

    def _about(self, fit: Sequence[search.Entry]) -> None:
        """What the chosen one is for, in two rows whatever its length, so that nothing moves."""
        imgui.separator()
        height = 2.2 * imgui.get_text_line_height_with_spacing()
        imgui.begin_child("##about", (0.0, height))
        imgui.push_style_color(imgui.Col_.text, theme.DIM)
        imgui.text_wrapped(fit[self._chosen].help if fit else "")
        imgui.pop_style_color()
        imgui.end_child()


def entries(state: WindowState, shown_fields: Sequence[Field], bindings: Bindings, do: Callable[[str], None]) -> Sequence[search.Entry]:
    """Everything that can be found now: `shown_fields` are those that the panel has rows for; `do` does what the key of an action does."""
    return [
        *(_setting(item, state) for item in shown_fields),
        *(_window_setting(name, state) for name in window_settings.SETTINGS),
        *(_command(name, help_text, shown(bindings[name]), do) for name, help_text in _commands()),
        *(search.Entry(info.title, "preset", info.name, info.description, _preset(state, info.group, info.name)) for info in presets.available()),
        *(_view(option, state) for option in _options(state.scene)),
    ]


def _setting(item: Field, state: WindowState) -> search.Entry:
    return search.Entry(widgets.label_of(item.key), "setting", item.key, item.help, lambda: sought.seek(state, item.key))


def _window_setting(name: str, state: WindowState) -> search.Entry:
    label, help_text = window_settings.SETTINGS[name]
    key = f"{window_settings.SECTION}.{name}"
    return search.Entry(label, "setting", key, help_text, lambda: sought.seek(state, key))


def _commands() -> Sequence[tuple[str, str]]:
    """Name and words of every action that is done at once; a key held has nothing to pick."""
    return [(action.name, action.help) for action in ACTIONS if not action.held and action.name not in ("search", "help")] + [("help", "All keys")]


def _command(name: str, words: str, keys: str, do: Callable[[str], None]) -> search.Entry:
    return search.Entry(words, "command", keys or name, words, lambda: do(name))


def _preset(state: WindowState, group: str, name: str) -> Callable[[], None]:
    return lambda: preset_switch.pick(state, group, name)


def _options(scene: Scene) -> Sequence[str]:
    return scene.fields()["post.view"].options


def _view(option: str, state: WindowState) -> search.Entry:
    title, words = option.replace("_", " ").capitalize(), "What is shown: the picture, or a figure of its rays in false colours."
    return search.Entry(title, "view", option, words, lambda: state.change({"post.view": option}))
