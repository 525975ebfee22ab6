"""Several keys that are pasted flipped, with the ways between them."""

from dataclasses import replace

import pytest
from animations import still_document
from documents import altered
from sessions import session_of, settle

from app.document import DEPTH, Channel, Keyframe, handle_commands, pose_channel
from app.editor.actions import editing, playback
from app.editor.poses import copying, flipping, pasting
from app.editor.poses.pasting import NOT_PASTED


@pytest.fixture
def session(tmp_path):
    """A blob with a pair of handles; from frame 0 to 6 it turns round, the left hand in front."""
    document = still_document()
    for name, place in (("paw.L", 40 + 45j), ("paw.R", 80 + 45j)):
        document = handle_commands.add_handle(0, place, name=name)(document)
    first = document.layers[0].keys[0]
    keys = (
        replace(first, revolutions=2),
        Keyframe(frame=6, pose=first.pose, revolutions=-1),
    )
    channels = {(DEPTH.name, 0): (DEPTH.key(0, 1.0),)}
    return session_of(altered(document, keys=keys, channels=channels), tmp_path)


def test_keys_are_flipped_with_their_turns_and_what_is_in_front(session):
    project, before = session.project, session.project.document
    depth = Channel(DEPTH, project.selection.active, 0)
    chosen = {pose_channel(project.selection.active): frozenset({0, 6}), depth: frozenset({0})}
    editing.select_channel_keys(session, chosen)
    copying.copy_keys(session)
    playback.scrub(session, 20)
    pasting.paste_copied(session, "flipped")
    settle(session)
    assert project.selection.frames == {20, 26}
    assert (project.layer.key(20).revolutions, project.layer.key(26).revolutions) == (-2, 1)
    assert project.layer.keys_of(DEPTH, 0) == (DEPTH.key(0, 1.0),)
    assert project.layer.keys_of(DEPTH, 1) == (DEPTH.key(20, 1.0),)
    assert flipping.can_flip_again(project)
    editing.select_keys(session, frozenset({20}))
    assert not flipping.can_flip_again(project)
    editing.undo(session)
    assert project.document is before


def test_late_flip_is_reported(session):
    copying.copy_pose_or_keys(session)
    pasting.paste_copied(session, "flipped")
    editing.edit_layer(session, handle_commands.remove_handles, {0})
    before = session.project.document
    settle(session)
    assert session.project.document is before
    assert NOT_PASTED in session.notices.toasts[-1].text
