"""Editing a layer's cut-out, mesh, limits and stiffness.

In: a session, and the arguments of a verb.
Out: the changed session.
Imports: `app.editor`, `app.editor.actions`.
"""
