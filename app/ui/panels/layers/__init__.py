"""The tab of layers: their tree, and the settings of the active layer.

In: a session.
Out: actions.
Imports: `app.ui.style`, `app.ui.shortcuts`.
"""
