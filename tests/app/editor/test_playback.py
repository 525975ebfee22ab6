"""Where playback begins and ends, and when a hand on a track comes first."""

from dataclasses import replace

import pytest
from documents import altered, disc_document
from sessions import session_of

from app.document import FrameRange
from app.editor.actions import playback


@pytest.fixture
def session(tmp_path):
    """A disc in a scene of 40 frames, of which 10 to 30 play."""
    document = replace(
        altered(disc_document(), frames=FrameRange(0, 40)), preview=FrameRange(10, 30)
    )
    return session_of(document, tmp_path)


def test_playhead_goes_to_both_ends_of_what_plays(session):
    playback.seek(session, 20)
    playback.go_to_start(session)
    assert session.project.timeline.playhead.frame == 10
    playback.go_to_end(session)
    assert session.project.timeline.playhead.frame == 30
