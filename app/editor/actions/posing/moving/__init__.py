"""Ready motions: what a layer is to be given, where its joints are, and giving it.

In: a session with a project.
Out: a draft of a motion; then the layer with its keys, in one step of undo.
Imports: `app.solving`, `app.editor.promises`, `app.editor.actions.playback` and `editing`.
"""

from app.editor.actions.posing.moving import (
    drafting as drafting,
    giving as giving,
    placing as placing,
)
