"""Tools that edit a layer's cut-out, stiffness, bones and joints.

In: the pointer's places.
Out: strokes, bones, and the joints of a motion.
Imports: `app.editor.actions`, `app.editor.tools.tool`.
"""
