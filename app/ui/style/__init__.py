"""The look of the window: themes, and the widgets that all panels share.

In: a theme and a scale.
Out: a `Look`, and widgets.
Imports: Dear ImGui.
"""
