"""The setup of a layer: cut-out, mesh, material.

In: the active layer.
Out: actions on these.
Imports: `app.ui.style`, `app.ui.shortcuts`.
"""
