"""Commands on sounds."""

from collections.abc import Sequence
from dataclasses import replace
from typing import Any

from app.document.channels.key import BaseKey, Key
from app.document.channels.kind import Channel
from app.document.channels.kinds import SLIDER, SWITCH, TRACK, SwitchMember
from app.document.channels.sounds import SHORTEST, Mouths, Sound, SoundFile, VolumeKeys
from app.document.channels.tangent_mode import TangentMode
from app.document.channels.tracks import Track, TrackKey
from app.document.commands.command import command, with_number
from app.document.commands.keys.retime import without_repetitions
from app.document.commands.keys.stored_keys import put_keys
from app.document.commands.keys.track_commands import put_track
from app.document.model import Document
from app.document.queries.channel_values.channel_keys import keys_in
from app.texts import _


@command(_("Add sound"))
def add_sound(document: Document, sound: Sound) -> Document:
    """Add a sound; a taken name gets a number."""
    taken = {each.name for each in document.sounds}
    if sound.name in taken:
        sound = replace(sound, name=with_number(sound.name, taken, 2))
    return replace(document, sounds=(*document.sounds, sound))


@command(_("Delete sound"))
def delete_sound(document: Document, name: str) -> Document:
    sounds = tuple(each for each in document.sounds if each is not document.sound(name))
    return replace(document, sounds=sounds)


@command(_("Rename sound"))
def rename_sound(document: Document, name: str, new: str) -> Document:
    return _changed(document, name, name=new.strip())


@command(_("Move sound"))
def move_sound(document: Document, name: str, start: float) -> Document:
    """Let a sound begin at another frame."""
    return _changed(document, name, start=start)


@command(_("Cut sound"))
def cut_sound(document: Document, name: str, skip: float, length: float) -> Document:
    """Cut a sound at both ends, in seconds of its file; what remains stays at its frame."""
    sound = document.sound(name)
    skip = min(max(skip, 0.0), max(sound.file.seconds - SHORTEST, 0.0))
    length = min(max(length, SHORTEST), max(sound.file.seconds - skip, SHORTEST))
    start = sound.start + (skip - sound.skip) * document.fps
    return _changed(document, name, start=start, skip=skip, length=length)


@command(_("Set volume"))
def set_volume(document: Document, name: str, volume: float) -> Document:
    """Set the volume at all frames without keys."""
    return _changed(document, name, volume=volume)


@command(_("Mute sound"))
def mute_sound(document: Document, name: str, *, muted: bool) -> Document:
    return _changed(document, name, muted=muted)


@command(_("Find sound file"))
def replace_sound_file(document: Document, name: str, file: SoundFile) -> Document:
    """Give a sound another file, or its own one that was missing; sounds of that file get it too.

    What is heard ends with the file.
    """
    old = document.sound(name).file
    sounds = tuple(
        replace(
            each,
            file=file,
            skip=min(each.skip, max(file.seconds - SHORTEST, 0.0)),
            length=max(min(each.length, file.seconds - each.skip), SHORTEST),
        )
        if each.name == name or each.file.sha256 == old.sha256 == file.sha256
        else each
        for each in document.sounds
    )
    return replace(document, sounds=sounds)


@command(_("Set mouths"))
def set_mouths(
    document: Document, name: str, mouths: Mouths, keys: Sequence[Key[SwitchMember]]
) -> Document:
    """Put keys of mouths into a switch, in place of those that this sound made before.

    The first time they replace keys at the same frames. Later, a key that a person has set or
    changed stays.
    """
    earlier = document.sound(name).mouths
    channel: Channel[Any] = Channel(SWITCH, part=mouths.switch)
    switch = document.switch_group(mouths.switch)
    made = {(key.frame, key.value) for key in earlier.keys} if earlier else set()
    own = [key for key in switch.keys if (key.frame, key.value) not in made]
    taken = {key.frame for key in own} if earlier else set()
    placed = tuple(key for key in keys if key.frame not in taken)
    own = [key for key in own if key.frame not in {each.frame for each in placed}]
    row = without_repetitions(sorted([*own, *placed], key=lambda key: key.frame))
    document = put_keys(document, channel, row)
    return _changed(document, name, mouths=replace(mouths, keys=placed))


@command(_("Open with volume"))
def set_volume_keys(document: Document, name: str, made: VolumeKeys) -> Document:
    """Put keys of the volume into a channel, in place of those that this sound made before.

    The channel is a slider's, or the track of a handle, which is made if it does not exist. The
    first time the keys replace those at the same frames. Later, a key that a person has set or
    changed stays.
    """
    channel = _channel_of(made)
    kind = channel.kind
    earlier = [each for each in document.sound(name).volume_keys if _channel_of(each) == channel]
    old = {pair for each in earlier for pair in each.keys}
    row = keys_in(document, channel)
    own = [key for key in row if (key.frame, _value_of(key)) not in old]
    taken = {key.frame for key in own} if earlier else set()
    placed = tuple((frame, value) for frame, value in made.keys if frame not in taken)
    own = [key for key in own if key.frame not in dict(placed)]
    corner = TangentMode.CORNER
    new: list[Any] = [
        TrackKey(frame=frame, place=value, tangent_mode=corner)
        if kind is TRACK
        else kind.key(frame, value, tangent_mode=corner)
        for frame, value in placed
    ]
    keys = tuple(sorted([*own, *new], key=lambda key: key.frame))
    if kind is TRACK and not row and isinstance(made.part, int):
        track = Track(handles=(made.part,), keys=tuple(new))
        document = put_track(made.layer, track)(document)
    else:
        document = put_keys(document, channel, keys)
    others = [each for each in document.sound(name).volume_keys if each not in earlier]
    kept = replace(made, keys=placed)
    return _changed(document, name, volume_keys=(*others, kept))


def _channel_of(made: VolumeKeys) -> Channel[Any]:
    return Channel(TRACK if made.kind == TRACK.name else SLIDER, made.layer, made.part)


def _value_of(key: BaseKey) -> complex | None:
    if isinstance(key, TrackKey):
        return key.place
    return complex(key.value) if isinstance(key, Key) else None


def _changed(document: Document, named: str, /, **fields: Any) -> Document:
    """Return a document with a changed sound, the same object without a change."""
    before = document.sound(named)
    changed = replace(before, **fields)
    if changed == before:
        return document
    return replace(
        document, sounds=tuple(changed if each is before else each for each in document.sounds)
    )
