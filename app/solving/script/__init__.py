"""Pose scripts: animations in a small JSON format.

In: the file.
Out: the checked contents by layer.
Imports: `app.document`, `app.storage`.
"""
