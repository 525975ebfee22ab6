"""Questions and file dialogs.

In: the open dialog of the session.
Out: the actions of its answers.
Imports: `app.ui.style`, `app.ui.shortcuts`.
"""
