"""The active gesture in the viewport, and the items that can be dragged there.

In: the screen, and the pointer.
Out: marks of gestures, grips, texts about both, and actions.
Imports: `app.ui.style`, `app.ui.shortcuts`, and the screen mapping.
"""

from app.ui.viewport.interaction.drag import (
    draw_cuts as draw_cuts,
    draw_pending_strokes as draw_pending_strokes,
    follow_pointer as follow_pointer,
)
from app.ui.viewport.interaction.gizmos import (
    add_mirror_axis_gizmo as add_mirror_axis_gizmo,
    draw_mirror_axis as draw_mirror_axis,
    draw_rotation_gizmo as draw_rotation_gizmo,
    find_rotation_gizmo as find_rotation_gizmo,
)
from app.ui.viewport.interaction.hints import (
    draw_badges as draw_badges,
    draw_mode_badge as draw_mode_badge,
    find_first_step as find_first_step,
    find_hint as find_hint,
)
from app.ui.viewport.interaction.joints import (
    draw_joints as draw_joints,
    joint_colour as joint_colour,
)
from app.ui.viewport.interaction.recording import (
    add_track_key_gizmos as add_track_key_gizmos,
    draw_recording_bar as draw_recording_bar,
)
