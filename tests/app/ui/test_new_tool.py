"""A new tool is one class and one entry of the table: its shapes, hint, cursor and badge follow."""

from dataclasses import dataclass

import pytest
from imgui_bundle import imgui

from app.editor.overlay_shapes import (
    AreaShape,
    CircleShape,
    KnobShape,
    LineShape,
    StrokeShape,
    TagShape,
)
from app.editor.parts.tools import Hint
from app.editor.tools import table
from app.editor.tools.tool import Tool
from app.ui.viewport import viewport
from app.ui.viewport.interaction import hints, shapes

MEASURED = "41 px"


@dataclass(slots=True, kw_only=True, eq=False)
class MeasureTool(Tool):
    """Measures a way over the drawing."""

    cursor = "hand"
    start: complex

    @classmethod
    def mode(cls, _session, _project):
        return "Measuring"

    @classmethod
    def hints(cls, _session, _project, _spot):
        return (Hint("drag to measure"),)

    @classmethod
    def idle_shapes(cls, _session, _project, spot):
        return (CircleShape(centre=spot.place, radius=10.0, role="danger", width=0.5),)

    @classmethod
    def press(cls, _session, project, spot):
        return cls(project=project, start=spot.place)

    def shapes(self, place, em):
        corners = [place, place + em, place + em * 1j]
        return (
            LineShape(points=[self.start, place], width=0.5),
            *(AreaShape(points=corners), KnobShape(centre=place, radius=em)),
            *(StrokeShape(points=[self.start, place], radius=em), TagShape(text=MEASURED)),
        )

    @property
    def active_hints(self):
        return (Hint("let go to stop measuring"),)


@pytest.fixture
def drawn(monkeypatch, window, loose):
    """What the window shows of the tool: all its shapes, cursors and texts."""
    assert loose is window.session.project
    found = {"shapes": [], "cursors": [], "texts": []}
    draw, pill = shapes.draw_shapes, hints._draw_pill
    cursor = imgui.set_mouse_cursor

    def note(what, usual, at):
        def noted(*arguments):
            found[what].append(arguments[at])
            return usual(*arguments)

        return noted

    monkeypatch.setitem(table.MODES, "measure", (MeasureTool,))
    window.session.tools.select("measure")
    noted_shapes = note("shapes", draw, 2)
    monkeypatch.setattr(viewport, "draw_shapes", noted_shapes)
    monkeypatch.setattr("app.ui.viewport.interaction.drag.draw_shapes", noted_shapes)
    monkeypatch.setattr(imgui, "set_mouse_cursor", note("cursors", cursor, 0))
    monkeypatch.setattr(hints, "_draw_pill", note("texts", pill, 1))
    return found


def test_a_new_tool_shows_its_shapes_hint_cursor_and_badge(window, drawn):
    place = window.point(complex(*window.session.project.document.canvas) / 2)
    texts, pictures = [], []

    def play(robot):
        robot.mouse_move_to_pos(place)
        robot.yield_(2)
        texts.append(window.session.tools.hint)
        pictures.append(sum(isinstance(each, CircleShape) for each in flat(drawn["shapes"])))
        robot.mouse_down()
        robot.mouse_move_to_pos(place + imgui.ImVec2(40, 10))
        robot.yield_(2)
        texts.append(window.session.tools.hint)
        robot.mouse_up()

    window.run(play)
    assert texts == [
        "Drag to measure, Esc goes back to posing",
        "Let go to stop measuring, Esc cancels",
    ]
    assert pictures[0] > 0
    assert imgui.MouseCursor_.hand in drawn["cursors"]
    assert any(text.startswith("Measuring: ") for text in drawn["texts"])
    kinds = {type(each) for each in flat(drawn["shapes"])}
    assert kinds >= {LineShape, AreaShape, KnobShape, StrokeShape, TagShape}
    window.run(lambda robot: robot.key_press(imgui.Key.escape))
    window.frames(2)
    assert window.session.tools.is_posing


def flat(groups):
    return [shape for group in groups for shape in group]
