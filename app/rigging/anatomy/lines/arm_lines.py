"""Drawn lines between lowered arms and the trunk, and the shoulders above them."""

from collections.abc import Mapping, Sequence

import numpy as np

from app.rigging.anatomy.joints import suggest_joints
from app.rigging.anatomy.lines.limb_lines import LimbLine, find_limb_line
from app.rigging.motions.kinds import BodyKind
from engine.arrays import Bytes, Complexes
from engine.geometry import distance_to_boundary

# In the shoulder's distances from the outline: largest distance of a line's end from the shoulder.
NEAR_SHOULDER = 1.6
# A slit up to the shoulder would let the trunk give way at its end; it ends this far below.
BELOW_SHOULDER = 1.2
FEWEST = 8  # points above a gap between arm and trunk, where the line is drawn


def find_arm_line(
    loops: Sequence[Complexes],
    joints: Mapping[str, complex],
    side: str,
    rgba: Bytes,
    corner: complex,
) -> LimbLine | None:
    """Return the line that parts an arm, seen from the front, from the trunk up to its shoulder.

    None without such a line. The parameters are those of `find_limb_line`, and the side, L or R.
    """
    names = [f"{joint}.{side}" for joint in ("shoulder", "elbow", "hand")]
    if not all(name in joints for name in (*names, "chest", "hips")):
        return None
    arm, trunk = [joints[name] for name in names], [joints["chest"], joints["hips"]]
    line = find_limb_line(loops, arm, trunk, rgba, corner, may_be_behind=True)
    if line is None or line.crotch > len(line.points) - FEWEST:
        return None
    room = float(distance_to_boundary(loops[0], np.array(arm[:1]), loops[1:])[0])
    away = np.abs(line.points - arm[0])
    if away[-1] > NEAR_SHOULDER * room:
        return None
    last = int(np.flatnonzero(away >= BELOW_SHOULDER * room).max(initial=0))
    # The trunk is whole beside the arm.
    return line._replace(points=line.points[: last + 1], crotch=last) if last > 0 else None


def with_shoulders(
    joints: Mapping[str, complex],
    kind: BodyKind,
    loops: Sequence[Complexes],
    rgba: Bytes,
    corner: complex,
) -> Mapping[str, complex]:
    """Return joints whose arms turn in their shoulders where a line parts them from the trunk."""
    if kind.name != "biped-front" or not {"hand.L", "hand.R"} & joints.keys():
        return joints
    raised = suggest_joints(loops, kind, has_arm_lines=True)
    found = dict(joints)
    for side in "LR":
        if find_arm_line(loops, raised, side, rgba, corner) is not None:
            found |= {name: raised[name] for name in (f"shoulder.{side}", f"elbow.{side}")}
    return found
