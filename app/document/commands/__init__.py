"""Commands: changes of a document as values, with labels for undo and redo.

In: a document, or a layer of it, and arguments.
Out: the changed document.
Imports: the values of `app.document`.
"""
