"""Actions in time: keys of poses and of tracks, and the pointer in the timeline.

In: a session, and keys by their layers, handles and frames.
Out: the document's keys and tracks, and the key selection.
Imports: the other `app.editor.actions`.
"""

from app.editor.actions.timing import (
    cycles as cycles,
    keys as keys,
    springs as springs,
    timeline_drag as timeline_drag,
    tracks as tracks,
)
