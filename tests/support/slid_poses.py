"""A blob whose top a slider moves up and down; its other handles stay."""

from dataclasses import replace
from functools import cache

from still_poses import dragged, drawing, with_layer

from app.document import SLIDER, FrameRange, LibraryPose, Slider, SliderPose

MOVED = {"up": 1, "down": 2}  # moves of the blob's top; its other handles stay


def slider(*places, **changes):
    poses = tuple(SliderPose(at=complex(at), pose=pose) for at, pose in places)
    return Slider(name="nod", poses=poses, **changes)


NOD = slider((-1, "down"), (0, None), (1, "up"))


@cache
def slid(*values, document=None, slider=NOD, **changes):
    """A document whose slider has these values at frames 10 apart."""
    document = document or replace(drawing(), frames=FrameRange(0, 40))
    library = tuple(LibraryPose(name=name, pose=dragged(number)) for name, number in MOVED.items())
    keys = tuple(SLIDER.key(10 * number, complex(value)) for number, value in enumerate(values))
    channels = {(SLIDER.name, "nod"): keys}
    return with_layer(document, library=library, sliders=(slider,), channels=channels, **changes)
