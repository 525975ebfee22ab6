"""The bars around the panels: menus at the top, icons at the left, status at the bottom.

The menus of layers are here as well, for the list of layers and the timeline.

In: a session.
Out: actions.
Imports: `app.ui.style`, `app.ui.shortcuts`.
"""
