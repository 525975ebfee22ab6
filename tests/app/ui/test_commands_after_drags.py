"""Every command of the menus, asked for at once after a drag: nothing of the drag is lost."""

from dataclasses import replace

import pytest
from bars import check_at_rest, drag_bar
from invariants import check_invariants

from app.document.commands import scene_commands
from app.editor.actions import editing, exporting, playback, saving
from app.editor.dialogs import Question
from app.editor.poses import copying
from app.storage import load_project
from app.ui.shortcuts import BINDINGS

# Whose own effect is that the key has another pose, or is gone: one step back it is there.
INSTEAD = {"paste", "paste flipped", "paste on selected", "flip on selected", "undo"}

# Which pull further: before anything of the drag is seen, both are one step.
FURTHER = {"paste on selected", "flip on selected"}


@pytest.fixture
def ready(window, loose, tmp_path, monkeypatch):
    """That bar with all that commands may need: a file, a place for exports, a copied pose."""
    monkeypatch.setattr("app.editor.actions.exporting.clipboard_program", lambda: ("true",))
    monkeypatch.setattr("app.editor.actions.exporting.put_on_clipboard", lambda _: None)
    export = replace(loose.document.export, format="picture", framing="canvas")
    editing.edit(window.session, scene_commands.set_export(export))
    loose.exports_to["picture"] = tmp_path / "picture.png"
    saving.write(window.session, tmp_path / "a.lissom", None)
    playback.scrub(window.session, 0)
    window.settle()
    copying.copy(window.session)
    loose.selected = frozenset({0})
    return loose


@pytest.mark.parametrize("name", BINDINGS)
def test_a_drag_comes_to_rest_whatever_command_follows(window, ready, name):
    session, path = window.session, ready.path
    start = ready.document
    goal = drag_bar(window, ready)
    assert ready.pulls
    if name in FURTHER:
        window.until(lambda: ready.pulls[-1].kept is not None)
    binding = BINDINGS[name]
    window.act(binding.action.verb, *binding.action.arguments)
    window.until(lambda: not ready.pending and not ready.afterwards)
    assert session.project is ready, "it asks first"
    if isinstance(session.dialog, Question):
        (_, save), _ = session.dialog.answers
        session.dialog = None
        save.apply(session)
        window.until(lambda: session.project is None or session.quitting)
        check_at_rest(load_project(path), goal)
        return
    session.dialog = None
    window.until(lambda: session.export is None and exporting.PREPARING not in session.jobs.kinds)
    playback.halt(session)
    check_invariants(session)
    if name == "save":
        check_at_rest(load_project(path), goal)
    if name == "undo":
        assert ready.document is start
        editing.redo(session)
    elif name in INSTEAD:
        editing.undo(session)
    check_at_rest(ready.document, goal)
    while ready.document is not start:
        assert ready.history.undo_label is not None
        editing.undo(session)
