"""Playback at the cost of a linear blend: an interval as a series in time, built once."""

import numpy as np

import engine

domain = engine.domain_of_polygon([-3, 3, 3 + 1j, -3 + 1j], triangles=4_000)
boundary, cage = engine.Boundary.sample(domain), domain.cage
rest = engine.HarmonicMap.identity(cage)
bent = engine.HarmonicMap(cage=cage, phi=(np.exp(0.4j * cage) - 1) / 0.4j, psi=0 * cage)
prepared = engine.prepare(
    [rest, bent], boundary, domain.mesh.vertices, triangles=domain.mesh.triangles
)

# The generator works in small steps, so that a window can stay awake; `finish` takes all of them.
channels = engine.Positions.of(prepared.segments[0], prepared.sampled_domain)
series = engine.finish(engine.build_series(channels))
rows = [len(piece.rows) for piece in series.pieces]
print(f"{series.size} numbers a frame, blended of {rows} rows, at most {series.error:.1e} off")

for time in (0.0, 0.3, 1.0):
    positions = series.values(time).astype(np.float64).view(np.complex128)
    difference = np.abs(positions - prepared.frame(time).positions).max()
    print(f"time {time}: {difference:.1e} from the direct path")
