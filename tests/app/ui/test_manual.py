"""F1 opens the manual where it tells of what is in front."""

import webbrowser

import pytest

from app.editor.actions import dialog_actions
from app.editor.actions.layer_setup import cut_out_editing
from app.storage import manual_page


class Browser:
    """One that notes what it was asked to open."""

    def __init__(self):
        self.opened = []

    def open(self, url):
        self.opened.append(url)
        return True


@pytest.fixture
def browser(monkeypatch):
    opened = Browser()
    monkeypatch.setattr(webbrowser, "get", lambda: opened)
    return opened


def press(window):
    window.run(lambda robot: robot.key_press(int(window.Key.f1)))


def test_without_a_drawing_it_opens_the_first_page_and_tells_where_it_lies(window, browser):
    press(window)
    assert browser.opened == [manual_page().as_uri()]
    assert str(manual_page()) in window.session.notices.toasts[-1].text


def test_it_opens_the_page_of_the_tool_in_hand_or_else_of_the_tab(window, bar, browser):
    del bar
    window.show_tab("Layers")
    press(window)
    window.act(cut_out_editing.toggle_cut_tool, "keep")
    press(window)
    assert [url.rpartition("/")[2] for url in browser.opened] == ["layers.html", "cut-out.html"]


@pytest.mark.parametrize("kind", ["none", "of the terminal"])
def test_without_a_browser_it_tells_where_the_page_lies(window, monkeypatch, kind):
    def get():
        if kind == "none":
            raise webbrowser.Error
        return webbrowser.GenericBrowser("lynx")

    monkeypatch.delenv("BROWSER", raising=False)
    monkeypatch.setattr(webbrowser, "get", get)
    window.act(dialog_actions.open_manual, "layers")
    (toast,) = window.session.notices.toasts
    assert "No browser was found" in toast.text
    assert str(manual_page("layers")) in toast.text
