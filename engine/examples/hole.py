"""A plate with a hole: the same calls, and in-betweens that close around it."""

import numpy as np

import engine

circle = np.exp(2j * np.pi * np.arange(40) / 40)
domain = engine.domain_of_polygon(2 * circle, [0.5 + 0.8 * circle], triangles=2_000)
boundary = engine.Boundary.sample(domain)

grips = np.array([-1.7, 1.7, 1.7j, -1.7j])
handles = engine.Handles.place(boundary, grips)
deformer = engine.Deformer(boundary=boundary, handles=handles, bounds=engine.Bounds(k=0.7))
rest = deformer.start()
oval, _ = deformer.settle(rest, handles.targets(grips * [1.3, 1.3, 0.8, 0.8]))

prepared = engine.prepare(
    [rest.map, oval.map], boundary, domain.mesh.vertices, triangles=domain.mesh.triangles
)
frame = prepared.frame(0.5)
# The integral of f_z dz + f_z̄ dz̄ around the hole is 0 only because a small factor closes it.
correction = prepared.segments[0].correction
print(f"{len(domain.holes)} hole, closed by a factor of at most exp({correction:.1e})")
print(f"half-way: k up to {frame.k.max():.3f}, sigma_b down to {frame.sigma_b.min():.3f}")
