"""Notices of the remedies that were applied to outline a subject."""

from collections.abc import Sequence

from engine.arrays import Indices
from engine.domain.mask.parts import WholePiece
from engine.domain.outline.margin import MarginCurve
from engine.errors import Message, count_message

LEAST_ENCLOSED = 0.001  # of the subject's area: smallest area that is reported
LEAST_JOINED = 0.03  # of the subject's outline: smallest part that is reported


def describe_filled_holes(
    piece: WholePiece, filled: Indices, small: Indices, crowded: Sequence[int]
) -> tuple[Message, ...]:
    """Describe in words the filled holes: by request, since they are small, and since too many."""
    described = (
        (
            filled,
            count_message(
                "{count:,} hole filled, {share:.2%} of the subject",
                "{count:,} holes filled, the largest {share:.2%} of the subject",
                len(filled),
                share=piece.largest_share(filled),
            ),
        ),
        (
            small,
            count_message(
                "{count:,} hole filled, {share:.2%} of the subject, too small to stay open",
                "{count:,} holes filled, the largest {share:.2%} of the subject, too small to "
                "stay open",
                len(small),
                share=piece.largest_share(small),
            ),
        ),
        (
            crowded,
            count_message(
                "{count:,} hole filled, {share:.2%} of the subject, because too many open holes "
                "make posing slow",
                (
                    "{count:,} holes filled, the largest {share:.2%} of the subject, because too "
                    "many open holes make posing slow"
                ),
                len(crowded),
                share=piece.largest_share(crowded),
            ),
        ),
    )
    return tuple(message for numbers, message in described if len(numbers))


def describe_curve(curve: MarginCurve, widening: float, area: int) -> tuple[Message, ...]:
    """Describe the remedies behind a curve around a subject of `area` cells.

    `widening` is the factor of its margin.
    """
    notices = []
    fused = curve.joined_gap_share()
    if fused >= LEAST_JOINED:
        notices.append(
            Message(
                "limbs too close together were fused and move as one, along {share:.0%} of the "
                "edge",
                {"share": fused},
            )
        )
    if widening > 1:
        notices.append(
            Message(
                "the margin was widened {factor:.1f} times for an outline of few vertices",
                {"factor": widening},
            )
        )
    share = curve.enclosed / area
    if share >= LEAST_ENCLOSED:
        notices.append(
            Message("the outline bridges gaps of {share:.1%} of the subject", {"share": share})
        )
    return tuple(notices)
