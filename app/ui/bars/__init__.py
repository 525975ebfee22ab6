"""The bars around the panels: menus at the top, icons at the left, status at the bottom.

In: a session.
Out: actions.
Imports: `app.ui.style`, `app.ui.shortcuts`.
"""
