"""A layer in the time of its scene."""

from dataclasses import dataclass

from app.document.keyframe import Keyframe
from app.document.layer import Layer
from app.document.model import Document
from app.document.settings import FrameRange
from engine.variant import Baseline


@dataclass(frozen=True, slots=True, kw_only=True)
class Clip:
    """A layer in the time of its scene: all that its motion follows from.

    Clips are equal where the motion is.
    """

    layer: Layer
    frames: FrameRange  # of the scene
    loop: bool
    fps: float  # springs swing in seconds
    # A method that the layer's own variant is compared with, in place of it.
    baseline: Baseline | None = None
    # Those of the layers that it hangs on at some time, by themselves, where springs and planted
    # tracks follow from them.
    carriers: "tuple[Clip, ...]" = ()

    @property
    def keys(self) -> tuple[Keyframe, ...]:
        """The layer's keys."""
        return self.layer.keys

    @property
    def period(self) -> int:
        """How many frames a loop takes until it comes round."""
        return self.frames.last - self.frames.first


def clip_of(document: Document, layer: int) -> Clip:
    """Return the clip of the layer with this id."""
    own = document.layer(layer)
    feels = [each.enabled for each in own.springs]
    feels += [each.enabled and each.planted for each in own.tracks]

    def clip(each: Layer, carriers: tuple[Clip, ...] = ()) -> Clip:
        return Clip(
            layer=each,
            frames=document.frames,
            loop=document.loop,
            fps=document.fps,
            carriers=carriers,
        )

    carriers = document.all_carriers(layer) if any(feels) else ()
    return clip(own, tuple(map(clip, carriers)))
