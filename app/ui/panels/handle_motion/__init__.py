"""The motion of a single handle: auto-pin, track, spring.

In: the selected handle.
Out: actions on its track, its spring, and its auto-pin.
Imports: `app.ui.style`, `app.ui.shortcuts`.
"""
