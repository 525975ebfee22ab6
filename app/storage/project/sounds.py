"""The sounds of a document: their fields, and the bytes of their files.

The bytes are members under `sounds/`, named by their checksums, once for each file.
"""

import hashlib
from collections.abc import Mapping, Sequence
from typing import Any

from app.document import SWITCH, VOLUME, Cue, Document, Mouths, Sound, SoundFile, VolumeKeys
from app.errors import LissomError
from app.storage.files.reading import DAMAGED_ZIP
from app.storage.project.archive import Archive
from app.storage.project.channel_codecs import key_codec
from app.storage.project.codecs import (
    FLAG,
    NUMBER,
    POINT,
    TEXT,
    WHOLE,
    WHOLE_OR_TEXT,
    Field,
    list_of,
    nested_record,
    optional,
    pair,
    record,
)
from app.texts import N_


def _cue(seconds: float, name: str) -> Cue:
    return Cue(seconds=seconds, name=name)


MOUTHS = record(
    Mouths,
    Field("switch", TEXT),
    Field(
        "cues",
        list_of(
            pair(
                NUMBER,
                TEXT,
                N_("seconds and a name"),
                make=_cue,
                of=lambda cue: (cue.seconds, cue.name),
            )
        ),
    ),
    Field("drawings", list_of(pair(TEXT, WHOLE_OR_TEXT, N_("a name and a layer")))),
    Field("keys", list_of(key_codec(SWITCH))),
)
VOLUME_KEYS = record(
    VolumeKeys,
    Field("kind", TEXT),
    Field("layer", WHOLE),
    Field("part", WHOLE_OR_TEXT),
    Field("keys", list_of(pair(WHOLE, POINT, N_("a frame and a value")))),
    unknown=None,
)
# The bytes of its file are a member, named by the checksum.
SOUND = record(
    dict,
    Field("name", TEXT),
    Field(
        "file",
        nested_record(
            dict,
            Field("name", TEXT),
            Field("sha256", TEXT),
            *(Field(name, WHOLE) for name in ("size", "rate", "channels", "samples")),
        ),
    ),
    *(Field(name, NUMBER) for name in ("start", "skip", "length", "volume")),
    Field("keys", list_of(key_codec(VOLUME))),
    Field("muted", FLAG),
    Field("mouths", optional(MOUTHS), default=None),
    Field("volume_keys", list_of(VOLUME_KEYS), default=()),
)


def sound_members(document: Document) -> dict[str, bytes]:
    """Return the members of a document's sounds by their names; missing bytes have none."""
    files = {sound.file.sha256: sound.file.data for sound in document.sounds}
    return {_of_sound(sha256): data for sha256, data in files.items() if data is not None}


def with_sound_files(sounds: Sequence[Mapping[str, Any]], archive: Archive) -> tuple[Sound, ...]:
    """Return the sounds with these fields, and with the bytes of an archive."""
    return tuple(
        Sound(**{**each, "file": SoundFile(**each["file"], data=_data(archive, each["file"]))})
        for each in sounds
    )


def _data(archive: Archive, file: Mapping[str, Any]) -> bytes | None:
    """Return the bytes of a sound file; None if they are missing or damaged.

    A project opens without them, and the file is found again by its checksum.
    """
    name = _of_sound(file["sha256"])
    if not archive.has(name):
        return None
    try:
        data = archive.read(name)
    except (LissomError, *DAMAGED_ZIP):
        return None
    is_same = archive.is_written or hashlib.sha256(data).hexdigest() == file["sha256"]
    return data if is_same else None


def _of_sound(sha256: str) -> str:
    return f"sounds/{sha256}"
