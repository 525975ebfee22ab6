"""Sound files are decoded as they are, whatever they say of themselves."""

import tracemalloc

import numpy as np
import pytest
from sound_files import CODECS, encoded, lag, noise, sine, sound, wav

from app.document import SoundFile
from app.errors import LissomError
from app.sound.decoder import SoundDecoder
from app.sound.inspection import PEAKS_PER_SECOND, inspect_sound


def decoded(data: bytes, name: str = "a.wav") -> np.ndarray:
    decoder = SoundDecoder(data, name)
    return decoder.read(10**6)


@pytest.mark.parametrize("bits", [16, 24])
def test_wav_keeps_every_sample_of_its_bits(bits):
    signal = noise(0.1, channels=2)
    levels = np.rint(signal * (2 ** (bits - 1) - 1))
    assert np.array_equal(decoded(wav(signal, bits=bits)), levels / 2.0 ** (bits - 1))


@pytest.mark.parametrize("kind", CODECS)
def test_formats_decode_without_a_shift_in_time(kind):
    signal = noise(0.5)
    found = decoded(encoded(kind, signal), f"a.{kind}")
    # FFmpeg leaves out the last block of Vorbis.
    assert len(found) > len(signal) - 1_024
    assert lag(found[:, 0], signal[:, 0], most=1_500) == 0


@pytest.mark.parametrize("kind", ["wav", *CODECS])
def test_seeking_reads_the_same_samples_as_reading_on(kind):
    signal = noise(1.0)
    data = wav(signal) if kind == "wav" else encoded(kind, signal)
    whole, decoder = decoded(data), SoundDecoder(data, "a")
    for first in (30_000, 100, 41_000, 20_000, 20_100):
        decoder.seek(first)
        assert np.array_equal(decoder.read(500), whole[first : first + 500])


@pytest.mark.parametrize("rate", [8_000, 11_025, 44_100, 96_000, 192_000])
@pytest.mark.parametrize("channels", [1, 2, 6])
def test_rates_and_channels_are_measured(rate, channels):
    file = inspect_sound(wav(sine(0.25, rate, channels=channels), rate), "a.wav").file
    assert (file.rate, file.channels, file.samples) == (rate, channels, rate // 4)


def test_peaks_and_loudness_follow_the_signal():
    signal = sine(1.5, 44_100)
    signal[: 44_100 // 2] = 0
    inspected = inspect_sound(wav(signal, 44_100), "a.wav")
    assert len(inspected.peaks) == len(inspected.loudness) == 1.5 * PEAKS_PER_SECOND
    assert not inspected.peaks[:100].any()
    assert abs(int(inspected.peaks[150]) - 127) <= 1
    assert abs(int(inspected.loudness[150]) - 127 / 2**0.5) <= 2


def test_wav_that_lies_about_its_length_has_its_own_length():
    true = wav(sine(0.5))
    for length in (0xFFFF_FFFF, 0x7FFF_FFFF, 1_000_000):
        lying = true[:40] + length.to_bytes(4, "little") + true[44:]
        assert inspect_sound(lying, "a.wav").file.samples == 24_000


@pytest.mark.parametrize("kind", ["wav", *CODECS])
def test_cut_off_files_keep_what_is_there(kind):
    signal = noise(2.0)
    data = wav(signal) if kind == "wav" else encoded(kind, signal)
    file = inspect_sound(data[: len(data) // 2], f"a.{kind}").file
    assert 24_000 < file.samples < 72_000


@pytest.mark.parametrize(
    ("data", "words"),
    [
        (b"", "is not a sound"),
        (b"Dear diary, today\n" * 500, "is not a sound"),
        (b"RIFF\xff\xff\xff\xffWAVEfmt ", "holds no sound that can be read"),
        (b"\xff\xfb\x90\x00" + bytes(20), "holds no sound that can be read"),
        (b"OggS" + bytes(24) + b"OpusHead" + bytes(100), "holds Opus"),
        (wav(sine(0.01, 4_000), 4_000), "4,000 samples a second"),
        (wav(sine(0.01, channels=8)), "8 channels"),
        (wav(sine(0.0)), "holds no sound that can be read"),
    ],
)
def test_what_is_no_sound_is_refused_in_one_sentence(data, words):
    with pytest.raises(LissomError, match=words) as raised:
        inspect_sound(data, "diary.wav")
    assert "diary.wav" in str(raised.value)
    assert "\n" not in str(raised.value)


def test_damaged_bytes_never_end_the_program():
    random = np.random.default_rng(3)
    for kind in ("wav", *CODECS):
        data = wav(noise(0.2)) if kind == "wav" else encoded(kind, noise(0.2))
        for _ in range(8):
            damaged = bytearray(data)
            for place in random.integers(0, len(data), 12):
                damaged[place] = random.integers(256)
            try:
                inspected = inspect_sound(bytes(damaged), "a")
            except LissomError:
                continue
            assert isinstance(inspected.file, SoundFile)


def test_memory_stays_small_for_a_long_sound():
    # Twenty minutes of silence, as FLAC packs it.
    data = encoded("flac", np.zeros((8_000 * 1_200, 1)), 8_000)
    tracemalloc.start()
    inspected = inspect_sound(data, "long.flac")
    _, most = tracemalloc.get_traced_memory()
    tracemalloc.stop()
    assert inspected.file.seconds == 1_200
    assert most < 5_000_000  # its samples take 38 MB


def test_sound_is_named_after_its_file():
    assert sound(wav(sine(0.1)), "hello.there.wav").name == "hello.there"
