"""The frames at which sliders, tracks and springs act; repeated frames are listed once."""

import numpy as np

from app.document import Clip, Track, segment_layout, slider_weights_at, track_cycle
from app.rigging import FADE_FRAMES, frames_to_settle
from engine.arrays import Floats, Indices


def acting_frames(clip: Clip, *, is_carried: bool = False) -> tuple[Indices, Indices]:
    """Return the frames (n,) at which sliders, tracks or springs act, and the count of each (n,).

    Frames with equal poses, sliders and tracks are listed once, by their first frame. Springs, and
    tracks of a layer with a parent, continue across repeats: there each frame is listed.
    """
    layer = clip.layer
    frames = np.arange(clip.frames.first, clip.frames.last + 1)
    springs = [spring for spring in layer.springs if spring.enabled]
    tracks = [track for track in layer.tracks if track.enabled]
    acts = np.full(len(frames), bool(springs) and (is_carried or clip.loop))
    # Springs come to rest after the last motion.
    end = max([clip.keys[-1].frame, *(ring.end for ring in segment_layout(clip).cycles)])
    for spring in springs:
        settled = frames_to_settle(clip.fps, spring.frequency, spring.damping)
        rests = end + spring.lag + settled + FADE_FRAMES
        acts |= (clip.keys[0].frame <= frames) & (frames <= rests)
    for track in tracks:
        acts |= np.isfinite(_times(track, clip, frames))
    slid = [slider_weights_at(clip, frame) for frame in frames.tolist()]
    acts |= [any(weights) for weights in slid]
    frames, slid = frames[acts], [slid[place] for place in np.flatnonzero(acts)]
    if springs or is_carried:
        return frames, np.ones_like(frames)
    _, alike = np.unique(_posed(clip, frames), return_inverse=True)
    for values in [_times(track, clip, frames) for track in tracks] + [_numbered(slid)]:
        _, own = np.unique(values, return_inverse=True)
        _, alike = np.unique(alike * (len(frames) + 1) + own, return_inverse=True)
    _, first, counts = np.unique(alike, return_index=True, return_counts=True)
    order = np.argsort(first)
    return frames[first[order]], counts[order]


def _numbered(rows: list[tuple[float, ...]]) -> Floats:
    """Return a number for each row (n,), the same for equal rows."""
    numbers = {row: float(number) for number, row in enumerate(dict.fromkeys(rows))}
    return np.array([numbers[row] for row in rows])


def _times(track: Track, clip: Clip, frames: Indices) -> Floats:
    """Return the track time that each frame shows, ∞ where the track does not act."""
    first, last = track.keys[0].frame, track.keys[-1].frame
    cycle, period = track_cycle(track, clip), clip.period if clip.loop else 0
    times, covered = frames - track.delay, np.ones(len(frames), bool)
    if cycle is not None:
        end = clip.frames.last if cycle.until is None else cycle.until
        covered = (cycle.first <= frames) & (frames <= end)
        period = cycle.period
        times = cycle.first + (times - cycle.first) % period
    found = np.full(len(frames), np.inf)
    for at in (times - period, times + period, times):
        is_on = covered & (first <= at) & (at <= last)
        found[is_on] = at[is_on]
    return found


def _posed(clip: Clip, frames: Indices) -> Indices:
    """Return for each frame the first frame with the same pose."""
    keys = clip.keys
    if len(keys) == 1:
        return np.zeros_like(frames)
    rings = segment_layout(clip).cycles
    shown = frames
    if not clip.loop and not rings:
        shown = np.clip(frames, keys[0].frame, keys[-1].frame)
    for ring in rings:
        first, period = ring.cycle.first, ring.cycle.period
        within = (first <= frames) & (frames < ring.end)
        if ring.segments:
            shown = np.where(within, first + (frames - first) % period, shown)
        else:
            shown = np.where(within, keys[ring.keys[0]].frame, shown)
    return shown
