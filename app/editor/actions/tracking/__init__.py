"""Tracks under the hand: handles that it carries, and drags that are recorded.

In: a session, a handle, and where the pointer has it.
Out: keys of the handle's track.
Imports: `app.editor`, `app.document`, `app.motion`.
"""

from app.editor.actions.tracking.carrying import (
    carried_track as carried_track,
    carry as carry,
    forget as forget,
    turn as turn,
)
from app.editor.actions.tracking.places import (
    key_frame as key_frame,
    wished as wished,
    wished_turn as wished_turn,
)
from app.editor.actions.tracking.recording import (
    RECORDING_SPEEDS as RECORDING_SPEEDS,
    again as again,
    begin_take as begin_take,
    end_take as end_take,
    give_up as give_up,
    keep as keep,
    maintain as maintain,
    perform as perform,
    set_speed as set_speed,
    smooth as smooth,
    take_up as take_up,
)
from app.editor.actions.tracking.solving import (
    is_under_way as is_under_way,
    missing as missing,
    missing_here as missing_here,
)
