"""The panels: each `draw_…` function reads the session and returns the person's actions.

In: a session.
Out: actions.
Imports: `app.ui.style`, `app.ui.shortcuts`, `app.ui.viewport`.
"""
