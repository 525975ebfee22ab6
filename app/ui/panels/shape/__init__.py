"""The tab of the layer's shape: limits of its poses, stiffness and bones, and the mesh.

In: the active layer.
Out: actions on these.
Imports: `app.ui.style`, `app.ui.shortcuts`.
"""
