"""Tools of the pointer in the viewport: their table, and the verbs that pass events to them.

In: presses and moves of the pointer in the scene.
Out: a session that the active tool has changed.
Imports: `app.editor.actions`.
"""
