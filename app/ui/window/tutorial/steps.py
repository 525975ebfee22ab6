"""The text and the target of each step of the tutorial."""

from collections.abc import Mapping
from typing import NamedTuple

from imgui_bundle import ImVec2, imgui

from app.editor import Project, Session, TutorialState
from app.editor.actions import playback, tutorials, viewing
from app.editor.actions.project_files import exporting
from app.editor.actions.timing import keys
from app.editor.tools import move_tool
from app.texts import _
from app.ui.panel import is_in_front
from app.ui.shortcuts.keys import shown_keys
from app.ui.style.theme import Look
from app.ui.viewport.screen import ScreenMapping
from app.ui.window.tutorial.layout import Rect

Places = Mapping[str, tuple[ImVec2, ImVec2]]
RING, REACH = 1.3, 5.0  # em: radius of the ring around a place; tolerance of a handle's place


class TutorialStep(NamedTuple):
    """The card's text, the rectangle it points at, and the drop place of a drag."""

    text: str
    at: Rect | None = None
    to: Rect | None = None
    is_round: bool = False
    # Whether the card may cover panels, too.
    anywhere: bool = False

    @property
    def uncovered(self) -> tuple[Rect, ...]:
        """Rectangles that the card must not cover: its target, and the path of the drag."""
        if self.at is None:
            return ()
        if self.to is None:
            return (self.at,)
        low = ImVec2(min(self.at.low.x, self.to.low.x), min(self.at.low.y, self.to.low.y))
        high = ImVec2(max(self.at.high.x, self.to.high.x), max(self.at.high.y, self.to.high.y))
        return self.at, Rect(low, high)


def find_tutorial_step(
    session: Session, look: Look, guide: TutorialState, screen: ScreenMapping, places: Places
) -> TutorialStep:
    """Return the next step of the tutorial and its place.

    `places` has the rectangles of items in the frame before, by their names.
    """
    hindrance = _hindrance(session) if guide.stage in {"handle", "pose"} else ""
    return TutorialStep(hindrance) if hindrance else _to_step(session, look, guide, screen, places)


def _to_step(
    session: Session, look: Look, guide: TutorialState, screen: ScreenMapping, places: Places
) -> TutorialStep:
    match guide.stage:
        case "handle":
            return _to_handle(look, guide, screen)
        case "time":
            ruler = _box(places, "ruler")
            to = None if ruler is None else Rect(ruler.middle, ruler.middle)
            text = _("Drag the playhead along the ruler, to about the middle.")
            return TutorialStep(text, _box(places, "playhead") or ruler, to)
        case "pose":
            return _to_pose(look, guide, screen, places)
        case "play":
            keys = shown_keys(playback.toggle_play)
            return TutorialStep(
                _(
                    "Click here, or press {keys}: Lissom fills in the motion between the poses."
                ).format(keys=keys),
                _box(places, playback.toggle_play.label),
            )
        case "export":
            return _to_export(session, screen.project, places)
        case "done":
            exported = session.export.completed
            name = "GIF" if exported is None else exported.out.name
            return TutorialStep(
                _(
                    "{file} is saved. Go on with your project: add keys, drag them in time, save "
                    "the project."
                ).format(file=name)
            )


def _hindrance(session: Session) -> str:
    """Return the step that must come before handles can be added and dragged; else ""."""
    if not session.tools.is_posing:
        return _("Another tool is active: {keys} goes back to posing.").format(
            keys=shown_keys(move_tool.return_to_posing)
        )
    if not session.display.overlays.handles:
        return _("The handles are hidden: {key} shows them.").format(
            key=shown_keys(viewing.HANDLES)
        )
    return ""


def _to_handle(look: Look, guide: TutorialState, screen: ScreenMapping) -> TutorialStep:
    if guide.handle_place is None:
        return TutorialStep(
            _(
                "Click on a part that should stay in place, then on a part that should move. Each "
                "click adds a handle."
            )
        )
    return TutorialStep(
        _("Click on the nose. The other handles hold legs and body in place."),
        _ring(look, screen, guide.handle_place),
        is_round=True,
    )


def _to_pose(
    look: Look, guide: TutorialState, screen: ScreenMapping, places: Places
) -> TutorialStep:
    if screen.project.unkeyed_pose is not None:
        insert = keys.insert_key_in_row
        return TutorialStep(
            _(
                "Auto-key is off, so this pose has no key. Press {keys} ({action}) to set a key."
            ).format(action=insert.label, keys=shown_keys(insert)),
            _box(places, insert.label),
        )
    layer, handles = screen.shown.clip.layer, screen.shown.handle_positions
    if guide.handle_place is None or guide.target_place is None:
        newest = _ring(look, screen, complex(handles[-1])) if len(handles) else None
        text = _("Drag one of the handles. Lissom sets a key with the new pose.")
        return TutorialStep(text, newest, is_round=True)
    near = {
        abs(handle.position - guide.handle_place): complex(place)
        for handle, place in zip(layer.handles, handles, strict=False)
    }
    reach = REACH * look.em / screen.scale
    held = near[min(near)] if near and min(near) < reach else guide.handle_place
    return TutorialStep(
        _("Drag the nose down to the ground. Lissom sets a key with the new pose."),
        _ring(look, screen, held),
        _ring(look, screen, guide.target_place),
        is_round=True,
    )


def _to_export(session: Session, project: Project, places: Places) -> TutorialStep:
    if exporting.is_export_under_way(session):
        return TutorialStep(_("The GIF is being exported."))
    if not is_in_front("Export"):
        window = imgui.internal.find_window_by_name("###Export")
        tab = None if window is None else window.dc.dock_tab_item_rect
        at = None if tab is None else Rect(tab.min, tab.max)
        return TutorialStep(_("Open the Export tab."), at, anywhere=True)
    if project.document.export.format != tutorials.FORMAT:
        return TutorialStep(_("Choose GIF as the format."), _box(places, "format"))
    return TutorialStep(
        _("Click Export, and choose where the GIF goes."), _box(places, "start export")
    )


def _box(places: Places, name: str) -> Rect | None:
    return Rect(*places[name]) if name in places else None


def _ring(look: Look, screen: ScreenMapping, place: complex) -> Rect:
    """Return the bounding box of a ring around a place of the drawing."""
    point = screen.point(place)
    return Rect(point, point).grown(RING * look.em)
