"""Undo and redo, and the step of a drag under the hand.

In: commands and gestures.
Out: the document as displayed.
Imports: the values and commands of `app.document`.
"""
