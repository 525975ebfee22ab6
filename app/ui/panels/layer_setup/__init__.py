"""What a layer is made of: its cut-out, its mesh, its material.

In: the layer that is posed.
Out: actions on these.
Imports: `app.ui.style`, `app.ui.shortcuts`.
"""

from app.ui.panels.layer_setup import cut_out as cut_out, domain as domain, material as material
