"""What follows from a document: which keys a moment blends, where tracks are, what falls short.

In: layers, poses and handles.
Out: answers; nothing is changed.
Imports: the values of `app.document`.
"""

from app.document.queries.auto_pins import (
    PinnedSegment as PinnedSegment,
    pinned_handles as pinned_handles,
    pinned_segments as pinned_segments,
)
from app.document.queries.clips import (
    Clip as Clip,
    clip_of as clip_of,
    motion_source as motion_source,
)
from app.document.queries.given import (
    digest_of_keys as digest_of_keys,
    is_as_given as is_as_given,
    motion_notices as motion_notices,
)
from app.document.queries.material import (
    are_as_stiff as are_as_stiff,
    brushed_stiffness as brushed_stiffness,
    limb_of as limb_of,
    stiff_outline as stiff_outline,
    stiffened as stiffened,
)
from app.document.queries.remembered import remembered as remembered
from app.document.queries.shortfall import (
    Extremes as Extremes,
    Shortfall as Shortfall,
    falls_short as falls_short,
    find_shortfall as find_shortfall,
)
from app.document.queries.spans import (
    KeySpan as KeySpan,
    closing_span as closing_span,
    intervals as intervals,
    layout as layout,
    place_at as place_at,
    spans as spans,
)
from app.document.queries.stage import (
    AS_DRAWN as AS_DRAWN,
    USUAL_EXTENT as USUAL_EXTENT,
    Composite as Composite,
    Front as Front,
    Shot as Shot,
    TreeRow as TreeRow,
    alternates as alternates,
    camera_at as camera_at,
    carried_by as carried_by,
    change_frame as change_frame,
    composed as composed,
    fronts_at as fronts_at,
    in_order as in_order,
    is_visible as is_visible,
    keyed_frame as keyed_frame,
    layer_tree as layer_tree,
    movement_at as movement_at,
    opacity_at as opacity_at,
    placing_at as placing_at,
    repeated as repeated,
    repeating as repeating,
    seen_alone as seen_alone,
    sights_of as sights_of,
    turn_frame as turn_frame,
    turning as turning,
    turns_in as turns_in,
    whole_groups as whole_groups,
    with_repeats as with_repeats,
)
from app.document.queries.timeline import (
    Moment as Moment,
    changed_stretches as changed_stretches,
    exported_frames as exported_frames,
    frame_times as frame_times,
    framed_frames as framed_frames,
    resting_pose as resting_pose,
    time_of as time_of,
)
from app.document.queries.tracks import (
    TrackPlace as TrackPlace,
    cycle_of as cycle_of,
    root_of as root_of,
    track_at as track_at,
    velocity_at as velocity_at,
)
from app.document.queries.transits import (
    Transit as Transit,
    are_alike as are_alike,
    passings_of as passings_of,
    transits as transits,
)
