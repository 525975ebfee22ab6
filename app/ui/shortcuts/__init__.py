"""All named actions: one table makes menus, buttons, tooltips and shortcuts.

In: a session, and the pressed keys.
Out: actions.
Imports: `app.editor`, `app.ui.style`.
"""
