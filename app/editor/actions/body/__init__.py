"""What a layer is made of, changed: its cut-out, its mesh and limits, its material.

In: a session, and the arguments of a verb.
Out: the session, changed.
Imports: `app.editor`, `app.editor.actions`.
"""

from app.editor.actions.body import (
    cutting as cutting,
    material as material,
    rebuilding as rebuilding,
)
