"""The tab Poses: the library of poses, sliders of them, and flipped poses.

In: the session and its open project.
Out: actions.
Imports: `app.ui.style`, `app.ui.shortcuts`, `app.editor`, `app.document`.
"""
