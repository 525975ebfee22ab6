"""Motion presets: choosing one for a layer, positioning its joints, and applying it.

In: a session with a project.
Out: a draft of a motion; then the layer with its keys, in one undo step.
Imports: `app.solving`, `app.editor.pending_changes`, `app.editor.actions.playback` and `editing`.
"""
