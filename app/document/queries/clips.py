"""A figure in the time of its scene."""

from dataclasses import dataclass

from app.document.figure import Figure
from app.document.keyframe import Keyframe
from app.document.model import Document
from app.document.settings import FrameRange
from engine.variant import Baseline


@dataclass(frozen=True, slots=True, kw_only=True)
class Clip:
    """A figure in the time of its scene: all that its motion follows from.

    Clips are equal where the motion is.
    """

    figure: Figure
    frames: FrameRange  # of the scene
    loop: bool
    fps: float  # springs swing in seconds
    # A method that the figure's own variant is compared with, in place of it.
    baseline: Baseline | None = None
    # Those of the figures that it hangs on at some time, by themselves, where springs and planted
    # tracks follow from them.
    carriers: "tuple[Clip, ...]" = ()

    @property
    def keys(self) -> tuple[Keyframe, ...]:
        """The figure's keys."""
        return self.figure.keys

    @property
    def period(self) -> int:
        """How many frames a loop takes until it comes round."""
        return self.frames.last - self.frames.first


def clip_of(document: Document, figure: int) -> Clip:
    """Return the clip of the figure with this id."""
    own = document.figure(figure)
    feels = [each.enabled for each in own.springs]
    feels += [each.enabled and each.planted for each in own.tracks]

    def clip(each: Figure, carriers: tuple[Clip, ...] = ()) -> Clip:
        return Clip(
            figure=each,
            frames=document.frames,
            loop=document.loop,
            fps=document.fps,
            carriers=carriers,
        )

    carriers = document.all_carriers(figure) if any(feels) else ()
    return clip(own, tuple(map(clip, carriers)))
