"""Springs: a place that follows another place late, and swings about it."""

from dataclasses import dataclass
from math import hypot
from typing import NamedTuple

import numpy as np
import numpy.typing as npt

from app.rigging.kinematics.oscillator import oscillator_flow
from engine.arrays import Complexes, Floats, Indices, as_number, as_points, freeze
from engine.errors import EngineError

FARTHEST = 1e100  # pixels: the squares of larger values overflow
INVISIBLE = 0.01  # pixels: a smaller swing is invisible, and ends
FADE_FRAMES = 6  # frames in which it fades out
# Swing in pixels caused by a jump of the base's velocity: smaller jumps are rounding errors.
NEGLIGIBLE_DRIVE = 1e-9
SETTLED_SHARE = 1e-12  # share of a swing that is left when it has settled
LONGEST = 2**20  # frames in which a spring may settle
CLOSED = 1e-12  # smallest singular value of a solvable equation of a loop
WIDEST = np.pi / 2  # largest rotation of an arm to one side, in radians


@dataclass(frozen=True, slots=True, kw_only=True, eq=False)
class SpringResponse:
    """Offsets of a spring's place from its base, at any time; made by `simulate_spring`.

    Parameters
    ----------
    angle : float
        ω/fps, the phase that a swing without damping advances in a frame, in radians.
    damping : float
        ζ; 1 is critical.
    lag : float
        Delay in frames.
    limit : float
        Pixels that the offset never reaches.
    loop : bool
        Whether it repeats after as many frames as there are states.
    states : complex128, shape (n, 2)
        o and ȯ/ω right after each frame, in pixels.
    fading : float64, shape (n,)
        Finished part of the fade at each frame; negative without a fade.
    """

    angle: float
    damping: float
    lag: float
    limit: float
    loop: bool
    states: Complexes
    fading: Floats

    def at(self, times: npt.ArrayLike) -> Complexes:
        """Return the offsets at times.

        Parameters
        ----------
        times : array_like of float
            In frames from the first place on, of any shape, not rounded: the exact flow leads there
            from the frame before. Before the first frame the offset is 0; after the last frame it
            stays the same. In a loop times repeat.

        Returns
        -------
        complex128, of the shape of `times`
            Pixels along the axes of the world; exactly 0 at rest.

        Raises
        ------
        EngineError
            If a time is not finite.
        """
        asked = np.asarray(times, dtype=np.float64)
        if not np.isfinite(asked).all():
            raise EngineError("The time of a spring must be finite.")
        time, last = asked - self.lag, len(self.states) - 1
        time = time % (last + 1) if self.loop else np.clip(time, 0.0, last)
        frames = np.minimum(time.astype(np.intp), last)
        since = time - frames
        place, velocity = np.moveaxis(self.states[frames], -1, 0)
        row = oscillator_flow(self.angle * since, self.damping)[..., 0, :]
        fading = self.fading[frames]
        over = np.where(fading < 0, 0.0, np.minimum(fading + since / FADE_FRAMES, 1.0))
        offsets = (row[..., 0] * place + row[..., 1] * velocity) * (1 + 2 * over) * (1 - over) ** 2
        limited: Complexes = offsets / np.sqrt(1 + (np.abs(offsets) / self.limit) ** 2)
        return limited


def simulate_spring(
    places: npt.ArrayLike,
    fps: float,
    *,
    frequency: float,
    damping: float,
    lag: float = 0.0,
    strength: float = 1.0,
    limit: float = np.inf,
    loop: bool = False,
    roots: npt.ArrayLike | None = None,
) -> SpringResponse:
    """Return the swing of a spring about a place whose motion drives it.

    Parameters
    ----------
    places : array_like of complex, shape (n,)
        q, the place at n ≥ 1 consecutive frames, in pixels of the world. In a loop the last frame
        is the first one again.
    fps : float
        Frames a second, above 0.
    frequency : float
        Of the swing without damping, in Hz, above 0.
    damping : float
        ζ, 0 or more: 1 is critical, above it nothing overshoots. In a loop it is above 0.
    lag : float
        Delay in frames, 0 or more, also fractional; in a loop it is cyclic.
    strength : float
        Factor of the offsets.
    limit : float
        Pixels, above 0. Offsets o become o/√(1 + |o/limit|²), so that they stay below it.
    loop : bool
        Whether the motion repeats.
    roots : array_like of complex, shape (n,), optional
        r, the root at these frames. With it the spring rotates the arm from the root to the place,
        q − r, and the response returns arcs: see `turn_arm`.

    Raises
    ------
    EngineError
        If a value is not finite or out of its range, or if a loop has no damping.

    Notes
    -----
    The offset o obeys ö + 2ζωȯ + ω²o = −q̈. Between frames q is linear, so that q̈ is an impulse at
    each frame, where ȯ jumps by −Δq̇; between frames the exact flow of the free oscillator applies.
    So every frame rate of an export shows one motion. q stands still before its first frame, and
    the spring is at rest there. So a sudden start of q does not move the offset at once.

    In a loop it is the periodic motion, s = (I − Mᴺ)⁻¹c, with the flow M of a frame and the state c
    after one round from rest.

    An arm's angle φ obeys φ̈ + 2ζωφ̇ + ω²φ = −Im(q̈ ē)/L, with its length L and its direction e:
    the part of −q̈ across the arm, in axes that rotate with it. The arc o = Lφ is computed in place
    of φ.

    The amplitude √(|o|² + |ȯ/ω|²) never grows by itself. A swing ends where it is below `INVISIBLE`
    and no jump drives it for `FADE_FRAMES`: in these frames it fades by a cubic, and is exactly 0
    until q's velocity changes again. The cost, some microseconds a frame, is paid once.
    """
    q = as_points(places, "The positions that drive a spring", at_least=1, most=FARTHEST)
    fps = as_number(fps, "The frames per second of a spring", above=0)
    frequency = as_number(frequency, "The frequency of a spring, in Hz,", above=0)
    damping = as_number(damping, "The damping of a spring", least=0)
    lag = as_number(lag, "The lag of a spring", least=0)
    strength = as_number(strength, "The strength of a spring")
    if limit != np.inf:
        limit = as_number(limit, "The limit of a spring, in pixels,", above=0)
    _require(
        not loop or damping > 0,
        "A spring without damping swings on forever and never comes round in a loop; give it some.",
    )
    angle = 2 * np.pi * frequency / fps
    jumps = _jumps(q, loop=loop) * (strength / angle)
    if roots is not None:
        jumps = _across(
            jumps, q - as_points(roots, "The roots of a spring", at_least=len(q), most=FARTHEST)
        )
    jumps[np.abs(jumps) <= NEGLIGIBLE_DRIVE] = 0
    step = oscillator_flow(np.array(angle), damping)
    run = _round(jumps, step) if loop else _run(jumps, step, _until_next(jumps))
    return SpringResponse(
        angle=angle,
        damping=damping,
        lag=lag,
        limit=limit,
        loop=loop,
        states=freeze(run.states),
        fading=freeze(run.fading),
    )


def turn_arm(arm: complex, arc: float) -> complex:
    """Return the displacement in pixels of an arm's end that moves by an arc about the root.

    The arm keeps its length, and its angle φ = arc/length becomes φ/√(1 + (φ/`WIDEST`)²).
    """
    length = abs(arm)
    angle = arc / length if length else 0.0
    return arm * complex(np.expm1(1j * angle / hypot(1.0, angle / WIDEST)))


def frames_to_settle(fps: float, frequency: float, damping: float) -> float:
    """Return the frames until a free swing has decayed to `SETTLED_SHARE`; ∞ if it never does.

    The norm of the flow never grows, so the swing stays below.
    """
    frames = np.ceil(np.geomspace(1, LONGEST, 200))
    left = np.linalg.norm(
        oscillator_flow(2 * np.pi * frequency / fps * frames, damping), 2, axis=(1, 2)
    )
    return float(np.append(frames[left < SETTLED_SHARE], np.inf)[0])


class _Run(NamedTuple):
    """The states after each frame, the finished part of fades, and the last state."""

    states: Complexes
    fading: Floats
    end: Complexes


def _run(
    jumps: Complexes, step: Floats, until_next: Indices, start: tuple[complex, complex] = (0j, 0j)
) -> _Run:
    """Run through frames with jumps (n,) of q̇/ω.

    `until_next` counts the frames from each one to the next jump.
    """
    (a, b), (c, d) = step.tolist()
    o, v = start
    over, states, fading = -1, [], []
    for jump, calm in zip(jumps.tolist(), until_next.tolist(), strict=True):
        v -= jump
        if over < 0 and calm >= FADE_FRAMES and 0 < hypot(abs(o), abs(v)) < INVISIBLE:
            over = 0
        states.append((o, v))
        fading.append(over / FADE_FRAMES)
        o, v = a * o + b * v, c * o + d * v
        if over >= 0:
            over += 1
        if over == FADE_FRAMES:
            o, v, over = 0j, 0j, -1
    return _Run(np.array(states), np.array(fading), np.array([o, v]))


def _round(jumps: Complexes, step: Floats) -> _Run:
    """Run once around a loop, periodically."""
    until_next = _until_next(jumps, again=True)

    def rolled(first: int, until_next: Indices, start: tuple[complex, complex] = (0j, 0j)) -> _Run:
        run = _run(np.roll(jumps, -first), step, np.roll(until_next, -first), start)
        return _Run(np.roll(run.states, first, axis=0), np.roll(run.fading, first), run.end)

    # No fade continues across a jump.
    first, never = int(np.argmax(jumps != 0)), np.zeros_like(until_next)
    left = np.eye(2) - np.linalg.matrix_power(step, len(jumps))
    _require(
        np.linalg.norm(left, -2) > CLOSED,
        "This spring has too little damping to come round in a loop; give it more.",
    )
    start = tuple(np.linalg.solve(left, rolled(first, never).end).tolist())
    plain = rolled(first, never, start)
    fades = np.roll(rolled(first, until_next, start).fading >= 0, -first)
    if not fades.any():
        return plain
    # From rest at the first jump after a fade, if a round leads to rest there again.
    faded = (first + int(fades.argmax())) % len(jumps)
    run = rolled((faded + int(until_next[faded])) % len(jumps), until_next)
    return plain if run.end.any() else run


def _jumps(places: Complexes, *, loop: bool) -> Complexes:
    """Return the velocity jump at each frame, in pixels a frame; for a loop, of one round."""
    velocities = np.diff(places)
    if not loop:
        return np.diff(velocities, prepend=0, append=0)
    if not len(velocities):
        return np.zeros(1, dtype=np.complex128)
    return velocities - np.roll(velocities, 1)


def _across(jumps: Complexes, arms: Complexes) -> Complexes:
    """Return the part of jumps across the arms (n,) at these frames, counter-clockwise."""
    arms = arms[: len(jumps)]
    lengths = np.abs(arms)
    along = np.divide(arms, lengths, out=np.zeros_like(arms), where=lengths > 0)
    return (jumps * along.conj()).imag.astype(np.complex128)


def _until_next(jumps: Complexes, *, again: bool = False) -> Indices:
    """Return the number of frames from each frame to the next jump, larger if there is none."""
    count = len(jumps)
    frames = np.flatnonzero(jumps)
    frames = np.append(frames, frames + count if again else [])
    never = np.array([2 * count + FADE_FRAMES])
    following = np.concatenate([frames, never]).astype(np.intp)
    here = np.arange(count)
    return following[np.searchsorted(following, here, side="right")] - here


def _require(holds: bool | np.bool_, message: str) -> None:  # noqa: FBT001 - reads as a sentence
    if not holds:
        raise EngineError(message)
