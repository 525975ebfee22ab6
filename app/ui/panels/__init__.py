"""One panel a module: `draw(session, look)` reads the session and returns the person's actions.

In: a session.
Out: actions.
Imports: `app.ui.style`, `app.ui.shortcuts`, `app.ui.viewport`.
"""

from app.ui.panels import cut_out, deform, distortion, domain, export, handle, layers, poses

__all__ = ["cut_out", "deform", "distortion", "domain", "export", "handle", "layers", "poses"]
