"""What handles are to each other and to the drawing: pairs on two sides, bones, and joints.

In: handles.
Out: their partners, bones and the material that these make, and motions that joints were given.
Imports: the values of `app.document`.
"""

from app.document.body.given import (
    GivenMotion as GivenMotion,
    UnreadMotion as UnreadMotion,
    require_motions as require_motions,
)
from app.document.body.material import (
    USUAL_STRENGTH as USUAL_STRENGTH,
    Bone as Bone,
    carried_over as carried_over,
    joined_stiffness as joined_stiffness,
    require_amount as require_amount,
    usual_as_none as usual_as_none,
)
from app.document.body.pairs import (
    PAIRS as PAIRS,
    SIDES as SIDES,
    SidePairs as SidePairs,
    mirrored_name as mirrored_name,
    pairs_by_name as pairs_by_name,
    partners_of as partners_of,
    read_pairs as read_pairs,
    require_pairs as require_pairs,
    written_pairs as written_pairs,
)
