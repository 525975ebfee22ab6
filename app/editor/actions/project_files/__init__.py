"""Opening, saving and exporting: verbs that read and write files.

In: a session, and a path or a project.
Out: the changed session; files are read and written on the worker.
Imports: the other actions, `app.export` and `app.storage`.
"""
