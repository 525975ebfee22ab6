"""Cues of other programs, and the volume, become keys of mouths."""

import itertools
import json
from dataclasses import replace

import numpy as np
import pytest
from documents import disc_document
from sound_files import sine, sound, wav

from app.document import (
    SWITCH,
    Cue,
    Document,
    Mouths,
    VolumeKeys,
    channel_commands,
    handle_commands,
    keys_in,
    layer_commands,
    sound_commands,
    switch_group_commands,
    track_channel,
)
from app.document.channels.kind import Channel
from app.errors import LissomError
from app.sound import (
    Response,
    cues_of_volume,
    follow_volume,
    guess_drawings,
    inspect_sound,
    make_mouth_keys,
    make_volume_values,
    parse_cues,
)

CUES = ((0.0, "X"), (0.5, "A"), (0.75, "D"), (1.25, "X"))
RHUBARB = {
    "metadata": {"soundFile": "talk.wav", "duration": 1.5},
    "mouthCues": [{"start": at, "end": at + 0.1, "value": name} for at, name in CUES],
}
FILES = {
    "a.tsv": "".join(f"{at:.2f}\t{name}\n" for at, name in CUES),
    "a.json": json.dumps(RHUBARB, indent=2),
    "a.xml": '<?xml version="1.0" encoding="utf-8"?>\n<rhubarbResult><mouthCues>'
    + "".join(f'<mouthCue start="{at}" end="9.0">{name}</mouthCue>\n' for at, name in CUES)
    + "</mouthCues></rhubarbResult>",
    "a.dat": "MohoSwitch1\n" + "".join(f"{1 + round(24 * at)} {name}\n" for at, name in CUES),
    "a.csv": "time,mouth\r\n" + "".join(f'{at},"{name}",more\r\n' for at, name in CUES),
    "b.csv": "".join(f"{at};{name}\n" for at, name in CUES),
}


def pairs(cues):
    return tuple((cue.seconds, cue.name) for cue in cues)


@pytest.mark.parametrize("name", FILES)
def test_cues_of_every_program_are_read(name):
    assert pairs(parse_cues(FILES[name].encode(), name, 24.0)) == CUES
    assert pairs(parse_cues(b"\xef\xbb\xbf" + FILES[name].encode(), name, 24.0)) == CUES


@pytest.mark.parametrize(
    "text",
    [
        *("", "{", "[]", "<a/>", "{}", "MohoSwitch1\n", '{"mouthCues": 3}', "hello world"),
        *("0.0\tX\nlater\tA\n", "0.0\tX\n0.5\n", "0.0\tX\nnan\tA", '{"mouthCues": [[]]}'),
        '{"mouthCues": [{"start": "x", "value": "A"}]}',
        "0 " + "A" * 200,
    ],
)
def test_what_holds_no_cues_is_refused_in_one_sentence(text):
    with pytest.raises(LissomError, match=r"^cues.txt") as raised:
        parse_cues(text.encode(), "cues.txt", 24.0)
    assert "\n" not in str(raised.value)


def test_bytes_that_are_no_text_are_refused():
    with pytest.raises(LissomError, match="holds no cues"):
        parse_cues(b"\xff\xfe\x00" * 50, "cues.dat", 24.0)


def test_drawings_are_guessed_by_their_names():
    layers = [(1, "mouth/closed"), (2, "mouth/ah"), (3, "mouth oh"), (4, "FV")]
    cues = [Cue(seconds=0, name=name) for name in ("X", "A", "D", "E", "G", "?")]
    assert dict(guess_drawings(cues, layers)) == {"X": 1, "A": 1, "D": 2, "E": 3, "G": 4, "?": 1}
    phonemes = [Cue(seconds=0, name=name) for name in ("rest", "AI", "O", "FV", "MBP")]
    guessed = dict(guess_drawings(phonemes, layers))
    assert guessed == {"rest": 1, "AI": 2, "O": 3, "FV": 4, "MBP": 1}


def mouths(cues, **drawings) -> Mouths:
    found = tuple(Cue(seconds=at, name=name) for at, name in cues)
    return Mouths(switch="mouth", cues=found, drawings=tuple(drawings.items()))


def test_keys_follow_the_sound_wherever_it_is():
    talk = sound(wav(sine(2.0)), start=12)
    own = mouths(CUES, X=0, A=1, D=2)
    keys = make_mouth_keys(talk, own, 24.0)
    assert [(key.frame, key.value) for key in keys] == [(12, 0), (24, 1), (30, 2), (42, 0)]
    later = replace(talk, skip=0.75, length=1.25, start=100)
    keys = make_mouth_keys(later, own, 24.0)
    assert [(key.frame, key.value) for key in keys] == [(100, 2), (112, 0)]


@pytest.mark.parametrize("fps", [12.0, 24.0, 25.0, 29.97, 60.0])
def test_two_minutes_become_at_most_eight_keys_a_second(fps):
    random = np.random.default_rng(8)
    times = np.cumsum(random.uniform(0.01, 0.2, 1_200)).tolist()
    cues = [
        (at, "ABC"[index]) for at, index in zip(times, random.integers(3, size=1_200), strict=False)
    ]
    talk = replace(sound(wav(sine(0.5))), length=120.0)
    keys = make_mouth_keys(talk, mouths(cues, A=0, B=1, C=2), fps)
    frames = np.array([key.frame for key in keys])
    assert len(frames) > 300
    within = np.searchsorted(frames, frames + fps) - np.arange(len(frames))
    assert within.max() <= 8
    assert all(one.value != other.value for one, other in itertools.pairwise(keys))


def switched() -> Document:
    document = disc_document()
    for _ in range(2):
        document = layer_commands.duplicate_layer(document.layers[0].id)(document)
    ids = [layer.id for layer in document.layers]
    document = switch_group_commands.create_switch_group("mouth", ids)(document)
    return sound_commands.add_sound(sound(wav(sine(2.0))))(document)


def test_again_replaces_only_its_own_keys():
    document, switch = switched(), Channel(SWITCH, part="mouth")
    first, second, third = document.switch_groups[0].members
    own = mouths(CUES, X=first, A=second, D=third)
    keys = make_mouth_keys(document.sounds[0], own, 24.0)
    document = sound_commands.set_mouths("talk", own, keys)(document)
    assert [key.frame for key in keys_in(document, switch)] == [0, 12, 18, 30]
    # One key is changed by hand, and one is set.
    document = channel_commands.set_key(switch, 18, second)(document)
    document = channel_commands.set_key(switch, 40, third)(document)
    document = channel_commands.set_key(switch, 18, first)(document)
    document = sound_commands.move_sound("talk", 3)(document)
    keys = make_mouth_keys(document.sounds[0], own, 24.0)
    document = sound_commands.set_mouths("talk", own, keys)(document)
    shown = [(key.frame, key.value) for key in keys_in(document, switch)]
    assert shown == [(3, first), (15, second), (18, first), (21, third), (33, first), (40, third)]


def spoken_signal():
    """Silence, half a second of a loud tone, silence, a soft tone."""
    signal = sine(2.0)
    times = np.arange(len(signal)) / 48_000
    signal[(times < 0.5) | ((times > 1.0) & (times < 1.5))] = 0
    signal[times >= 1.5] *= 0.3
    return signal


def test_volume_opens_and_closes_with_attack_and_release():
    inspected = inspect_sound(wav(spoken_signal()), "a.wav")
    opened = follow_volume(inspected, 24.0, Response(attack=0.0, release=0.0))
    assert not opened[:11].any()
    assert (opened[13:23] > 0.9).all()
    assert not opened[26:35].any()
    assert (opened[38:47] < 0.5).all()
    slow = follow_volume(inspected, 24.0, Response(attack=0.2, release=0.3))
    assert (slow[12:16] < opened[12:16]).all()
    assert (slow[26:32] > 0).all()
    assert (np.diff(slow[26:35]) < 0).all()


def test_volume_chooses_among_the_drawings_of_a_switch():
    opened = np.array([0, 0, 0.2, 0.5, 1.0, 1.0, 0.1])
    assert pairs(cues_of_volume(opened, 10.0, 3)) == (
        (0.0, "1"),
        (0.3, "2"),
        (0.4, "3"),
        (0.6, "1"),
    )


def test_volume_moves_a_handle_by_keys_of_its_track():
    document = handle_commands.add_handle(0, 100 + 100j)(switched())
    layer = document.layers[0]
    talk = replace(sound(wav(spoken_signal())), name="talk")
    opened = follow_volume(inspect_sound(wav(spoken_signal()), "a"), 24.0, Response(0.0, 0.0))
    values = make_volume_values(talk, opened, 24.0)
    frames = [frame for frame, _ in values]
    assert max(value for _, value in values) > 0.95
    assert values[0][1] == values[-1][1] == 0
    assert min(np.diff(frames)) >= 3

    def put(document, start):
        keys = tuple((frame + start, -20j * value) for frame, value in values)
        made = VolumeKeys(kind="track", layer=layer.id, part=layer.handles[0].id, keys=keys)
        return sound_commands.set_volume_keys("talk", made)(document)

    document = put(document, 0)
    (track,) = document.layers[0].tracks
    assert [key.frame for key in track.keys] == frames
    channel = track_channel(layer.id, track)
    by_hand = {frames[2]: 5 + 5j, 90: 1 + 1j}
    changed = [replace(key, place=by_hand.get(key.frame, key.place)) for key in track.keys]
    edited = (*changed, replace(track.keys[-1], frame=90, place=1 + 1j))
    document = channel_commands.insert_keys({channel: edited})(document)
    document = put(document, 1)
    (track,) = document.layers[0].tracks
    places = {key.frame: key.place for key in track.keys}
    assert places[frames[2]] == 5 + 5j
    assert places[90] == 1 + 1j
    assert {*places} == {frame + 1 for frame in frames} | {frames[2], 90}
