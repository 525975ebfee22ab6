"""What follows from a document about its layers as layers: what is seen, where, and as one.

In: documents.
Out: answers; nothing is changed.
Imports: the values of `app.document`.
"""

from app.document.queries.stage.alternates import (
    alternates as alternates,
    whole_groups as whole_groups,
)
from app.document.queries.stage.clipping import seen_alone as seen_alone
from app.document.queries.stage.compositing import Composite as Composite, composed as composed
from app.document.queries.stage.fronts import (
    USUAL_EXTENT as USUAL_EXTENT,
    Front as Front,
    fronts_at as fronts_at,
)
from app.document.queries.stage.layer_tree import (
    TreeRow as TreeRow,
    carried_by as carried_by,
    layer_tree as layer_tree,
)
from app.document.queries.stage.moves import (
    AS_DRAWN as AS_DRAWN,
    Shot as Shot,
    camera_at as camera_at,
    in_order as in_order,
    keyed_frame as keyed_frame,
    movement_at as movement_at,
    opacity_at as opacity_at,
    placing_at as placing_at,
    repeating as repeating,
)
from app.document.queries.stage.sight import (
    change_frame as change_frame,
    is_visible as is_visible,
    repeated as repeated,
    sights_of as sights_of,
    turn_frame as turn_frame,
    turning as turning,
    turns_in as turns_in,
    with_repeats as with_repeats,
)
