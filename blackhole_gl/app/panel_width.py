"""How wide the panel is: as wide as its labels need, whatever the screen's scale and the text's size, until a hand draws its edge elsewhere.

imgui keeps a docked window's width in pixels. A window on a screen of twice the pixels may get its size frames after its first layout, and the panel
would stay as wide as on the small one, with text of twice the size.
"""

from __future__ import annotations

from imgui_bundle import hello_imgui, imgui

from .kept import LEAST_PANEL_EM, MOST_PANEL_EM

_LARGEST_SHARE = 0.6  # of the window's width: some of it is the picture's
_ROUNDING = 1.5  # pixels that the docking may make of a width


class PanelWidth:
    """Keeps the width of a docked window.

    Attributes:
        ems: the width wanted, in units of the font's size.
    """

    def __init__(self, ems: float):
        self.ems = ems
        self._seen: tuple[float, float] | None = None

    def keep(self) -> None:
        """Gives the current window its width, or takes in that its edge is being drawn. Call once in each frame that shows it."""
        node = imgui.internal.get_current_window().dock_node
        if node is None:
            return
        em, across = hello_imgui.em_size(), imgui.get_io().display_size.x
        wanted = min(self.ems * em, _LARGEST_SHARE * across)
        is_as_before, self._seen = self._seen == (em, across), (em, across)
        if abs(node.size.x - wanted) < _ROUNDING:
            return
        if is_as_before and imgui.is_mouse_down(imgui.MouseButton_.left):
            self.ems = min(max(node.size.x / em, LEAST_PANEL_EM), MOST_PANEL_EM)
        else:
            imgui.internal.dock_builder_set_node_size(node.id_, (wanted, node.size.y))
