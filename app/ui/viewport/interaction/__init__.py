"""The active gesture in the viewport, and the items that can be dragged there.

In: the screen, and the pointer.
Out: shapes of tools, grips, texts about both, and actions.
Imports: `app.ui.style`, `app.ui.shortcuts`, and the screen mapping.
"""
