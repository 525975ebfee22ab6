"""Posing by handles: dragging, solving and committing poses.

In: a session, handles, and their targets.
Out: poses in the document, step by step; handles and the anchor.
Imports: `app.editor`, `app.document`, `app.motion`, `app.solving`.
"""
