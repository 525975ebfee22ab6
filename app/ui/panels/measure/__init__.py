"""The tab of measures: distortion on the drawing, over its area, over time, and of keys.

In: the shown frame, and the measured curves.
Out: actions on what is shown and compared.
Imports: `app.ui.style`, `app.ui.viewport`.
"""
