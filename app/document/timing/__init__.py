"""Time between keys, and motion of single handles: easing, cycles, tracks and springs.

In: numbers and ids of handles.
Out: frozen values, checked by their constructors.
Imports: `app.errors`, and the checks of `app.document`.
"""

from app.document.timing.base_key import BaseKey as BaseKey
from app.document.timing.cycles import (
    Cycle as Cycle,
    count_changes_within as count_changes_within,
    count_repeated_changes as count_repeated_changes,
    require_no_overlap as require_no_overlap,
    require_repeatable_cycle as require_repeatable_cycle,
)
from app.document.timing.easing import (
    HOLD as HOLD,
    LINEAR as LINEAR,
    PRESETS as PRESETS,
    Easing as Easing,
)
from app.document.timing.springs import SPRING_PRESETS as SPRING_PRESETS, Spring as Spring
from app.document.timing.tangent_mode import (
    TangentMode as TangentMode,
    require_tangent_mode as require_tangent_mode,
)
from app.document.timing.tracks import (
    MAX_TRACK_ROTATION as MAX_TRACK_ROTATION,
    Track as Track,
    TrackKey as TrackKey,
)
