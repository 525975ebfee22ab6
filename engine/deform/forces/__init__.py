"""Forces on a shape beside those of its handles: bounded pulls, and bones.

In: handles with their stiffness; shafts, hinges and aims.
Out: energies with their gradients and Hessians.
Imports: `engine.deform.model`, `engine.maps`.
"""
