"""The tab of motion: the library of poses, sliders, motion presets, and sounds.

In: the active layer, and the sounds of the scene.
Out: actions on these.
Imports: `app.ui.style`, `app.ui.shortcuts`.
"""
