"""The bars over the drawing while a tool with settings of its own is active.

In: a session.
Out: actions.
Imports: `app.ui.style`, `app.ui.shortcuts`.
"""
