"""A drawing with an alpha channel: its mask becomes a domain, and a handle pulls its tip."""

import numpy as np

import engine

# Alpha from 0 to 255, first row on top. For a PNG: np.asarray(PIL.Image.open(path))[..., 3].
y, x = np.mgrid[:200, :120]
leaf = 1 - np.abs(x - 60) / (50 * np.sin(np.pi * (y + 10) / 220))
alpha = np.clip(255 * 8 * leaf, 0, 255).astype(np.uint8)

domain, notices = engine.build_domain(alpha > 8, triangles=2_000, detail="normal")
boundary = engine.Boundary.sample(domain)

grips = [60 + 30j, 60 + 180j]
handles = engine.Handles.place(boundary, grips)
deformer = engine.Deformer(boundary=boundary, handles=handles, bounds=engine.Bounds(k=0.6))
bent, _ = deformer.settle(deformer.start(), handles.targets([grips[0], 95 + 165j]))
print(f"{len(domain.outline)} corners, {len(notices)} notices")
print(f"{bent.status.value}, k up to {bent.certificate.k:.3f}")
