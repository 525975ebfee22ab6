"""The docks around the viewport: their sizes, and the labels of their tabs.

In: the window's panels, and what of the session decides which are shown.
Out: Dear ImGui's docks.
Imports: `app.ui.panel`, `app.ui.style`.
"""
