"""Rival methods that the paper compares its variants with (Section 8), behind `prepare_baseline`.

In: a triangulated domain, and keyframes: harmonic maps, or positions of the vertices.
Out: positions of the vertices at any time, and f_z and f_z̄ in each triangle.
Imports: `engine.interpolation`, `engine.deform`, `engine.paths`, `engine.maps`, `engine.domain`.

    prepared = prepare_baseline("arap", keyframes, points, triangles)  # a `Baseline` or its name
    frame = prepared.frame(0.5)
    frame.positions  # of the vertices, complex128 (n,)
    frame.fz, frame.fzbar  # of the triangles, complex128 (m,)

Keyframe i is at time i. `prepared.domain` has the mesh, its triangles counter-clockwise.
`domain.derivatives(positions)` gives f_z and f_z̄ of each triangle for the in-betweens of any other
method on the same mesh.
"""

from engine.baselines.boundary_keyframes import (
    discrete_harmonic as discrete_harmonic,
    harmonic_coordinate_maps as harmonic_coordinate_maps,
)
from engine.baselines.frames import MeshFrame as MeshFrame, MeshInbetweens as MeshInbetweens
from engine.baselines.preparation import (
    PreparedBaseline as PreparedBaseline,
    prepare_baseline as prepare_baseline,
)
from engine.baselines.triangulated_domain import TriangulatedDomain as TriangulatedDomain
from engine.variant import Baseline as Baseline
