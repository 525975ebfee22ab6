"""The mix of sounds is exact to the sample, wherever it is read."""

from dataclasses import replace

import numpy as np
import pytest
from documents import disc_document
from sound_files import clicks, encoded, noise, sine, sound, wav

from app.document import VOLUME, Channel, Document, channel_commands, scene_commands, sound_commands
from app.sound import SoundMix, common_rate
from app.sound.decoder import SoundDecoder

RATE = 48_000


def with_sounds(*sounds, **changes) -> Document:
    return replace(disc_document(), sounds=sounds, **changes)


def levels(signal: np.ndarray) -> np.ndarray:
    return np.rint(signal * 32_767) / 32_768


def test_mix_begins_at_the_sound_and_ends_with_it():
    signal = noise(0.5, channels=2)
    document = with_sounds(sound(wav(signal), start=12))
    heard = SoundMix(document, RATE).read(0, 2 * RATE)
    assert np.array_equal(heard[RATE // 2 : RATE], levels(signal).astype(np.float32))
    assert not heard[: RATE // 2].any()
    assert not heard[RATE:].any()


def test_mix_is_the_same_in_blocks_and_backwards():
    mix = SoundMix(with_sounds(sound(wav(noise(0.4, 44_100), 44_100), start=-2.5)), RATE)
    whole = mix.read(-5_000, 20_480)
    for first in range(20_480 - 1_024, -1, -1_024):
        assert np.array_equal(mix.read(first - 5_000, 1_024), whole[first : first + 1_024])


@pytest.mark.parametrize("rate", [8_000, 44_100, 47_999, 96_000, 192_000])
def test_other_rates_keep_their_place(rate):
    document = with_sounds(sound(wav(sine(0.4, rate), rate), start=6))
    heard = SoundMix(document, RATE).read(12_000, 19_200)
    expected = levels(sine(0.4))
    assert np.abs(heard[1_000:-1_000] - expected[1_000:-1_000]).max() < 3e-4


def test_cut_sound_leaves_what_remains_at_its_frame():
    data = wav(clicks(2.0, at=(0.5, 1.0, 1.5)))
    document = with_sounds(sound(data))
    document = sound_commands.cut_sound("talk", 0.75, 0.5)(document)
    heard = np.flatnonzero(SoundMix(document, RATE).read(0, 2 * RATE)[:, 0])
    assert heard.tolist() == [RATE]
    assert (document.sounds[0].start, document.sounds[0].end(24)) == (18, 30)


def test_volume_keys_fade_evenly():
    document = with_sounds(sound(wav(np.full((RATE, 1), 0.5))))
    channel = Channel(VOLUME, part="talk")
    for frame, volume in ((0, 0.0), (12, 1.0)):
        document = channel_commands.set_key(channel, frame, volume)(document)
    heard = SoundMix(document, RATE).read(0, RATE)[:, 0]
    expected = levels(np.array([0.5]))[0] * np.minimum(np.arange(RATE) / (RATE / 2), 1)
    assert np.abs(heard - expected).max() < 1e-6


def test_muted_and_missing_sounds_are_silent():
    one = sound(wav(sine(0.2)))
    muted = replace(one, muted=True)
    missing = replace(one, file=replace(one.file, data=None))
    for each in (muted, missing):
        mix = SoundMix(with_sounds(each), RATE)
        assert not mix.read(0, 1_000).any()


def test_sounds_add_up():
    document = sound_commands.add_sound(sound(wav(sine(0.2)), start=1))(
        with_sounds(sound(wav(sine(0.2))))
    )
    assert [each.name for each in document.sounds] == ["talk", "talk 2"]
    heard = SoundMix(document, RATE).read(0, 9_000)[:, 0]
    signal = levels(sine(0.2))[:9_000, 0]
    signal[2_000:] += signal[:-2_000].copy()
    assert np.abs(heard - signal).max() < 1e-6


def test_rate_of_most_sounds_is_the_rate_of_the_mix():
    sounds = [sound(wav(sine(0.1, rate), rate)) for rate in (44_100, 8_000, 44_100)]
    assert common_rate(sounds) == 44_100
    assert common_rate(()) == 48_000


def test_scaled_time_moves_sounds_without_stretching_them():
    document = with_sounds(sound(wav(sine(0.5)), start=10.5))
    scaled = scene_commands.scale_time(2.0)(document).sounds[0]
    assert (scaled.start, scaled.length) == (21.0, 0.5)


def test_reading_on_decodes_each_sample_once(monkeypatch):
    decoded = []
    read = SoundDecoder.read

    def counted(self, count):
        found = read(self, count)
        decoded.append(len(found))
        return found

    # Blocks of another rate overlap.
    mix = SoundMix(with_sounds(sound(encoded("mp3", noise(2.0, 44_100), 44_100), "a.mp3")), RATE)
    monkeypatch.setattr(SoundDecoder, "read", counted)
    for first in range(0, 2 * RATE, 1_024):
        mix.read(first, 1_024)
    assert sum(decoded) <= 2 * 44_100
