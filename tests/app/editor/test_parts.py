"""The parts of a session and of a project keep their rules by themselves."""

from dataclasses import fields, replace

import pytest
from documents import disc_document
from sessions import session_of

from app.document import OPACITY, Channel, Document, pose_channel
from app.editor.actions.updates.frame_update import session_revision
from app.editor.parts.dialogs import DialogState, ProblemReport, RecoveryDialog, ShortcutSheet
from app.editor.parts.export_state import ExportDestinations
from app.editor.parts.notices import Notices
from app.editor.parts.selection import Selection
from app.editor.parts.timeline.gestures import KeyBox
from app.editor.parts.timeline.time_range import TimeRangeView
from app.editor.parts.timeline.timeline_state import TimelineState
from app.editor.parts.tools import ToolState
from app.editor.work.motion_setup import MotionSetup
from app.editor.work.revised import Revised

KEYS = {pose_channel(1): frozenset({0, 6})}


@pytest.fixture
def document():
    """Two discs, each with a key at frame 0."""
    layer = disc_document().layers[0]
    return Document(layers=(replace(layer, id=1), replace(layer, id=2, name="other")))


@pytest.fixture
def draft(document):
    layer = document.layers[0]
    return MotionSetup(
        layer=layer.id, domain=layer.domain, kind="anything", motion="hop", joints={}, suggested={}
    )


def test_change_of_any_part_changes_the_revision_of_the_session(tmp_path):
    session = session_of(disc_document(), tmp_path)
    wholes = (session, session.project)
    values = [getattr(whole, each.name) for whole in wholes for each in fields(whole)]
    parts = [*wholes, *(each for each in values if isinstance(each, Revised))]
    assert len(parts) > 20
    for part in parts:
        before = session_revision(session)
        part.revision += 1
        assert session_revision(session) != before, type(part)


def test_window_stays_idle_while_the_pointer_is_over_a_layer(document, tmp_path):
    session = session_of(document, tmp_path)
    before = session_revision(session)
    session.project.layer_list.point_at(0)
    assert session.project.layer_list.pointed_layer == 0
    assert session_revision(session) == before


def test_handles_and_keys_are_not_selected_at_once():
    selection = Selection(active=1)
    selection.select_keys(KEYS)
    assert (selection.frames, selection.key_count) == ({0, 6}, 2)
    selection.select_handles(frozenset({3}))
    assert (selection.handles, selection.keys) == ({3}, {})
    selection.select_keys(KEYS)
    assert (selection.handles, selection.keys) == (frozenset(), KEYS)


def test_nothing_else_is_selected_when_another_layer_is_active():
    selection = Selection(active=1, channel=Channel(OPACITY, 1))
    selection.select_keys(KEYS)
    selection.select_other_layers(frozenset({1, 2}))
    assert selection.other_layers == {2}
    selection.activate_layer(1)
    assert (selection.other_layers, selection.keys) == (frozenset(), KEYS)
    selection.activate_layer(2)
    assert (selection.keys, selection.channel) == ({}, None)


def test_selection_has_only_what_the_document_has(document):
    selection = Selection(active=1, other_layers=frozenset({2, 7}))
    selection.select_keys({**KEYS, pose_channel(2): frozenset({0, 99})})
    selection.keep_existing(document)
    assert (selection.active, selection.other_layers) == (1, {2})
    assert selection.keys == {pose_channel(each): {0} for each in (1, 2)}
    selection.keep_existing(replace(document, layers=document.layers[1:]))
    assert (selection.active, selection.keys) == (2, {})


def test_one_tool_is_selected_at_a_time():
    tools = ToolState()
    assert tools.is_posing
    for mode in ("move", "record", "knife", "stiff"):
        tools.toggle(mode)
        assert tools.mode == mode
        assert tools.is_cutting is (mode == "knife")
        assert tools.stiffness_tool == ("stiff" if mode == "stiff" else None)
    tools.leave("move")
    assert tools.mode == "stiff"
    tools.toggle("stiff")
    assert tools.mode == "pose"


def test_draft_of_a_motion_is_remembered_when_it_is_left(draft):
    tools = ToolState()
    tools.select(draft)
    moved = draft.with_joints({}, None)
    tools.select(moved)
    assert (tools.motion_setup, tools.last_motion_setup) == (moved, None)
    tools.select("knife")
    assert (tools.motion_setup, tools.last_motion_setup) == (None, moved)


def test_timeline_shows_the_range_of_a_gesture_when_it_ends():
    before, during = TimeRangeView(0.0, 1.0), TimeRangeView(5.0, 1.0)
    timeline = TimelineState()
    for shown, after in ((None, None), (before, during)):
        timeline.show_range(shown)
        timeline.begin_gesture(KeyBox(start=0.0, channel=pose_channel(1), keeps={}), before)
        timeline.show_range(during)
        assert timeline.time_range == shown
        timeline.end_gesture()
        assert (timeline.time_range, timeline.gesture) == (after, None)


def test_dialog_below_a_report_returns_when_the_report_is_closed():
    dialogs, below = DialogState(), RecoveryDialog(())
    dialogs.show(ProblemReport(text="", is_kept=True, behind=below))
    dialogs.close()
    assert dialogs.current is below
    dialogs.show(ShortcutSheet())
    dialogs.close()
    assert dialogs.current is None


def test_notice_takes_the_place_of_one_with_its_topic():
    notices = Notices(now=lambda: 3.0)
    notices.show("one", topic="undo")
    notices.show("two")
    notices.show("three", topic="undo")
    assert [(each.text, each.place) for each in notices.toasts] == [("two", 1), ("three", 0)]
    notices.dismiss(notices.toasts[0])
    assert [each.text for each in notices.toasts] == ["three"]


def test_newest_destination_of_an_export_is_the_last(tmp_path):
    exports = ExportDestinations()
    for name in ("gif", "mp4", "gif"):
        exports.choose(name, tmp_path / name)
    assert [*exports.by_format] == ["mp4", "gif"]
