"""Documents with many keys of one kind, a frame apart."""

from dataclasses import replace

from scenes import drawn

from app.document import (
    CAMERA,
    DRAW_ORDER,
    OPACITY,
    SWITCH,
    TRANSFORM,
    VISIBILITY,
    Camera,
    DrawOrder,
    Transform,
)
from app.document.channels.cycles import Cycle
from app.document.channels.tracks import Track, TrackKey
from app.document.commands import handle_commands
from app.document.keyframe import Keyframe
from app.document.layers.switch_group import SwitchGroup
from app.document.model import Document
from app.document.settings import FrameRange, Marker

KINDS = ("keys", "tracks", "switches", "cycles", "changes", "turns", "markers", "camera")


def crowded(kind: str, count: int) -> Document:
    """Return a document with so many keys of a kind; with none it has but its first pose."""
    document = handle_commands.add_handle(0, 60 + 47j, name="a")(drawn())
    document = replace(document, frames=FrameRange(0, max(count, 48)))
    layer, frames = document.layers[0], range(count)
    pose, handle = layer.keys[0].pose, layer.handles[0].id
    match kind:
        case "keys":
            layer = replace(layer, keys=tuple(Keyframe(frame=at, pose=pose) for at in frames))
        case "tracks":
            row = tuple(TrackKey(frame=at, place=0j) for at in frames)
            layer = replace(layer, tracks=(Track(handles=(handle,), keys=row),))
        case "switches":
            row = tuple(VISIBILITY.key(at, value=bool(at % 2)) for at in frames)
            layer = replace(layer, channels={(VISIBILITY.name, None): row})
        case "cycles":
            layer = replace(layer, cycles=(Cycle(first=0, last=1),))
        case "changes":
            layer = replace(
                layer,
                channels={
                    (TRANSFORM.name, None): tuple(TRANSFORM.key(at, Transform()) for at in frames),
                    (OPACITY.name, None): tuple(OPACITY.key(at, 0.5) for at in frames),
                    (DRAW_ORDER.name, None): tuple(
                        DRAW_ORDER.key(at, DrawOrder(beside=None)) for at in frames
                    ),
                },
            )
        case "turns":
            turns = tuple(SWITCH.key(at, at % 2) for at in frames)
            choice = SwitchGroup(name="mouth", members=(0, 1), keys=turns)
            other = replace(layer, id=1, name="other")
            return replace(document, layers=(layer, other), switch_groups=(choice,))
        case "markers":
            row = tuple(Marker(frame=at, name=f"marker {at}") for at in frames)
            document = replace(document, markers=row)
        case "camera":
            row = tuple(CAMERA.key(at, Camera(centre=0j, zoom=1.0)) for at in frames)
            document = replace(document, camera=row)
    return replace(document, layers=(layer,))
