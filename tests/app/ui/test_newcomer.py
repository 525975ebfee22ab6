"""From the start to an exported loop, as somebody does it who sees Lissom for the first time."""

from newcomer import Newcomer
from PIL import Image

MOST = 12  # clicks and drags


def test_a_loop_takes_few_clicks_and_drags(window, tmp_path):
    session = window.session
    window.frames(10)
    person = Newcomer(window)
    person.click("//Welcome/**/sample Bar")
    window.settle()
    project = session.project
    person.show_tab("Handle")
    person.click("//Handle/**/###Suggest handles")
    first = project.document
    assert len(project.layer.handles) >= 3
    person.drag_playhead(0.5)
    assert project.timeline.playhead.frame > 5
    handle = max(project.layer_runtime.shown.handle_positions, key=lambda place: place.real)
    person.drag(complex(handle), complex(handle) + 0.3j * project.document.canvas[1])
    assert [key.frame for key in project.layer.keys] == [0, project.timeline.playhead.frame]
    assert project.layer.keys[1].pose is not first.layers[0].keys[0].pose
    person.click("//Timeline/**/Loop")
    assert project.document.loop
    person.click("//Timeline/**/Play")
    window.frames(20)
    assert project.timeline.playhead.since is not None
    person.show_tab("Export")
    session.settings.preferences = type(session.settings.preferences)(folder=tmp_path)
    person.click("//Export/**/###start")
    person.click("//###dialog/Export")
    while session.export.run is not None or session.jobs.kinds:
        window.settle()
    exported = sorted(next(tmp_path.glob("* frames")).glob("*.png"))
    count = project.document.frames.last - project.document.frames.first
    assert len(exported) in {count, count + 1}
    shown = [Image.open(path).tobytes() for path in (exported[0], exported[len(exported) // 2])]
    assert shown[0] != shown[1], "it moves"
    assert person.presses <= MOST, person.presses
