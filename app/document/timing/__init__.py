"""How time runs between keys, and clocks of single handles: tracks and springs.

In: numbers and ids of handles.
Out: frozen values, checked as they are made.
Imports: `app.errors`, and the checks of `app.document`.
"""

from app.document.timing.cycles import (
    Cycle as Cycle,
    changes_in as changes_in,
    count_changes as count_changes,
    require_apart as require_apart,
    require_repeatable as require_repeatable,
)
from app.document.timing.easing import (
    HOLD as HOLD,
    LINEAR as LINEAR,
    PRESETS as PRESETS,
    Easing as Easing,
)
from app.document.timing.moving_key import MovingKey as MovingKey
from app.document.timing.passing import Passing as Passing, require_passing as require_passing
from app.document.timing.springs import SPRINGS as SPRINGS, Spring as Spring
from app.document.timing.tracks import (
    MOST_TURN as MOST_TURN,
    Track as Track,
    TrackKey as TrackKey,
)
