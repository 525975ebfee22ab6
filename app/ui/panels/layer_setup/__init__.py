"""The setup of a layer: cut-out, mesh, material.

In: the active layer.
Out: actions on these.
Imports: `app.ui.style`, `app.ui.shortcuts`.
"""

from app.ui.panels.layer_setup import cut_out as cut_out, domain as domain, material as material
