"""Track drags: handles that are dragged along their tracks, and recorded drags.

In: a session, a handle, and the pointer's place.
Out: keys of the handle's track.
Imports: `app.editor`, `app.document`, `app.motion`.
"""

from app.editor.actions.tracking.correction_jobs import (
    correction_jobs_for_shown_frame as correction_jobs_for_shown_frame,
    is_track_drag_pending as is_track_drag_pending,
    next_correction_jobs as next_correction_jobs,
)
from app.editor.actions.tracking.recording import (
    RECORDING_SPEEDS as RECORDING_SPEEDS,
    accept_recording as accept_recording,
    discard_recording as discard_recording,
    drag_recorded_handle as drag_recorded_handle,
    retry_recording as retry_recording,
    set_recording_speed as set_recording_speed,
    smooth_recording as smooth_recording,
    start_recording as start_recording,
    stop_recording as stop_recording,
    toggle_recording_armed as toggle_recording_armed,
    update_track_drags as update_track_drags,
)
from app.editor.actions.tracking.track_dragging import (
    cancel_track_drag as cancel_track_drag,
    drag_track_handle as drag_track_handle,
    draggable_track as draggable_track,
    rotate_track_handle as rotate_track_handle,
)
from app.editor.actions.tracking.track_space import (
    find_key_frame as find_key_frame,
    track_target as track_target,
    track_target_angle as track_target_angle,
)
