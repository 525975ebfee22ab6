"""Background work: jobs of the workers, and pending changes.

In: pure computations on frozen input.
Out: their results, on the main thread; pending changes of the document.
Imports: `app.document`, `app.solving`, `app.editor.action`.
"""
