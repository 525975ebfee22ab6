"""Reuse of poses: copying, pasting, flipping, and pose libraries.

Poses fit any layer whose handles have the same names.

In: a session with a project.
Out: keys with these poses; the copied or saved poses.
Imports: `app.editor.actions`, `app.solving`.
"""
