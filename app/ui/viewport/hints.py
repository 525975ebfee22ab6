"""What the status bar says about the place under the pointer."""

from app.editor import Hint, Session
from app.editor.tools import Spot, tools_of
from app.ui.shortcuts import ALT, CTRL, SHIFT, with_key
from app.ui.viewport.screen import Screen

KEYS = {"ctrl": CTRL, "shift": SHIFT, "alt": ALT}


def hint_at(session: Session, screen: Screen, spot: Spot) -> str:
    """Return what can be done where the pointer is."""
    project = screen.project
    if session.pointer is not None:
        return _sentence([*map(_in_words, session.pointer.ways), "Esc takes it back"])
    if session.cutting is None and project.playhead.since is not None:
        return "Space stops"
    if session.cutting is None and not session.overlays.handles:
        return "The handles are hidden: H shows them"
    told = [
        _in_words(hint) for tool in tools_of(session) for hint in tool.hints(session, project, spot)
    ]
    if session.cutting is not None:
        return _sentence([*told, "Esc goes back"])
    if spot.handle is not None:
        return f"{screen.shown.clip.figure.handle(spot.handle).name}: {', '.join(told)}"
    if not (spot.on_shape or spot.on_ring):
        told += ["wheel to zoom", "middle drag to move the view"]
    return _sentence(told)


def _sentence(parts: list[str]) -> str:
    text = ", ".join(parts)
    return text[:1].upper() + text[1:]


def _in_words(hint: Hint) -> str:
    return f"{with_key(KEYS[hint.key], hint.how) if hint.key else hint.how} {hint.what}"
