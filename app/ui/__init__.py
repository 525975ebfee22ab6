"""The window: panels are functions that read the session and return actions.

In: a session.
Out: pictures of it, and the actions that the person asks for.
Imports: `app.editor`, `app.render`, Dear ImGui.
"""
