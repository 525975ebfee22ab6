"""No button cuts its text off, on small screens either."""

import pytest
from imgui_bundle import imgui

from app.editor.actions import editing

TABS = ("Handle", "Layers", "Animate", "Shape", "Export", "Measure")


@pytest.fixture
def cut_off(monkeypatch):
    """Texts of buttons that were drawn narrower than their text."""
    found = set()
    button = imgui.button

    def measured(label, *size):
        text = label.split("##")[0]
        pressed = button(label, *size)
        if imgui.is_item_visible() and imgui.calc_text_size(text).x > imgui.get_item_rect_size().x:
            found.add(text)
        return pressed

    monkeypatch.setattr(imgui, "button", measured)
    return found


@pytest.mark.usefixtures("loose")
@pytest.mark.parametrize(
    ("size", "scale"), [((1280, 800), 1.0), ((1024, 700), 1.0), ((1600, 1000), 2.0)]
)
def test_buttons_of_all_tabs_show_their_whole_text(window, cut_off, size, scale):
    window.resize(size, scale)
    for handles in (frozenset(), frozenset({0}), frozenset({0, 1})):
        editing.select_handles(window.session, handles)
        for tab in TABS:
            window.show_tab(tab)
            window.settle()
            # What was drawn while the panel took its size does not count.
            cut_off.clear()
            window.frames(2)
            assert not cut_off, (tab, len(handles))
    window.resize((1280, 800))
