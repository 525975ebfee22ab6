"""The tab of motion presets: the kind of body, its joints, and the motion.

In: the active layer, and its motion setup.
Out: actions on these.
Imports: `app.ui.style`, `app.ui.shortcuts`, `app.ui.viewport`.
"""
