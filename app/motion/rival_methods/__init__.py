"""Rival methods that the paper compares its variants with (Section 8), behind `prepare_baseline`.

In: a triangulated domain, and keyframes: harmonic maps, or positions of the vertices.
Out: positions of the vertices at any time, and f_z and f_z̄ in each triangle.
Imports: `app.document`, `engine`.

    prepared = prepare_baseline("arap", keyframes, points, triangles)  # a `Baseline` or its name
    frame = prepared.frame(0.5)
    frame.positions  # of the vertices, complex128 (n,)
    frame.fz, frame.fzbar  # of the triangles, complex128 (m,)

Keyframe i is at time i. `prepared.domain` has the mesh, its triangles counter-clockwise.
`domain.derivatives(positions)` gives f_z and f_z̄ of each triangle for the in-betweens of any other
method on the same mesh.
"""
