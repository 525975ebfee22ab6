"""The tab of sounds: their settings, and keys made from them.

In: a session.
Out: actions.
Imports: `app.ui.style`, `app.ui.shortcuts`.
"""
