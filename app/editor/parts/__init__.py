"""The parts of a session and of a project: each attribute is written in one module.

In: values that the actions pass to the methods of a part.
Out: the state of the window and of the open project.
Imports: `app.document`, `app.storage`, `app.export`, `app.motion`, `app.editor.work`.
"""
