"""Handles with clocks of their own: what a frame costs in which they stay, or go their own ways."""

from collections.abc import Iterator
from dataclasses import dataclass, replace

import numpy as np

from app.document import Clip, FrameRange, Spring, Track, TrackKey, clip_of, pinned_segments
from app.motion import Animation
from app.motion.inbetweens.pins.auto_pins import AutoPins
from app.motion.inbetweens.pose_sampler import PoseSampler
from app.motion.inbetweens.secondary_correction import SecondaryCorrection
from app.storage import load_project, sample_images
from engine.interpolation import finish
from engine.streaming import Positions, Series, build_series
from tests.bench.table import Row, Table, measure

# Samples, their layers, a handle that wags, and by how many pixels: within and at the bounds.
WAGS = (
    ("friend", "left arm", "hand", (40.0, 600.0)),
    ("giraffe", "layer", "tail", (40.0, 400.0)),
    ("dragon", "dragon", "tail tip", (40.0, 400.0)),
)


@dataclass(frozen=True, slots=True, kw_only=True)
class Extent:
    """How much is measured."""

    wags: tuple[tuple[str, str, str, tuple[float, ...]], ...] = WAGS
    frames: int = 48


BRIEF = Extent(wags=(("friend", "left arm", "hand", (40.0,)),), frames=3)


def tables(extent: Extent) -> Iterator[Table]:
    """Measure frames of layers whose handles stay, wag and swing."""
    for name, chosen, handle, sizes in extent.wags:
        document = load_project(sample_images() / f"{name}.lissom")
        layer = next(each for each in document.layers if each.name == chosen)
        own = next(each.id for each in layer.handles if each.name == handle)
        clip = clip_of(document, layer.id)
        rows = _pin_rows(clip, extent.frames)
        for size in sizes:
            keys = tuple(
                TrackKey(frame=8 * number, place=size * (0, 1j, 0, -1j)[number % 4])
                for number in range(8)
            )
            track = Track(handles=(own,), keys=keys)
            wagging = replace(clip, layer=replace(layer, tracks=(track,), has_auto_pins=False))
            rows.append(_row(f"{handle!r} wags by {size:.0f} px", wagging, extent.frames))
        spring = Spring(handle=own, frequency=1.6, damping=0.18)
        swinging = replace(clip, layer=replace(layer, springs=(spring,), has_auto_pins=False))
        rows.append(_row(f"{handle!r} swings on a spring", swinging, extent.frames))
        rows.append(_edit_row(clip, own, extent.frames))
        count = sum(map(len, layer.domain.cages))
        yield Table(title=f"A frame of {name}'s {chosen}, {count} cage vertices", rows=tuple(rows))


def _pin_rows(clip: Clip, frames: int) -> list[Row]:
    """Measure the segment of a clip with the most handles that stay, with and without them."""
    segments = pinned_segments(clip)
    pinned = [n for n, each in enumerate(segments) if each is not None and each.is_pinned.any()]
    if not pinned:
        return []
    layer = clip.layer
    handles = np.array([handle.position for handle in layer.handles])
    loose = replace(clip, layer=replace(layer, has_auto_pins=False))
    rows, plain = [], 0.0
    for name, each in (("a segment without pins", loose), ("the same with pins", clip)):

        def prepare(each: Clip = each) -> None:
            own = PoseSampler(layer, points=handles)
            AutoPins(each, layer.variant, own).inbetweens(pinned[0], own)

        prepare()  # what is prepared once
        seconds = measure(prepare, repeats=1)
        mesh = PoseSampler(layer)
        inbetweens = AutoPins(each, layer.variant, mesh).inbetweens(pinned[0], mesh)
        series = finish(build_series(Positions.of(inbetweens, mesh.sites)))

        def play(series: Series = series) -> None:
            for time in np.linspace(0.0, 1.0, frames):
                series.values(float(time))

        frame = measure(play) / frames
        plain = plain or frame
        note = f"a streamed frame takes {1e3 * frame:.2f} ms, {frame / plain:.2f} times as much"
        rows.append(Row(name=name, seconds=seconds, note=note))
    return rows


def _edit_row(clip: Clip, wagged: int, frames: int) -> Row:
    """Measure all frames of a clip with a track and two springs, in series, from an edit on."""
    others = [each.id for each in clip.layer.handles if each.id != wagged][:2]
    springs = tuple(Spring(handle=each, frequency=1.6, damping=0.18) for each in others)
    keys = tuple(TrackKey(frame=12 * n, place=20.0 * (0, 1j, 0, -1j)[n % 4]) for n in range(9))
    layer = replace(clip.layer, tracks=(Track(handles=(wagged,), keys=keys),), springs=springs)
    every = 2 * frames
    last = clip.frames.first + every - 1
    edited = replace(clip, layer=layer, frames=FrameRange(clip.frames.first, last))
    sampler = Animation(edited).sampler  # what is prepared before the edit

    def follow() -> None:
        sampler.known.corrections.clear()
        corrections = Animation(edited, sampler=sampler).corrections
        if corrections is None:
            raise ValueError("nothing is corrected")
        for number in range(every):
            corrections.correction_at(float(edited.frames.first + number))

    name = f"a track and {len(springs)} springs, all {every} frames after an edit"
    return Row(name=name, seconds=measure(follow, repeats=1), note="")


def _row(name: str, clip: Clip, frames: int) -> Row:
    handles = np.array([handle.position for handle in clip.layer.handles])
    animation = Animation(clip, points=handles)
    corrections = animation.corrections
    if corrections is None:
        raise ValueError(f"nothing of {name} is corrected")
    corrections.correction_at(0.0)  # what is prepared once
    found: list[SecondaryCorrection | None] = []

    def play() -> None:
        animation.sampler.known.corrections.clear()
        found[:] = [
            corrections.correction_at(clip.frames.first + 1.0 + number) for number in range(frames)
        ]

    seconds = measure(play, repeats=1) / frames
    steps = [each.steps for each in found if each is not None]
    miss = max(
        (max(each.target_errors.values(), default=0.0) for each in found if each), default=0.0
    )
    note = f"{np.mean(steps or [0]):.1f} steps, at most {max(steps, default=0)}"
    return Row(name=name, seconds=seconds, note=f"{note}; misses by {miss:.2f} px at most")
