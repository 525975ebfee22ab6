"""What a layer is made of, changed: its cut-out, its mesh and limits, its material.

In: a session, and the arguments of a verb.
Out: the session, changed.
Imports: `app.editor`, `app.editor.actions`.
"""

from app.editor.actions.layer_setup import (
    cut_out_editing as cut_out_editing,
    resolving as resolving,
    stiffness_editing as stiffness_editing,
)
