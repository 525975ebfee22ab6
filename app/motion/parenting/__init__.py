"""Transforms of attached layers at any time.

In: documents, and cached motion of their layers.
Out: rigid motions from layers to the scene; attachments that keep a layer in place.
Imports: `app.document`, `app.motion.inbetweens`, `app.motion.tracing`.
"""
