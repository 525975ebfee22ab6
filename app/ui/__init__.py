"""The window: panels are functions that read the session and return actions.

In: a session.
Out: pictures of the session, and the person's actions.
Imports: `app.editor`, `app.render`, Dear ImGui.
"""
