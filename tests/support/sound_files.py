"""Drawn signals as sound files, and sounds of them."""

import io
import struct
from math import pi

import av
import numpy as np
import numpy.typing as npt

from app.document import Sound
from app.sound import inspect_sound, new_sound

Signal = npt.NDArray[np.float64]  # (n, channels), from −1 to 1
CODECS = {"flac": ("flac", {}), "mp3": ("libmp3lame", {}), "ogg": ("vorbis", {"strict": "-2"})}


def sine(seconds: float, rate: int = 48_000, *, pitch: float = 440.0, channels: int = 1) -> Signal:
    """A sine of half the full level, each channel an octave above the one before."""
    times = np.arange(round(seconds * rate)) / rate
    waves = [0.5 * np.sin(2 * pi * pitch * 2**octave * times) for octave in range(channels)]
    return np.stack(waves, axis=1)


def clicks(seconds: float, rate: int = 48_000, *, at: tuple[float, ...] = ()) -> Signal:
    """Silence with single samples of nearly the full level at these seconds."""
    signal = np.zeros((round(seconds * rate), 1))
    for second in at:
        signal[round(second * rate)] = 0.875
    return signal


def noise(seconds: float, rate: int = 48_000, *, channels: int = 1, seed: int = 0) -> Signal:
    """Soft noise without its highest pitches, which lossy formats leave out."""
    rough = np.random.default_rng(seed).standard_normal((round(seconds * rate), channels))
    smooth = [np.convolve(each, np.ones(12) / 12, "same") for each in rough.T]
    return 0.3 * np.stack(smooth, axis=1)


def wav(signal: Signal, rate: int = 48_000, *, bits: int = 16) -> bytes:
    """A WAV file of whole numbers of 16 or 24 bits."""
    levels = np.rint(np.clip(signal, -1, 1) * (2 ** (bits - 1) - 1)).astype("<i4")
    data = levels.reshape(-1, 1).view(np.uint8)[:, : bits // 8].tobytes()
    channels = signal.shape[1]
    block = channels * bits // 8
    form = struct.pack("<HHIIHH", 1, channels, rate, rate * block, block, bits)
    body = b"WAVE" + b"fmt " + struct.pack("<I", len(form)) + form
    body += b"data" + struct.pack("<I", len(data)) + data
    return b"RIFF" + struct.pack("<I", len(body)) + body


def encoded(kind: str, signal: Signal, rate: int = 48_000) -> bytes:
    """A file in one of `CODECS`, of one or two channels."""
    name, options = CODECS[kind]
    # FFmpeg's own Vorbis knows two channels only.
    given = np.repeat(signal, 2, axis=1) if kind == "ogg" and signal.shape[1] == 1 else signal
    layout = ("mono", "stereo")[given.shape[1] - 1]
    file = io.BytesIO()
    with av.open(file, "w", format=kind) as container:
        stream = container.add_stream(name, rate=rate, layout=layout, options=options)
        planes = np.ascontiguousarray(given.T.astype(np.float32))
        frame = av.AudioFrame.from_ndarray(planes, format="fltp", layout=layout)
        frame.sample_rate = rate
        resampler = av.AudioResampler(format=stream.format, layout=layout, rate=rate)
        for part in (*resampler.resample(frame), *resampler.resample(None)):
            container.mux(stream.encode(part))
        container.mux(stream.encode(None))
    return file.getvalue()


def sound(data: bytes, name: str = "talk.wav", *, start: float = 0.0) -> Sound:
    """The whole of a file as a sound."""
    return new_sound(inspect_sound(data, name), start)


def lag(heard: npt.NDArray[np.float32], expected: Signal, *, most: int = 3_000) -> int:
    """By how many samples a signal comes later than expected, by the best fit."""
    middle = slice(most, min(len(heard), len(expected)) - most)
    part = expected[middle].astype(np.float64)
    fits = [
        float(part @ heard[middle.start + by : middle.stop + by]) for by in range(-most, most + 1)
    ]
    return int(np.argmax(fits)) - most
