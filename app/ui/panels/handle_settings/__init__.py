"""The settings of a single handle: auto-pin, track, spring, depth, anchor.

In: the selected handle.
Out: actions on these.
Imports: `app.ui.style`, `app.ui.shortcuts`.
"""
