"""What is drawn is bounded by what is in view, however many keys and layers there are."""

from dataclasses import replace

import numpy as np
import pytest
from crowded import KINDS, crowded
from imgui_bundle import imgui
from projects import project_of
from scenes import PICTURE, drawn

from app.document import layer_commands
from app.document.keyframe import Target
from app.document.layer import Handle
from app.editor.actions import editing
from app.editor.actions.project_files import saving
from app.editor.layering import layer_list
from app.editor.parts.timeline.time_range import TimeRangeView
from app.motion import layer_stages

MANY = 4_000
CORNERS = 18_000  # more than those of the rest of the window, at most: three full lanes
LAYERS = 30
ROWS = 20  # of a list that are in view, at most


def show(window, document, strip=None, *, expanded=frozenset({0})):
    """Show a document, of whose in-betweens nothing is made."""
    project = project_of(document, PICTURE, "crowded")
    project.timeline.expanded_layers = expanded
    project.timeline.time_range = strip
    saving.set_project(window.session, project)
    window.frames(2)
    return imgui.get_draw_data().total_vtx_count


@pytest.mark.parametrize("expanded", [frozenset({0}), frozenset()], ids=["lanes", "folded"])
@pytest.mark.parametrize("kind", KINDS)
def test_timeline_draws_no_more_for_more_keys(window, kind, expanded):
    document = crowded(kind, MANY)
    with window.session.jobs.held():
        few = show(window, crowded(kind, 1), expanded=expanded)
        some = show(window, crowded(kind, MANY // 4), expanded=expanded)
        many = show(window, document, expanded=expanded)
        close = TimeRangeView(start=-50.0, scale=2.0)
        beyond = show(window, document, replace(close, start=-1000.0), expanded=expanded)
        saving.set_project(window.session, None)
    assert max(some, many) - few < CORNERS
    assert beyond - few < CORNERS // 2


def many_layers():
    (layer,) = drawn().layers
    layers = tuple(replace(layer, id=number, name=f"layer {number}") for number in range(LAYERS))
    return replace(drawn(), layers=layers)


def many_handles():
    document = drawn()
    (layer,) = document.layers
    places = layer.domain.mesh.vertices[:60].tolist()
    handles = tuple(
        Handle(id=number, name=f"handle {number}", position=complex(place))
        for number, place in enumerate(places)
    )
    (key,) = layer.keys
    targets = {handle.id: Target(position=handle.position) for handle in handles}
    key = replace(key, pose=replace(key.pose, targets=targets))
    return replace(document, layers=(replace(layer, handles=handles, next_handle=60, keys=(key,)),))


@pytest.mark.parametrize(
    ("tab", "document", "row"),
    [("Layers", many_layers, "row"), ("Handle", many_handles, "###handle")],
    ids=["layers", "handles"],
)
def test_lists_draw_the_rows_in_view_alone(window, monkeypatch, tab, document, row):
    asked, select = [], imgui.selectable

    def selectable(name, *rest):
        asked.append(name)
        return select(name, *rest)

    with window.session.jobs.held():
        show(window, document())
        window.show_tab(tab)
        monkeypatch.setattr(imgui, "selectable", selectable)
        window.frames(1)
        saving.set_project(window.session, None)
    rows = [name for name in asked if row in name]
    assert 1 < len(rows) < ROWS


def test_rows_of_layers_stay_until_the_document_changes():
    project = project_of(many_layers(), PICTURE, "crowded")
    rows = project.tree
    assert project.tree is rows
    project.layer_list.toggled_rows = frozenset({"group body"})
    assert project.tree is not rows


def test_layer_under_the_pointer_is_sought_among_those_there(window, monkeypatch):
    asked = []
    monkeypatch.setattr(layer_list, "contains", lambda *_: asked.append(1) or np.array([False]))
    with window.session.jobs.held():
        show(window, many_layers())
        project = window.session.project
        assert layer_list.layer_at(project, -1000 - 1000j) is None
        assert not asked
        layer_list.layer_at(project, 60 + 47j)
        assert len(asked) == LAYERS
        saving.set_project(window.session, None)


def test_layers_are_settled_only_when_something_changed(window, monkeypatch):
    asked, evaluate = [], layer_stages.evaluate_layer

    def counted(*given):
        asked.append(1)
        return evaluate(*given)

    with window.session.jobs.held():
        show(window, many_layers())
        window.frames(3)
        monkeypatch.setattr(layer_stages, "evaluate_layer", counted)
        window.frames(3)
        assert not asked
        editing.edit_document(window.session, layer_commands.rename_layer(1, "arm"))
        window.frames(1)
        assert len(asked) == LAYERS
        saving.set_project(window.session, None)
