"""The variants side by side, half-way between two keys that turn and stretch."""

import numpy as np

import engine

domain = engine.domain_of_polygon([-3, 3, 3 + 1j, -3 + 1j], triangles=2_000)
boundary, cage = engine.Boundary.sample(domain), domain.cage
rest = engine.HarmonicMap.identity(cage)
# Bent by 2.4 radians and stretched along; phi and psi are the values of both parts at the cage.
arc = (np.exp(0.4j * cage) - 1) / 0.4j
bent = engine.HarmonicMap(cage=cage, phi=1.2 * arc, psi=0.2 * cage)
points = domain.mesh.vertices
ends = engine.prepare([rest, bent], boundary, points).frame(1.0)
print(f"{'the key':>11}: k {ends.k.max():.3f}, tau {ends.tau.max():.3f}")

for variant in engine.Variant:
    frame = engine.prepare([rest, bent], boundary, points, variant=variant).frame(0.5)
    print(f"{variant:>11}: k {frame.k.max():.3f}, tau {frame.tau.max():.3f}")

# The paper's formulas as printed, at a few points well inside.
inside = points[np.abs(points.imag - 0.5) < 0.1][::20]
reference = engine.Reference(first=rest, second=bent, outline=domain.outline, anchor=0.5j)
printed = reference.frame(engine.Variant.NU, inside, 0.5)
fast = engine.prepare([rest, bent], boundary, inside, variant="nu", anchor=0.5j).frame(0.5)
print(f"nu differs by {np.abs(fast.positions - printed.positions).max():.1e} from the reference")
