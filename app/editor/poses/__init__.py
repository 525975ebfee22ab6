"""Poses that are used again: copied and pasted, flipped, and kept in libraries.

They come to any layer whose handles have the same names.

In: a session with a project.
Out: keys that hold those poses, and what was copied or kept.
Imports: `app.editor.actions`, `app.solving`.
"""

from app.editor.poses import (
    copying as copying,
    flipping as flipping,
    library as library,
    paste_destinations as paste_destinations,
    pasting as pasting,
)
