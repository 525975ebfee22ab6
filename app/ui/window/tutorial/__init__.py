"""The card that explains a first animation step by step.

In: the tutorial state of a session, and the rectangles of items in the frame before.
Out: the actions of the card's buttons.
Imports: `app.ui.viewport`, `app.ui.shortcuts`.
"""
