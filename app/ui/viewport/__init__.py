"""The viewport: the drawing, its overlays, and the pointer's gestures on it.

In: the shown frame, and the pointer.
Out: a picture of the drawing, and gestures.
Imports: `app.ui.style`, `app.ui.shortcuts`, `app.render`.
"""
