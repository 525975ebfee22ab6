"""The person's view of the timeline: visible time, gestures of the pointer, and playhead.

In: actions.
Out: state that panels read.
Imports: `app.document`, `app.editor.work`.
"""
