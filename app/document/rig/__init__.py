"""Relations of handles: mirror pairs, bones and stiffness, and applied motion presets.

In: handles.
Out: mirror partners, bones, stiffness, applied motion presets.
Imports: the values of `app.document`.
"""
