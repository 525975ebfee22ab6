"""Springs swing as the differential equation says, come round in loops, and end."""

from itertools import pairwise

import numpy as np
import pytest
from numpy.testing import assert_allclose, assert_array_equal
from scipy.integrate import solve_ivp

from app.rigging import FADE_FRAMES, find_spring_frequency, simulate_spring, turn_arm
from app.rigging.kinematics.oscillator import oscillator_flow
from app.rigging.kinematics.springs import INVISIBLE, WIDEST
from engine.errors import EngineError

DAMPINGS = [0.0, 1e-9, 0.2, 1 - 1e-9, 1.0, 1 + 1e-9, 1.7, 100.0]


def walk(count, *, seed=0):
    """Where a place is at some frames, of which no two changes of velocity are alike."""
    rng = np.random.default_rng(seed)
    return np.cumsum(rng.normal(0, 20, (count, 2)) @ [1, 1j])


def circle(count):
    """A round of a circle, of which the last frame is the first one again."""
    return 100 * np.exp(2j * np.pi * np.arange(count + 1) / count)


def integrated(q, fps, frequency, damping, times):
    """Return y − q with ÿ = −2ζω(ẏ − q̇) − ω²(y − q), from rest, without a word of impulses."""
    omega, found = 2 * np.pi * frequency, np.zeros(len(times), complex)
    state = np.array([q[0], 0])
    for frame, (here, there) in enumerate(pairwise(q)):
        pace = (there - here) * fps

        def rate(t, s, here=here, pace=pace):
            y, velocity = s
            pull = -2 * damping * omega * (velocity - pace) - omega**2 * (y - here - pace * t)
            return np.array([velocity, pull])

        within = (times >= frame) & (times < frame + 1)
        at = np.append(times[within] - frame, 1.0) / fps
        run = solve_ivp(
            rate, (0, 1 / fps), state, method="DOP853", t_eval=at, rtol=1e-12, atol=1e-10
        )
        found[within] = run.y[0, :-1] - here - pace * at[:-1]
        state = run.y[:, -1]
    return found


@pytest.mark.parametrize("damping", [0.0, 0.18, 0.999_999, 1.0, 1.000_001, 3.0])
@pytest.mark.parametrize("frequency", [0.05, 1.6, 20.0])
def test_a_swing_is_that_of_the_differential_equation(frequency, damping):
    q, times = walk(10), np.sort(np.random.default_rng(1).uniform(0, 9, 60))
    found = simulate_spring(q, 24, frequency=frequency, damping=damping).at(times)
    expected = integrated(q, 24, frequency, damping, times)
    assert np.abs(expected).max() > 1
    assert_allclose(found, expected, rtol=0, atol=1e-6)


@pytest.mark.parametrize("damping", DAMPINGS)
def test_flows_follow_each_other_as_one_and_never_grow(damping):
    rng = np.random.default_rng(2)
    first, second = rng.exponential(3, (2, 50))
    flows = oscillator_flow(first, damping), oscillator_flow(second, damping)
    assert_allclose(
        flows[0] @ flows[1], oscillator_flow(first + second, damping), rtol=0, atol=1e-12
    )
    assert np.linalg.norm(flows[0], 2, axis=(1, 2)).max() <= 1 + 1e-13
    # (o, ȯ/ω) changes by ωh (ȯ/ω, −o − 2ζ ȯ/ω).
    little = oscillator_flow(np.array(1e-7), damping) - np.eye(2)
    assert_allclose(little / 1e-7, [[0, 1], [-1, -2 * damping]], rtol=1e-4, atol=1e-6)


def test_nothing_jumps_where_damping_becomes_critical():
    angles = np.linspace(0, 30, 31)
    for less, more in ((1 - 1e-12, 1), (1, 1 + 1e-12), (1 - 1e-7, 1 + 1e-7)):
        assert_allclose(
            oscillator_flow(angles, less),
            oscillator_flow(angles, more),
            rtol=0,
            atol=1e-5 * (more - less > 1e-9) + 1e-11,
        )


@pytest.mark.parametrize("damping", [*DAMPINGS[2:], 1e-3])
@pytest.mark.parametrize("frequency", [1e-3, 3.0, 1000.0])
@pytest.mark.parametrize("loop", [False, True])
def test_nothing_overflows(frequency, damping, loop):
    q = circle(48)
    times = np.linspace(0, 48, 500)
    offsets = simulate_spring(q, 24, frequency=frequency, damping=damping, loop=loop).at(times)
    assert np.isfinite(offsets).all()
    # A driven swing is at most so much larger than its drive.
    assert np.abs(offsets).max() < 1e3 * np.abs(q).max()


@pytest.mark.parametrize("damping", [0.01, 0.25, 1.0, 4.0])
@pytest.mark.parametrize("count", [1, 2, 7, 48])
def test_a_loop_closes(damping, count):
    q = walk(count + 1, seed=3)
    q[-1] = q[0]
    spring = simulate_spring(q, 24, frequency=1.6, damping=damping, loop=True)
    first, last = spring.states[0], spring.states[-1]
    # Where the last frame leads to is where the first one begins, before its own impulse.
    jump = (q[1] - q[0] - (q[-1] - q[-2])) / spring.angle
    reached = oscillator_flow(np.array(spring.angle), damping) @ last
    assert_allclose(reached - [0, jump], first, rtol=0, atol=1e-12 * max(1, np.abs(q).max()))
    times = np.linspace(0, count, 37)
    assert_allclose(spring.at(times + 5 * count), spring.at(times), rtol=0, atol=1e-9)
    assert_allclose(spring.at(times - 3 * count), spring.at(times), rtol=0, atol=1e-9)


def test_a_loop_is_where_many_rounds_from_rest_lead_to():
    q = walk(24, seed=4)
    q = np.append(q, q[0])
    rounds = np.append(np.tile(q[:-1], 30), q[0])
    times = np.linspace(0, 24, 100)
    loop = simulate_spring(q, 24, frequency=2, damping=0.2, loop=True).at(times)
    long = simulate_spring(rounds, 24, frequency=2, damping=0.2).at(29 * 24 + times)
    assert_allclose(loop, long, rtol=0, atol=1e-9)


def test_every_frame_rate_sees_one_motion():
    q = walk(49, seed=5)
    spring = simulate_spring(q, 24, frequency=3, damping=0.25, lag=1.3)
    seconds = {fps: np.arange(2 * fps + 1) / fps for fps in (24, 25, 60)}
    fine = np.unique(np.concatenate(list(seconds.values())))
    known = dict(zip(fine, spring.at(24 * fine), strict=True))
    for times in seconds.values():
        assert_array_equal(spring.at(24 * times), [known[time] for time in times])
    # Also in any order, one at a time, and in any shape.
    assert_array_equal([spring.at(24 * time) for time in fine[::-1]], spring.at(24 * fine)[::-1])
    assert_array_equal(spring.at(np.ones((2, 3))), np.full((2, 3), spring.at(1.0)))


@pytest.mark.parametrize("loop", [False, True])
def test_lag_shifts_all_of_it_in_time(loop):
    q = circle(24)
    prompt, late = (
        simulate_spring(q, 24, frequency=2, damping=0.3, lag=lag, loop=loop) for lag in (0, 2.75)
    )
    times = np.linspace(3, 24, 50)
    assert_allclose(late.at(times), prompt.at(times - 2.75), rtol=0, atol=1e-12)
    if not loop:
        assert not late.at(np.linspace(0, 2.75, 5)).any()


def still_after(q, count):
    return np.append(q, np.full(count, q[-1]))


@pytest.mark.parametrize("loop", [False, True])
def test_a_swing_ends_in_a_fade_and_is_nothing_until_the_base_moves_again(loop):
    there = still_after(100 * np.linspace(0, 1, 6) ** 2 * (1 + 1j), 120)
    q = np.concatenate([there, still_after(there[::-1][120:], 150)])
    spring = simulate_spring(q, 24, frequency=2, damping=0.2, loop=loop)
    times = np.linspace(0, len(q) - 1, 20 * (len(q) - 1) + 1)
    offsets = spring.at(times)
    resting = (offsets == 0) & (times > 0)
    moved = times[np.flatnonzero(np.diff(resting.astype(int)))]
    ended, again = moved[0], len(there)  # the first frame of the way back moves from there on
    assert 30 < ended < again - 20
    assert resting[(times > ended + 0.1) & (times <= again)].all()
    assert not resting[(times > again + 0.1) & (times < again + 20)].any()
    assert np.abs(offsets[(times > ended - FADE_FRAMES) & (times < again)]).max() < INVISIBLE
    assert np.abs(offsets[(times < ended - FADE_FRAMES - 30)]).max() > 10
    assert resting[-100:].all()
    # The fade begins and ends at whole frames, and nothing kinks in it.
    assert ended == pytest.approx(round(ended), abs=0.11)
    fades = (times > ended - FADE_FRAMES - 2) & (times < ended + 2)
    slopes = np.gradient(offsets[fades], times[1])
    assert np.abs(np.diff(slopes)).max() < 0.02 * np.abs(slopes).max() + 2e-4


@pytest.mark.parametrize(
    ("still", "radius", "damping", "fades"),
    [
        (42, 30, 0.3, False),
        (44, 30, 0.3, True),
        (60, 30, 0.3, True),
        # It is quiet enough as it comes round, and would not be if it set out from rest.
        (20, 0.1, 0.27381, False),
    ],
)
def test_where_a_loop_begins_is_no_matter(still, radius, damping, fades):
    """Also where it fades round its end, or is about to when it moves again."""
    q = np.append(radius * np.exp(2j * np.pi * np.arange(8) / 8), np.full(still, radius))
    count = len(q)
    times = np.linspace(0, count, 12 * count + 1)
    settings = {"frequency": 3, "damping": damping, "loop": True}
    spring = simulate_spring(np.append(q, q[0]), 24, **settings)
    assert (spring.fading >= 0).any() == fades
    whole = np.arange(count)
    assert_allclose(spring.at(whole - 1e-9), spring.at(whole), rtol=0, atol=1e-6)
    offsets = spring.at(times)
    for shift in range(1, count):
        moved = np.roll(q, shift)
        shifted = simulate_spring(np.append(moved, moved[0]), 24, **settings).at(times + shift)
        assert_allclose(shifted, offsets, rtol=0, atol=1e-12)


def test_zeros_of_a_swing_do_not_end_it():
    # It sets out once, so that the offset is 0 every half of a second's swing of 12 frames.
    spring = simulate_spring(10.0 * np.arange(61), 24, frequency=2, damping=0.0)
    assert_allclose(spring.at(np.arange(0, 61, 6)), 0, rtol=0, atol=1e-12)
    assert_allclose(np.abs(spring.at(np.arange(3, 61, 6))), 60 / np.pi, rtol=1e-12)


def test_a_base_that_moves_on_within_the_fade_lets_it_swing_on():
    q = still_after(np.array([0, 100.0]), 100)
    quiet = simulate_spring(q, 24, frequency=2, damping=0.2)
    ended = int(np.flatnonzero(~quiet.states.any(axis=1))[1])
    disturbed = q.copy()
    disturbed[ended - 2 :] += 1
    spring = simulate_spring(disturbed, 24, frequency=2, damping=0.2)
    assert (spring.fading[: ended - 2] < 0).all()
    assert np.abs(spring.at(ended - 2.5)) > 0


@pytest.mark.parametrize("loop", [False, True])
@pytest.mark.parametrize("damping", [0.2, 1.0])
def test_a_base_at_rest_or_at_one_pace_leaves_exactly_nothing(loop, damping):
    times = np.linspace(0, 30, 301)
    rng = np.random.default_rng(6)
    rest = 700 + 300j + 1e-13 * rng.normal(size=31)  # but for rounding
    assert not simulate_spring(rest, 24, frequency=2, damping=damping, loop=loop).at(times).any()
    assert not simulate_spring([5j], 24, frequency=2, damping=damping, loop=loop).at(times).any()
    if loop:
        pace = 3 * np.arange(31)
        assert (
            not simulate_spring(pace, 24, frequency=2, damping=damping, loop=True).at(times).any()
        )


@pytest.mark.parametrize("loop", [False, True])
def test_it_moves_and_turns_with_the_world_and_grows_with_its_strength(loop):
    q, times = walk(25, seed=7), np.linspace(0, 24, 200)
    q[-1] = q[0]
    settings = {"frequency": 2.0, "damping": 0.3, "loop": loop}
    offsets = simulate_spring(q, 24, **settings).at(times)
    turned = simulate_spring(np.exp(1j) * q + 70 - 20j, 24, **settings).at(times)
    assert_allclose(turned, np.exp(1j) * offsets, rtol=0, atol=1e-10)
    assert_allclose(
        simulate_spring(q, 24, strength=2.5, **settings).at(times), 2.5 * offsets, rtol=1e-12
    )
    assert not simulate_spring(q, 24, strength=0, **settings).at(times).any()


def test_a_limit_is_soft_and_never_reached():
    q, times = walk(25, seed=8), np.linspace(0, 24, 400)
    free, held = (
        simulate_spring(q, 24, frequency=2, damping=0.1, limit=limit).at(times)
        for limit in (np.inf, 12)
    )
    assert np.abs(free).max() > 24
    assert 10 < np.abs(held).max() < 12
    assert_allclose(held, free / np.sqrt(1 + np.abs(free / 12) ** 2), rtol=1e-12)


def test_what_drives_an_arm_is_what_is_across_it():
    """Where the arm does not turn that is a part of what moves its end freely."""
    q, times, arm = walk(25, seed=9), np.linspace(0, 24, 100), 3 + 40j
    settings = {"frequency": 2, "damping": 0.3}
    arcs = simulate_spring(q, 24, roots=q - arm, **settings).at(times)
    free = simulate_spring(q, 24, **settings).at(times)
    assert_allclose(arcs, (free * np.conj(arm)).imag / abs(arm), rtol=0, atol=1e-9)
    assert np.abs(arcs).max() > 1


def test_an_arm_swings_in_axes_that_turn_with_it():
    """It obeys the equation of its angle, and not where it was when it was driven."""
    fps, frequency, damping, count = 480, 2.0, 0.2, 480
    seconds = np.arange(count + 1) / fps
    turn = 3 * np.sin(np.pi * seconds) ** 4
    found = simulate_spring(
        80 * np.exp(1j * turn), fps, frequency=frequency, damping=damping, roots=0 * turn
    ).at(np.arange(count + 1))
    omega = 2 * np.pi * frequency
    driving = np.gradient(np.gradient(turn, 1 / fps), 1 / fps)

    def slope(time, state):
        angle, pace = state
        drive = np.interp(time, seconds, driving)
        return [pace, -drive - 2 * damping * omega * pace - omega**2 * angle]

    exact = solve_ivp(slope, (0, 1), [0, 0], t_eval=seconds, max_step=1 / fps, rtol=1e-8).y[0]
    assert_allclose(found / 80, exact, rtol=0, atol=0.01 * np.abs(exact).max())


def test_an_arm_that_turns_at_one_pace_does_not_swing():
    q = 50 * np.exp(2j * np.pi * np.arange(31) / 30)
    settings = {"frequency": 2.0, "damping": 0.2, "loop": True}
    assert (
        not simulate_spring(10 + q, 24, roots=np.full(31, 10), **settings).at(np.arange(30)).any()
    )
    assert np.abs(simulate_spring(10 + q, 24, **settings).at(np.arange(30))).min() > 1
    # Nor one that has no length.
    assert not simulate_spring(q, 24, roots=q, **settings).at(np.arange(30)).any()


@pytest.mark.parametrize("arc", [-1e6, -3.0, 0.0, 1e-9, 20.0, 1e6])
def test_a_turned_arm_keeps_its_length_and_turns_so_far_at_most(arc):
    arm = 30 - 40j
    end = arm + turn_arm(arm, arc)
    assert abs(end) == pytest.approx(50, abs=1e-10)
    assert abs(np.angle(end / arm)) <= WIDEST + 1e-9
    assert np.sign(np.angle(end / arm).round(15)) == np.sign(arc)
    assert turn_arm(0j, arc) == 0


@pytest.mark.parametrize(
    ("changes", "words"),
    [
        ({"damping": 0.0, "loop": True}, "without damping .* loop"),
        ({"damping": 1e-15, "frequency": 24.0, "loop": True}, "too little damping to come round"),
        ({"damping": np.nan}, "damping .* nan"),
        ({"damping": -0.1}, "damping .* -0.1"),
        ({"frequency": 0}, "frequency .* above 0, not 0"),
        ({"frequency": np.inf}, "not inf"),
        ({"fps": np.nan}, "frames per second"),
        ({"lag": -1}, "lag .* -1"),
        ({"lag": np.inf}, "lag .* inf"),
        ({"strength": np.nan}, "strength"),
        ({"limit": 0.0}, "limit"),
        ({"places": [0, np.nan, 1]}, "entry 1"),
        ({"places": []}, "at least 1"),
    ],
)
def test_what_no_spring_can_do_is_refused_in_words(changes, words):
    given = {"places": circle(24), "fps": 24.0, "frequency": 2.0, "damping": 0.2} | changes
    with pytest.raises(EngineError, match=words):
        simulate_spring(**given)


def test_a_time_that_is_no_time_is_refused():
    with pytest.raises(EngineError, match="must be finite"):
        simulate_spring(circle(24), 24, frequency=2, damping=0.2).at([1.0, np.nan])


@pytest.mark.parametrize("damping", [0.35, 0.5])
@pytest.mark.parametrize("delay", [0.02, 0.125, 0.2])
def test_spring_of_a_delay_is_so_late_in_a_steady_swing(delay, damping):
    count, swings = 2400, 2
    base = 100 * np.exp(2j * np.pi * swings * np.arange(count + 1) / count)
    frequency = find_spring_frequency(swings * 1.0, delay, damping)
    response = simulate_spring(base, count, frequency=frequency, damping=damping, loop=True)
    followed = base + response.at(np.arange(count + 1))
    assert_allclose(np.angle(followed / base), -2 * np.pi * delay, atol=0.01)
    assert_allclose(followed[-1], followed[0], rtol=1e-12)


def test_spring_cannot_be_late_by_half_a_period():
    with pytest.raises(EngineError, match=r"cannot be later by 0\.5"):
        find_spring_frequency(1.0, 0.5, 0.35)
    with pytest.raises(EngineError, match="cannot be later by 0 "):
        find_spring_frequency(1.0, 0.0, 0.35)
