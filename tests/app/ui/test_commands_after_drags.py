"""Every command of the menus, asked for at once after a drag: nothing of the drag is lost."""

from dataclasses import replace

import pytest
from bars import BENT, check_at_rest, drag_bar
from invariants import check_invariants

from app.document.commands import scene_commands
from app.editor.actions import editing, playback
from app.editor.actions.project_files import exporting, saving
from app.editor.parts.dialogs import Question
from app.editor.poses import copying
from app.storage import load_project
from app.ui.shortcuts.table import ACTIONS
from app.ui.timeline import keys

# Which edit the document at once, by a step of their own beside the drag's.
EDITS = (
    *(
        "Save pose",
        "Lock",
        "Loop",
        "Set preview start",
        "Set preview end",
        "Add marker",
        "Key the camera",
    ),
    *("Next tangent mode", "Ease in and out", "Ease in", "Ease out"),
)
# Which wait for the pose, change it or its handles, or leave its frame or the project. All others
# are held to edit nothing: a new one that does so, and is in no list, fails there.
ALONE = (
    *("Save", "Reload drawing", "Export again", "Copy picture", "Close", "Quit", "Undo"),
    *(
        "Copy",
        "Copy poses of all layers",
        "Paste",
        "Paste flipped",
        "Paste swapped",
        "Paste on selected handles",
        "Paste flipped on selected",
    ),
    *("Delete", "Rig this", "Suggest handles", "Pin here", "Key this handle only", "Mirror"),
    *("First frame", "Play", "Insert key", "Your first animation"),
)
VIEWS = [name for name in ACTIONS if name not in {*EDITS, *ALONE}]

# Whose own effect is that the key has another pose, or is gone: one step back it is there.
INSTEAD = {
    "Paste",
    "Paste flipped",
    "Paste on selected handles",
    "Paste flipped on selected",
    "Undo",
}

# Which pull further: before anything of the drag is seen, both are one step.
FURTHER = {"Paste on selected handles", "Paste flipped on selected"}


@pytest.fixture
def ready(window, loose, tmp_path, monkeypatch):
    """That bar with all that commands may need: a file, a place for exports, a copied pose."""
    monkeypatch.setattr(
        "app.editor.actions.project_files.exporting.clipboard_program", lambda: ("true",)
    )
    monkeypatch.setattr(
        "app.editor.actions.project_files.exporting.put_on_clipboard", lambda _: None
    )
    export = replace(loose.document.export, format="picture", framing="canvas")
    editing.edit_document(window.session, scene_commands.set_export(export))
    loose.exports.by_format["picture"] = tmp_path / "picture.png"
    saving.write_project(window.session, tmp_path / "a.lissom", None)
    playback.scrub(window.session, 0)
    window.settle()
    copying.copy_pose_or_keys(window.session)
    loose.selection.handles = frozenset({0})
    return loose


def call(window, name):
    binding = ACTIONS[name]
    window.act(binding.action.verb, *binding.action.arguments)


def test_drag_survives_each_command_that_edits_nothing(window, ready, monkeypatch):
    session, start = window.session, ready.document
    goal = drag_bar(window, ready)
    drag = ready.drag
    window.until(lambda: drag.preview is not None)
    # Nothing more comes of it until all commands are done.
    deliver = session.jobs.deliver
    monkeypatch.setattr(session.jobs, "deliver", lambda: None)
    dragged, label = ready.document, ready.history.undo_label
    for name in VIEWS:
        call(window, name)
        session.dialogs.current = None
        playback.scrub(session, BENT)
        check_invariants(session)
        held = {
            "project": session.project is ready,
            "document": ready.document is dragged,
            "step": ready.history.undo_label == label,
            "drag": ready.drag is drag and ready.visible_drag is drag,
            "at once": not ready.pending.deferred and not exporting.is_export_under_way(session),
        }
        lost = [what for what, is_held in held.items() if not is_held]
        assert not lost, f"“{name}” edits, waits or leaves: it belongs to another list"
        ready.selection.handles = frozenset({0})
    assert not drag.is_at_rest
    monkeypatch.setattr(session.jobs, "deliver", deliver)
    window.until(lambda: not ready.pending.changes)
    check_at_rest(ready.document, goal)
    while ready.document is not start:
        assert ready.history.undo_label is not None
        editing.undo(session)


def test_drag_is_a_step_beside_each_edit_that_follows(window, ready):
    session, start = window.session, ready.document
    goal = drag_bar(window, ready)
    drag = ready.drag
    window.until(lambda: drag.preview is not None)
    lost, steps = [], [ready.history.position]  # with the drag's own
    for name in EDITS:
        call(window, name)
        steps.append(ready.history.position)
        if steps[-1] != steps[-2] + 1:
            lost.append(name)
    assert not lost, "each is one step"
    window.until(lambda: not ready.pending.changes and not ready.pending.deferred)
    check_invariants(session)
    for name in reversed(EDITS):
        before = ready.document
        check_at_rest(before, goal)
        editing.undo(session)
        assert ready.document is not before, name
    check_at_rest(ready.document, goal)
    editing.undo(session)
    assert ready.document is start


@pytest.mark.parametrize("name", ALONE)
def test_drag_comes_to_rest_whatever_command_follows(window, ready, name):
    session, path = window.session, ready.file.path
    start = ready.document
    goal = drag_bar(window, ready)
    assert ready.drag is not None
    if name in FURTHER:
        window.until(lambda: ready.drag.preview is not None)
    call(window, name)
    queue = window.program.shell.queue
    window.until(lambda: not (ready.pending.changes or ready.pending.deferred or queue.waiting))
    assert session.project is ready, "it asks first"
    if isinstance(session.dialogs.current, Question):
        (_, save), _ = session.dialogs.current.answers
        session.dialogs.current = None
        save.apply(session)
        window.until(lambda: session.project is None or session.is_quitting)
        check_at_rest(load_project(path), goal)
        return
    session.dialogs.current = None
    window.until(
        lambda: session.export.run is None and exporting.PREPARING not in session.jobs.kinds
    )
    playback.stop_playback(session)
    check_invariants(session)
    if name == "Save":
        check_at_rest(load_project(path), goal)
    if name == "Undo":
        assert ready.document is start
        editing.redo(session)
    elif name in INSTEAD:
        editing.undo(session)
    check_at_rest(ready.document, goal)
    while ready.document is not start:
        assert ready.history.undo_label is not None
        editing.undo(session)


def test_key_is_hollow_until_its_pose_rests(window, ready, monkeypatch):
    sizes = []
    monkeypatch.setattr(keys, "draw_key_mark", lambda _, __, radius, ___: sizes.append(radius))

    def least():
        sizes.clear()
        window.frames(1)
        return min(sizes)

    usual = least()
    drag_bar(window, ready)
    window.frames(1)
    assert least() < 0.7 * usual
    window.until(lambda: ready.drag is None)
    assert least() == usual
