"""Sounds in a pose script: files beside the script."""

from collections.abc import Collection
from dataclasses import dataclass, replace
from math import inf
from pathlib import Path

from app.document import VOLUME, Document, Key, Sound, sound_commands
from app.errors import LissomError
from app.solving.script.channels import read_keys
from app.solving.script.fields import read_fields
from app.sound import inspect_sound, new_sound
from app.storage import as_flag, as_list, as_number, as_text, located, read_file
from app.texts import _

SOUND_FIELDS = ("file", "name", "at", "from", "to", "volume", "muted")


@dataclass(frozen=True, slots=True, kw_only=True)
class ScriptSound:
    """A sound: its file, the frame at which it begins, and the part that is heard, in seconds."""

    where: str  # in the script, for errors
    file: str
    name: str | None = None  # None takes the file's name
    at: float = 0.0
    begin: float = 0.0
    end: float = inf
    volume: float = 1.0
    keys: tuple[Key[float], ...] = ()
    muted: bool = False


def parse_sounds(content: object) -> tuple[ScriptSound, ...]:
    return tuple(
        _sound(each, f"sounds[{index}]") for index, each in enumerate(as_list(content, "sounds"))
    )


def _sound(content: object, where: str) -> ScriptSound:
    fields = read_fields(content, where, SOUND_FIELDS)
    begin = as_number(fields.get("from", 0.0), f"{where}.from")
    end = as_number(fields["to"], f"{where}.to") if "to" in fields else inf
    if not 0 <= begin < end:
        raise LissomError(
            _('{where}: "from" and "to" are seconds of the file, in order').format(where=where)
        )
    volume, keys = fields.get("volume", 1.0), tuple[Key[float], ...]()
    if isinstance(volume, list):
        at = f"{where}.volume"
        keys = read_keys(VOLUME, ((f"{at}[{i}]", each) for i, each in enumerate(volume)), at)
        volume = 1.0
    volume = as_number(volume, f"{where}.volume")
    located(f"{where}.volume", VOLUME.check, volume)
    return ScriptSound(
        where=where,
        file=as_text(fields["file"], f"{where}.file"),
        name=as_text(fields["name"], f"{where}.name") if "name" in fields else None,
        at=as_number(fields.get("at", 0.0), f"{where}.at"),
        begin=begin,
        end=end,
        volume=volume,
        keys=keys,
        muted=as_flag(fields.get("muted", False), f"{where}.muted"),
    )


def with_sounds(document: Document, sounds: Collection[ScriptSound], folder: Path) -> Document:
    """Return a document with the sounds of a script, whose files are in its folder."""
    for given in sounds:
        try:
            document = sound_commands.add_sound(_read(given, folder))(document)
        except LissomError as error:
            raise LissomError(f"{given.where}: {error}") from error
    return document


def _read(given: ScriptSound, folder: Path) -> Sound:
    path = folder / given.file
    whole = new_sound(inspect_sound(read_file(path), path.name), given.at)
    end = min(given.end, whole.length)
    if given.begin >= end:
        raise LissomError(
            _("{name} lasts {seconds:.3g} s, so nothing is left from {begin:g} s on").format(
                name=path.name, seconds=whole.length, begin=given.begin
            )
        )
    return replace(
        whole,
        name=given.name or whole.name,
        skip=given.begin,
        length=end - given.begin,
        volume=given.volume,
        keys=given.keys,
        muted=given.muted,
    )
