"""Updates of a window's frame: the shown frame, and jobs for stages and values that are missing.

In: the session after a change.
Out: the displayed frame, and jobs in the order of their urgency.
Imports: `app.editor`, `app.document`, `app.motion`, `app.reports`, `app.storage`.
"""
