"""What is heard leads what is shown, and no click is heard that is not in the sound."""

from dataclasses import replace

import numpy as np
import pytest
from documents import disc_document
from sound_devices import PERIOD, HandDevice
from sound_files import noise, sine, sound, wav

from app.errors import LissomError
from app.sound.mixing import SoundMix
from app.sound.player import LINGER, LOST, SoundPlayer
from app.sound.stream import PlayedRange, stream_part, stream_range

RATE = HandDevice.rate


class Hand:
    """A player on a device, and the time that both are told."""

    def __init__(self, **options: float) -> None:
        self.now = 0.0
        self.device = HandDevice(**options)
        self.player = SoundPlayer(lambda: self.now, lambda: self.device)

    def turn(self, seconds: float, step: float = 0.01) -> None:
        for _ in range(round(seconds / step)):
            self.now += step
            self.device.turn(step)


def mixed(signal: np.ndarray, rate: int = RATE, **changes) -> SoundMix:
    document = replace(disc_document(), sounds=(sound(wav(signal, rate), **changes),))
    return SoundMix(document, RATE)


def test_player_plays_the_mix_from_a_frame_on():
    hand, mix = Hand(), mixed(noise(2.0))
    hand.player.play(stream_range(mix, PlayedRange(start=6)))
    hand.turn(1.0)
    expected = mix.read(RATE // 4, RATE)
    heard = hand.device.samples
    assert np.array_equal(heard[200:], expected[200 : len(heard)])
    assert np.abs(heard[:200]).max() <= np.abs(expected[:200]).max()


@pytest.mark.parametrize("pace", [1.0, 1.002, 0.998])
def test_picture_stays_within_a_frame_of_the_sound_for_ten_minutes(pace):
    hand, mix = Hand(pace=pace), mixed(np.zeros((100, 1)))
    hand.player.play(stream_range(mix, PlayedRange(start=0)))
    worst = 0.0
    for _ in range(600):
        hand.turn(1.0, step=1 / 50)
        # What the ear hears now was asked for a latency ago.
        heard = len(hand.device.heard) * PERIOD / RATE - HandDevice.latency
        worst = max(worst, abs(hand.player.elapsed() - heard))
        hand.device.heard[:] = [hand.device.heard[0][:0]] * len(hand.device.heard)
    assert worst < 1 / 24


def test_late_requests_hold_the_picture_at_the_last_sample():
    hand, mix = Hand(), mixed(sine(2.0))
    hand.player.play(stream_range(mix, PlayedRange(start=0)))
    hand.turn(0.4)
    known = len(hand.device.heard) * PERIOD / RATE - HandDevice.latency
    hand.now += 1.0
    assert hand.player.elapsed() == pytest.approx(known)
    hand.now += LOST
    assert hand.player.elapsed() is None


@pytest.mark.parametrize("speed", [1.0, -1.0, 2.0, 0.5])
def test_loop_is_played_without_a_click(speed):
    # A second and a third of a sine does not end where it begins.
    hand, mix = Hand(), mixed(sine(3.0, pitch=100.0))
    loop = PlayedRange(start=3, speed=speed, first=3, length=32.21)
    hand.player.play(stream_range(mix, loop))
    hand.turn(6.0)
    steps = np.abs(np.diff(hand.device.samples[:, 0]))
    usual = 0.5 * 2 * np.pi * 100 * abs(speed) / RATE
    assert steps.max() < 4 * usual


def test_loop_is_exact_after_many_turns():
    mix = mixed(noise(1.0))
    length = 7.3  # frames: 14,600 samples
    stream = stream_range(mix, PlayedRange(start=0, first=0, length=length))
    heard = np.concatenate([next(stream) for _ in range(150)])
    for turn in range(1, 10):
        begin = turn * 14_600
        known = heard[begin + 300 : begin + 10_000]
        assert np.array_equal(known, mix.read(300, 9_700))


def test_start_and_stop_are_without_a_click():
    hand, mix = Hand(), mixed(np.full((RATE, 1), 0.5))
    hand.player.play(stream_range(mix, PlayedRange(start=0)))
    hand.turn(0.2)
    hand.player.stop()
    hand.turn(0.2)
    heard = hand.device.samples[:, 0]
    assert heard.max() > 0.49
    assert heard[-1] == 0
    assert np.abs(np.diff(heard)).max() < 0.01


def test_device_rests_after_a_while():
    hand, mix = Hand(), mixed(sine(1.0))
    hand.player.play(stream_part(mix, 0, 0.1))
    hand.turn(0.3)
    hand.player.rest()
    assert hand.device.is_running
    hand.turn(LINGER)
    hand.player.rest()
    assert not hand.device.is_running
    heard = hand.device.samples
    assert heard[:4_000].any()
    assert not heard[5_000:].any()


def test_missing_device_is_asked_for_once():
    asked = []

    def refuse():
        asked.append(1)
        raise LissomError("there is none")

    player = SoundPlayer(lambda: 0.0, refuse)
    for _ in range(3):
        with pytest.raises(LissomError, match="there is none"):
            player.play(iter(()))
    assert asked == [1]
    player.stop()
    player.rest()


def test_lost_device_is_given_up():
    hand, mix = Hand(), mixed(sine(1.0))
    hand.player.play(stream_range(mix, PlayedRange(start=0)))
    hand.now += 1.5 * LOST
    assert hand.player.elapsed() is None
    hand.player.lose_device("it was unplugged")
    with pytest.raises(LissomError, match="unplugged"):
        hand.player.play(iter(()))


def test_device_that_waits_for_slow_samples_is_not_lost():
    hand = Hand()

    def slow():
        hand.now += 1.5 * LOST
        assert hand.player.elapsed() == 0
        yield np.ones((PERIOD, 2), dtype=np.float32)

    with hand.player._mixing:  # the thread that mixes ahead stays out
        hand.player.play(slow())
        hand.player._feeder = None
    hand.turn(0.05)
