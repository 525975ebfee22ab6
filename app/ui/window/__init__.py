"""The window: its loop, its frame, and all panels.

In: the system's events.
Out: a running window.
Imports: every other room of `app.ui`.
"""
