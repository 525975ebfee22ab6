"""A polygon, posed by three handles, and in-betweens that provably never fold."""

import engine

# A bar of 6 by 1, with the cage of its coordinates and a mesh.
domain = engine.domain_of_polygon([0, 6, 6 + 1j, 1j], triangles=2_000)
boundary = engine.Boundary.sample(domain)

# Two handles stay, the third is pulled up. No map may stretch, squeeze or shear more than this.
grips = [0.5 + 0.5j, 2 + 0.5j, 5.5 + 0.5j]
handles = engine.Handles.place(boundary, grips)
bounds = engine.Bounds(k=0.6, sigma_a=2.5, sigma_b=0.4)
deformer = engine.Deformer(boundary=boundary, handles=handles, bounds=bounds)
rest = deformer.start()
bent, steps = deformer.settle(rest, handles.targets([grips[0], grips[1], 3.5 + 3.5j]))
print(f"{bent.status.value} after {steps} steps, k up to {bent.certificate.k:.3f}")

# The rest is the key at time 0, the bent shape that at time 1.
vertices, triangles = domain.mesh.vertices, domain.mesh.triangles
prepared = engine.prepare([rest.map, bent.map], boundary, vertices, triangles=triangles)
frame = prepared.frame(0.5)
print(f"half-way: k up to {frame.k.max():.3f}, tau up to {frame.tau.max():.3f}")

proof = engine.prove(prepared.segments[0])
print(f"at all times: k up to {proof.k:.3f}, folds nowhere: {proof.is_locally_injective}")
