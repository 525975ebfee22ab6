"""The tab of the distortion: the heat map, and curves over time.

In: a session.
Out: actions.
Imports: `app.ui.style`, `app.ui.shortcuts`.
"""
