"""What is drawn is bounded by what is in view, however many keys and layers there are."""

from dataclasses import replace

import pytest
from crowded import KINDS, crowded
from imgui_bundle import imgui
from projects import project_of
from scenes import PICTURE, drawn

from app.editor.actions import saving
from app.editor.timeline_view import Strip

MANY = 10_000
CORNERS = 12_000  # more than those of the rest of the window, at most
ROWS = 20  # of the list of layers that are in view, at most


def show(window, document, strip=None):
    """Show a document, of whose in-betweens nothing is made."""
    project = project_of(document, PICTURE, "crowded")
    project.timing.unfolded = frozenset({0})
    project.timing.strip = strip
    saving.put_project(window.session, project)
    window.frames(2)
    return imgui.get_draw_data().total_vtx_count


@pytest.mark.parametrize("kind", KINDS)
def test_timeline_draws_no_more_for_more_keys(window, kind):
    with window.session.jobs.held():
        few = show(window, crowded(kind, 1))
        some = show(window, crowded(kind, MANY // 4))
        many = show(window, crowded(kind, MANY))
        close = Strip(start=-50.0, scale=2.0)
        beyond = show(window, crowded(kind, MANY), strip=replace(close, start=-1000.0))
        saving.put_project(window.session, None)
    assert max(some, many) - few < CORNERS
    assert beyond - few < CORNERS // 2


def test_list_of_layers_draws_the_rows_in_view_alone(window, monkeypatch):
    (figure,) = drawn().figures
    figures = tuple(replace(figure, id=number, name=f"layer {number}") for number in range(60))
    asked, select = [], imgui.selectable

    def selectable(name, *rest):
        asked.append(name)
        return select(name, *rest)

    with window.session.jobs.held():
        show(window, replace(drawn(), figures=figures))
        window.show_tab("Layers")
        monkeypatch.setattr(imgui, "selectable", selectable)
        window.frames(1)
        saving.put_project(window.session, None)
    rows = [name for name in asked if "row" in name]
    assert 1 < len(rows) < ROWS
