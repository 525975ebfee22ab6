"""The card that leads through a first animation.

In: the guide of a session, and where things were drawn in the frame before.
Out: what is clicked on the card, as actions.
Imports: `app.ui.viewport`, `app.ui.shortcuts`.
"""

from app.ui.window.tutorial.card import NAME as NAME, Callout as Callout
