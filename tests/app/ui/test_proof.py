"""What `.ci/bundle/prove` clicks on is where it takes it to be."""

import re
from pathlib import Path

import pytest
from imgui_bundle import ImVec2

from app.editor.actions import tutorials
from app.ui.window.desktop import window_title
from app.ui.window.window import SIZE

PROOF = Path(__file__).parents[3] / ".ci" / "bundle" / "prove"


@pytest.fixture
def hand(window):
    """A function that presses the button at a place of the proof, and lets it go at the last."""
    places = {
        name: ImVec2(int(x), int(y))
        for name, x, y in re.findall(r'(\w+)="(\d+) (\d+)"', PROOF.read_text(encoding="utf-8"))
    }

    def move(*names):
        def act(robot):
            robot.mouse_move_to_pos(places[names[0]])
            robot.mouse_down(0)
            for name in names[1:]:
                robot.mouse_move_to_pos(places[name])
            robot.mouse_up(0)

        window.run(act)
        window.frames(5)

    window.resize(SIZE)
    window.frames(10)
    return move


def test_the_places_lead_from_the_welcome_view_to_each_export(window, hand):
    session = window.session

    def step():
        return session.tutorial.state.stage

    hand("begin")
    window.until(lambda: session.tutorial.state is not None and step() == "handle")
    window.frames(5)
    assert re.fullmatch(r"giraffe.* – Lissom", window_title(session))
    hand("nose")
    assert step() == "time"
    hand("start", "middle")
    assert step() == "pose"
    assert window_title(session) == "giraffe* – Lissom"
    hand("nose", "ground")
    window.until(lambda: step() == "play")
    project = session.project
    assert project.document.export.format == tutorials.FORMAT
    window.show_tab("Export")
    for name, kind in (("video", "mp4"), ("frames", "png")):
        hand("format")
        hand(name)
        assert project.document.export.format == kind
