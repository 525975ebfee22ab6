"""Poses that are used again: copied and pasted, flipped, and kept in the figure's library.

In: a session with a project.
Out: keys that hold those poses, and what was copied or kept.
Imports: `app.editor.actions`, `app.solving`.
"""

from app.editor.poses import copying as copying, flipping as flipping, library as library
