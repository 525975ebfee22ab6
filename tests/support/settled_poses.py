"""Keyframes as a person makes them: handles dragged far, and left until the pose has settled."""

from functools import cache

import numpy as np
from interpolation_shapes import (
    bar,
    boundary_of,
    inner_points,
    letter_l,
    narrow_u,
    outline_samples,
    spiral,
)

from engine.deform import Deformer, Handles
from engine.geometry.polygon import diameter
from engine.interpolation import prepare
from engine.maps import Bounds
from engine.streaming import Positions, build_series, finish

SHAPES = {"letter L": letter_l, "spiral": spiral, "bar": bar, "U": narrow_u}
HANDLES = 5
FAR = 0.35  # of the diagonal: how far a handle is dragged
STEPS = 40
LOOKED_AT = 200  # times between the samples of a series


@cache
def settled_poses(name, seed):
    """Drag the handles of a shape to two poses at the default bounds."""
    outline, _ = shape = SHAPES[name]()
    size, boundary = diameter(outline), boundary_of(shape)
    rng = np.random.default_rng(seed)
    places = inner_points(outline, HANDLES, seed, margin=0.01 * size)
    handles = Handles.place(boundary, places)
    deformer = Deformer(boundary=boundary, handles=handles, bounds=Bounds())
    maps = []
    for _ in range(2):
        away = rng.normal(size=HANDLES) + 1j * rng.normal(size=HANDLES)
        wish, state = handles.targets(places + FAR * size * away), deformer.start()
        for _ in range(STEPS):
            state = deformer.step(state, wish)
        maps.append(state.map)
    return tuple(maps)


def series_of(name, seed, variant, *, count=1000):
    """Return what a series covers of the time between two poses, and how true its error is.

    Returns
    -------
    covered : float
        Share of the times that are looked at.
    missed, stated : float
        The largest error that was found, and the one that the series tells; over the tolerance.
    """
    outline, _ = shape = SHAPES[name]()
    points = np.concatenate([inner_points(outline, count, 1), outline_samples(shape)])
    prepared = prepare(settled_poses(name, seed), boundary_of(shape), points, variant=variant)
    (interval,) = prepared.segments
    channels = Positions.of(interval, prepared.sampled_domain)
    series = finish(build_series(channels))
    times = np.sort(np.random.default_rng(seed).random(LOOKED_AT))
    covered = [time for time in times if series.covers(time)]
    missed = max(
        (np.abs(series.values(time) - channels.sample(time)).max() for time in covered[::10]),
        default=0.0,
    )
    return (
        len(covered) / LOOKED_AT,
        missed / channels.tolerance,
        series.error / channels.tolerance,
    )
