"""What the pointer has in hand in the viewport, and what it could take there.

In: the screen, and the pointer.
Out: marks of gestures, grips, words about both, and what they ask for.
Imports: `app.ui.style`, `app.ui.shortcuts`, and where things are on the screen.
"""

from app.ui.viewport.hand.gesture import (
    draw_coming_strokes as draw_coming_strokes,
    draw_slits as draw_slits,
    go_on as go_on,
)
from app.ui.viewport.hand.grips import (
    draw_axis as draw_axis,
    draw_ring as draw_ring,
    find_ring as find_ring,
    lay_axis as lay_axis,
)
from app.ui.viewport.hand.hints import (
    draw_badges as draw_badges,
    draw_mode as draw_mode,
    first_step as first_step,
    hint_at as hint_at,
)
from app.ui.viewport.hand.joints import (
    draw_joints as draw_joints,
    joint_colour as joint_colour,
)
from app.ui.viewport.hand.takes import draw_take as draw_take, lay_track_keys as lay_track_keys
