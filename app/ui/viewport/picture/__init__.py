"""Parts of the viewport's picture that live on the graphics card.

In: the project's layers, and the shown frame.
Out: meshes, onion skins and thumbnails of poses.
Imports: `app.render`, the overlays of `app.ui.viewport`.
"""
