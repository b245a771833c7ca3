"""The window of the timeline: opens, plays and scrubs a flight, takes keys from the view, saves them."""

from __future__ import annotations

from dataclasses import replace

from imgui_bundle import hello_imgui, imgui

from . import shipped_flights, text_fields, theme, timeline, tool_window
from .state import WindowState

TITLE = "Flight"
_WIDTH_EM = 42.0


def draw(state: WindowState) -> None:
    """The window, when it is wanted; its close button puts it away and stops the flight."""
    if not state.show_timeline:
        return
    em, view = hello_imgui.em_size(), imgui.get_main_viewport()
    imgui.set_next_window_pos((view.pos.x + 2.0 * em, view.pos.y + view.size.y - 16.0 * em), imgui.Cond_.first_use_ever.value)
    imgui.set_next_window_size((_WIDTH_EM * em, 0.0), imgui.Cond_.first_use_ever.value)
    state.show_timeline = tool_window.draw(TITLE, lambda: _contents(state))
    if not state.show_timeline:
        state.timeline = replace(state.timeline, plays=False)


def _contents(state: WindowState) -> None:
    _shipped(state)
    _file(state)
    now = state.timeline
    imgui.begin_disabled(now.flight is None)
    if imgui.button("Pause###flight play" if now.plays else "Play###flight play"):
        timeline.play(state)
    imgui.same_line()
    _, loops = imgui.checkbox("again and again##flight", state.timeline.loops)
    state.timeline = replace(state.timeline, loops=loops)
    imgui.end_disabled()
    imgui.same_line()
    explained, explains = imgui.checkbox("explained##flight", state.timeline.explains)
    imgui.set_item_tooltip("Names what is seen, and tells of it: for a second run.")
    if explained:
        timeline.explain(state, explains)
    _keys(state)
    imgui.set_next_item_width(-1.0)
    length = max(state.timeline.length, _free_length(state))
    moved, seconds = imgui.slider_float("##flight seconds", state.timeline.seconds, 0.0, length, "%.2f s")
    if moved:
        state.timeline = replace(state.timeline, plays=False, seconds=min(max(seconds, 0.0), length))
        if state.timeline.flight is not None and seconds <= state.timeline.length:
            timeline.seek(state, seconds)
    told = timeline.reading(now.moment) or _count(state)
    imgui.text_colored(theme.QUIET, told)


def _shipped(state: WindowState) -> None:
    """The shipped flights, each a click away."""
    for number, (name, title) in enumerate(shipped_flights.titles().items()):
        if number:
            imgui.same_line()
        if imgui.button(f"{title}###flight {name}"):
            shipped_flights.fly(state, name)


def _file(state: WindowState) -> None:
    imgui.set_next_item_width(-9.0 * hello_imgui.em_size())
    path = text_fields.edited("##flight file", state.timeline.file, "a flight, a TOML file")
    if path is not None:
        state.timeline = replace(state.timeline, file=path)
    imgui.same_line()
    if imgui.button("Open###flight open"):
        timeline.open_file(state, state.timeline.file)
    imgui.same_line()
    if imgui.button("Save###flight save"):
        timeline.save(state, state.timeline.file)


def _keys(state: WindowState) -> None:
    imgui.same_line()
    if imgui.button("Take a key###flight key"):
        timeline.take_key(state)
    imgui.set_item_tooltip("The view of now, where the slider stands. Move the slider on, fly elsewhere, take the next.")
    imgui.same_line()
    if imgui.button("Start anew###flight clear"):
        state.timeline = timeline.Timeline(file=state.timeline.file)


def _free_length(state: WindowState) -> float:
    """What the slider has beyond the last key, for the next one."""
    flown = state.timeline.flight
    return state.timeline.length + 10.0 if flown is None or flown.way is None else 0.0


def _count(state: WindowState) -> str:
    flown = state.timeline.flight
    if flown is None:
        return "No flight yet: open one, or take a key from the view."
    return f"{len(flown.keys)} keys, {flown.seconds:.4g} s"
