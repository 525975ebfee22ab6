"""Notices about joints that miss the targets of a motion preset."""

from collections.abc import Mapping

from app.texts import _

MOST_NAMED = 3  # joints listed in a notice


def describe_misses(errors: Mapping[str, tuple[float, int]], size: float | None) -> tuple[str, ...]:
    """Return a notice of the joints that miss their targets, the worst first; none without.

    `errors` are in pixels, each with its frame; `size` is one in reach, if any.
    """
    if not errors:
        return ()
    worst = sorted(errors.items(), key=lambda each: -each[1][0])
    one = _("{joint!r} by {error:.1f} px (frame {frame})")
    joints = ", ".join(
        one.format(joint=name, error=error, frame=frame)
        for name, (error, frame) in worst[:MOST_NAMED]
    )
    if worst[MOST_NAMED:]:
        more = len(worst) - MOST_NAMED
        joints = _("{names} and {count:,} more").format(names=joints, count=more)
    if size is None:
        return (_("Some joints miss their targets: {joints}").format(joints=joints),)
    return (
        _(
            "Some joints miss their targets: {joints}. At size {size:.2f} every joint "
            "reaches its target"
        ).format(joints=joints, size=size),
    )
