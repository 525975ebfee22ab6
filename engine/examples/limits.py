"""A target out of reach: the limits hold, and the state tells which of them and where."""

import engine

domain = engine.domain_of_polygon([0, 6, 6 + 1j, 1j], triangles=1_000)
boundary = engine.Boundary.sample(domain)
grips = [0.5 + 0.5j, 5.5 + 0.5j]
handles = engine.Handles.place(boundary, grips)
targets = handles.targets([grips[0], 12 + 0.5j])  # more than twice as long

for sigma_a in (3.0, 1.5, 1.2):
    bounds = engine.Bounds(k=0.8, sigma_a=sigma_a, sigma_b=0.3)
    deformer = engine.Deformer(boundary=boundary, handles=handles, bounds=bounds)
    state, _ = deformer.settle(deformer.start(), targets)
    reached = deformer.positions(state)[1].real
    print(f"sigma_a <= {sigma_a}: {state.status.value}, the handle came to x = {reached:.2f}")
    for active in state.statistics.active if state.statistics else ():
        print(f"    {active.name} holds it back at {active.place:.2f}")

# A solver that runs out of steps raises an error; with throw=False it returns what it has.
try:
    deformer.settle(deformer.start(), targets, at_most=3)
except engine.EngineError as error:
    print(error)
unfinished, _ = deformer.settle(deformer.start(), targets, at_most=3, throw=False)
print(f"{unfinished.status.value}, yet certified: {unfinished.certificate.is_certified}")
