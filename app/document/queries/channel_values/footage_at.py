"""The frame of a layer's footage at a frame of the document."""

from dataclasses import replace

from app.document.channels.kinds import FOOTAGE_TIME
from app.document.channels.values import FootageTime
from app.document.layer import Layer
from app.document.model import Document
from app.document.queries.channel_values.repeats import held_key_at, repeated_keys, rest_value


def footage_time_at(document: Document, layer: Layer, frame: float) -> FootageTime:
    """Return the time of a layer's footage as it is at a frame: a key with it changes nothing.

    Each key starts the footage anew. Before the first key its frame holds. Without keys the footage
    starts with the document.
    """
    keys, frame = layer.keys_of(FOOTAGE_TIME), document.loop_frame(frame)
    rest = rest_value(layer, FOOTAGE_TIME, None)
    key = held_key_at(repeated_keys(keys, layer.cycles, document.frames.last, rest), frame)
    if key is not None:
        since, time = key.frame, key.value
    else:
        since, time = (keys[0].frame if keys else document.frames.first), rest
    if layer.footage is None:
        return time
    return replace(time, start=layer.footage.frame_at(time, (frame - since) / document.fps))


def footage_picture_at(document: Document, layer: Layer, frame: float) -> int | None:
    """Return the number of the picture of a layer's footage at a frame; None without footage."""
    if layer.footage is None:
        return None
    return layer.footage.picture_of(footage_time_at(document, layer, frame).start)
