"""Exports as a person makes them: in one format after another, from any tab."""

import threading
from dataclasses import replace

import pytest
from imgui_bundle import imgui

from app.document import scene_commands
from app.document.settings import ExportSettings
from app.editor.actions import editing
from app.editor.actions.project_files import export_settings, exporting, saving
from app.editor.actions.timing import keys
from app.editor.parts.dialogs import FileDialog
from app.editor.work.pending_change import PendingChange
from app.errors import report_progress
from app.export_formats import EXPORT_FORMATS
from app.storage import load_project
from app.ui.bars.status import find_state

CTRL_E = int(imgui.Key.mod_ctrl) | int(imgui.Key.e)
SIZE = (60, 24)


@pytest.fixture
def choose(window, loose, monkeypatch):
    """Choose a format in the list of the tab, and return what is exported then."""
    begin_combo, found = imgui.begin_combo, []

    def see(label, *more):
        is_open = begin_combo(label, *more)
        if label == "##format" and not is_open:
            found.append((imgui.get_item_rect_min() + imgui.get_item_rect_max()) / 2)
        return is_open

    # Of what drops down the robot knows no place by name.
    monkeypatch.setattr(imgui, "begin_combo", see)

    def choose(name):
        def click(robot):
            robot.mouse_move_to_pos(found[-1])
            robot.mouse_click(0)
            robot.item_click(f"//##Combo_00/{EXPORT_FORMATS[name].label}")

        window.show_tab("Export")
        window.run(click)
        window.frames(2)
        assert loose.document.export.format == name
        return loose.document.export

    return choose


def test_the_format_is_seen_before_a_place_is_asked_for(window, loose, tmp_path):
    session = window.session
    keys.set_last_frame(session, 24)
    editing.edit_document(
        session, scene_commands.set_export(ExportSettings(format="gif", size=SIZE))
    )
    window.show_tab("Handle")
    seen = []

    def press(robot):
        for _ in range(2):
            seen.append((session.export.frame_box is not None, session.dialogs.current is not None))
            robot.key_press(CTRL_E)
            robot.yield_(3)

    window.run(press)
    assert seen == [(False, False), (True, False)], "whether the tab is in front, and it asks where"
    assert isinstance(session.dialogs.current, FileDialog)
    assert session.dialogs.current.name == "bar.gif"
    session.dialogs.current = replace(session.dialogs.current, folder=tmp_path)
    window.run(lambda robot: robot.item_click("//###dialog/Export"))
    window.until(lambda: (tmp_path / "bar.gif").exists() and session.export.run is None)
    # To choose a place begins nothing.
    window.show_tab("Export")
    window.run(lambda robot: robot.item_click("//Export/**/###choose output"))
    session.dialogs.current = replace(session.dialogs.current, folder=tmp_path)
    # The field of the name takes what is typed, and nothing else meanwhile.
    window.run(lambda robot: robot.key_chars("other.gif"))
    window.run(lambda robot: robot.item_click("//###dialog/Choose"))
    window.settle()
    assert loose.exports.by_format == {"gif": tmp_path / "other.gif"}
    assert [path.name for path in tmp_path.iterdir()] == ["bar.gif"]


def test_each_format_has_the_pictures_that_it_had_last(window, loose, tmp_path, choose):
    settings = replace(loose.document.export, size=SIZE)
    editing.edit_document(window.session, scene_commands.set_export(settings))
    assert choose("mp4").background == "#ffffff"
    # Chosen for the first time: as large as what was chosen before.
    assert loose.document.export.size == SIZE
    film = replace(loose.document.export, size=(128, 64), background="#203040")
    editing.edit_document(window.session, scene_commands.set_export(film))
    assert choose("webm").background == "transparent", "only MP4 needs one"
    for name, size, background in (
        ("png", SIZE, "transparent"),
        ("mp4", (128, 64), "#203040"),
        ("png", SIZE, "transparent"),
    ):
        chosen = choose(name)
        assert (chosen.size, chosen.background) == (size, background)
    saving.write_project(window.session, tmp_path / "a.lissom", None)
    window.settle()
    again = load_project(tmp_path / "a.lissom").export
    assert again == loose.document.export
    assert again.in_format("mp4").background == "#203040"
    # A background that was chosen where it need not be goes along.
    editing.edit_document(
        window.session,
        scene_commands.set_export(replace(loose.document.export, background="#ff0000")),
    )
    assert choose("mov").background == "#ff0000"


def test_names_do_not_grow_from_format_to_format(window, loose, tmp_path, choose):
    editing.edit_document(window.session, scene_commands.set_export(ExportSettings(size=SIZE)))
    export_settings.set_export_destination(window.session, tmp_path / "walk frames")
    for name, file in (
        ("mp4", "walk.mp4"),
        ("png", "walk frames"),
        ("gif", "walk.gif"),
        ("mp4", "walk.mp4"),
        ("png", "walk frames"),
        ("spritesheet", "walk.png"),
    ):
        choose(name)
        out = export_settings.export_destination(loose)
        assert out == tmp_path / file
        export_settings.set_export_destination(window.session, out)
    # A name of one's own is that format's alone.
    choose("gif")
    export_settings.set_export_destination(window.session, tmp_path / "wave.gif")
    choose("mp4")
    assert export_settings.export_destination(loose) == tmp_path / "walk.mp4"
    choose("webp")
    assert export_settings.export_destination(loose) == tmp_path / "wave.webp", (
        "beside the newest one"
    )


def test_another_format_of_the_same_name_asks_before_it_replaces(window, tmp_path, choose):
    session = window.session
    keys.set_last_frame(session, 24)
    editing.edit_document(
        session, scene_commands.set_export(ExportSettings(format="spritesheet", size=SIZE))
    )
    window.act(export_settings.start_export_at, tmp_path / "walk.png")
    window.until(lambda: (tmp_path / "walk.json").exists() and session.export.run is None)
    sheet = (tmp_path / "walk.png").read_bytes()
    choose("apng")
    window.show_tab("Export")
    window.run(lambda robot: robot.item_click("//Export/**/###start"))
    window.settle()
    assert (tmp_path / "walk.png").read_bytes() == sheet
    assert session.dialogs.current.title == "Replace the file?"


def test_the_status_bar_tells_how_far_an_export_is_whatever_tab_is_in_front(
    window, loose, tmp_path, monkeypatch
):
    session, written, draw = window.session, [], imgui.text_colored
    monkeypatch.setattr(
        imgui, "text_colored", lambda colour, text: (written.append(text), draw(colour, text))
    )
    window.frames()
    editing.edit_document(session, scene_commands.set_export(ExportSettings(size=SIZE)))
    window.show_tab("Handle")
    window.clock.cost = 0.02
    try:
        window.act(exporting.start_export, tmp_path / "walk frames")
        window.until(lambda: session.export.run is not None and session.export.run.done > 2)
        total = len(session.export.run.plan.times)
        texts = [text for text in written if text.startswith("Exporting walk frames: ")]
        assert texts
        assert all(text.endswith(f" of {total}") for text in texts)
        window.run(lambda robot: robot.item_click("//**/Cancel"))
    finally:
        window.clock.cost = 0.0
    window.frames()
    assert session.export.run is None
    assert any(toast.text == exporting.CANCELLED_MIDWAY for toast in session.notices.toasts)
    written.clear()
    window.frames(2)
    assert not any("walk frames" in text for text in written)
    assert loose.exports.by_format == {"png": tmp_path / "walk frames"}


def test_an_export_that_is_prepared_tells_how_far_it_is_and_esc_cancels_it(
    window, loose, tmp_path, monkeypatch
):
    session, bars, goes_on = window.session, [], threading.Event()

    def plan_slowly(*_rest):
        while not goes_on.wait(0.01):
            report_progress(0.25)

    def see(share, size, text):
        bars.append((share, text))
        progress_bar(share, size, text)

    progress_bar = imgui.progress_bar
    monkeypatch.setattr(exporting, "plan_export", plan_slowly)
    monkeypatch.setattr(imgui, "progress_bar", see)
    window.show_tab("Export")
    editing.select_handles(session, frozenset({0}))
    try:
        window.act(exporting.start_export, tmp_path / "walk frames")
        while session.jobs.share_of(exporting.PREPARING) is None:
            window.frames()
        window.frames(30)
        assert bars[-1] == (0.25, "Preparing… 25%")
        state = find_state(session)
        assert (state.text, state.label) == ("Preparing the export… 25%", "Cancel")
        window.run(lambda robot: robot.key_press(int(imgui.Key.escape)))
    finally:
        goes_on.set()
    window.settle()
    assert not exporting.is_export_under_way(session)
    assert [toast.text for toast in session.notices.toasts] == [exporting.CANCELLED_UNWRITTEN]
    assert loose.selection.handles == {0}
    assert not list(tmp_path.iterdir())


@pytest.mark.usefixtures("loose")
def test_what_runs_is_never_told_to_be_complete(window, monkeypatch):
    monkeypatch.setattr(exporting, "is_export_under_way", lambda _session: True)
    monkeypatch.setattr(window.session.jobs, "share_of", lambda _kind: 0.999)
    assert find_state(window.session).text == "Preparing the export… 99%"


def test_an_export_tells_what_it_waits_for(window, loose, tmp_path):
    change = PendingChange(label="Solving keys again")
    loose.pending.add(change)
    window.act(exporting.start_export, tmp_path / "walk frames")
    assert find_state(window.session).text == "Solving keys again, then: Export…"
    find_state(window.session).remedy.apply(window.session)
    loose.pending.remove(change)
    window.settle()
    assert not list(tmp_path.iterdir())


def test_a_file_plays_once_or_for_ever_as_it_is_chosen_beside_its_frames(window, loose, choose):
    choose("gif")
    for choice, loops in (("for ever", True), ("for ever", True), ("once", False)):
        window.run(lambda robot, name=choice: robot.item_click(f"//Export/**/###{name}"))
        assert loose.document.loop == loops
