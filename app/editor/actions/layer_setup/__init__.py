"""Editing a layer's cut-out, mesh, limits and stiffness.

In: a session, and the arguments of a verb.
Out: the changed session.
Imports: `app.editor`, `app.editor.actions`.
"""

from app.editor.actions.layer_setup import (
    cut_out_editing as cut_out_editing,
    resolving as resolving,
    stiffness_editing as stiffness_editing,
)
