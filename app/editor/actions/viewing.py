"""The look of the window: camera, overlays, theme."""

from dataclasses import replace
from functools import reduce
from typing import Any, Literal

from app.document import Baseline, Meshing, Variant
from app.editor.action import do
from app.editor.actions.action_spec import ActionSpec, named_action
from app.editor.parts.viewport_state import CurveKind, HeatMap, Tint, fit_view_around
from app.editor.project import Project
from app.editor.session import Session, with_project
from app.motion import BoundingBox, bounding_box
from app.render import View
from app.storage import LARGEST_GHOST_STEP, LARGEST_SCALE, MOST_GHOSTS, SMALLEST_SCALE, ThemeName
from app.texts import _

SCALE_STEP = 0.25
LEAST_PART = 0.05  # of the viewport's width; each method keeps at least this share
AROUND_HANDLES = 0.12  # of the layer's diagonal; the margin around handles that are fitted
OverlayName = Literal["handles", "wireframe", "outline", "cage", "onion", "mirror", "paths"]
HEAT_MAPS: tuple[HeatMap, ...] = ("none", "k", "sigma_a", "sigma_b")


@with_project
def set_view(_: Session, project: Project, camera: View | None) -> None:
    """Move the camera; None fits the picture's frame into the viewport at any size."""
    project.viewport.show(camera)


FIT_PICTURE = ActionSpec(do(set_view, None), _("Fit picture"))


@named_action(_("Fit pose"), "Home", icon="EXPAND", hint=_("Show the whole shape in this frame"))
@with_project
def zoom_to_pose(session: Session, project: Project) -> None:
    shown = [runtime.shown for runtime in project.runtimes.layers.values()]
    boxes = [
        bounding_box(each.placement.apply(each.positions)) for each in shown if each is not None
    ]
    if boxes:
        zoom_to_box(session, reduce(BoundingBox.joined, boxes))


@named_action(_("Fit motion"), "Shift+Home")
@with_project
def zoom_to_motion(_: Session, project: Project) -> None:
    """Show the area that all layers cover in any frame, as soon as it is measured."""
    project.viewport.await_extent()


@named_action(_("Fit selection"), "F")
@with_project
def zoom_to_selection(session: Session, project: Project) -> None:
    """Show the selected handles with a margin, or the whole layer; in the graph, the keys."""
    if project.graph.is_open and session.display.is_timeline_focused:
        project.graph.ask_fit()
        return
    shown = project.layer_runtime.shown
    if shown is None:
        return
    box = bounding_box(shown.placement.apply(shown.positions))
    selected = [handle.id in project.selection.handles for handle in shown.clip.layer.handles]
    if any(selected):
        room = AROUND_HANDLES * abs(box.upper - box.lower) * (1 + 1j)
        box = bounding_box(shown.placement.apply(shown.handle_positions[selected]))
        box = BoundingBox(box.lower - room, box.upper + room)
    zoom_to_box(session, box)


def zoom_to_box(session: Session, box: BoundingBox) -> None:
    """Move the camera so that a box of the scene fills the viewport."""
    set_view(session, fit_view_around(box, session.display.screen))


@named_action(_("Actual size"), "1")
@with_project
def zoom_to_actual_size(session: Session, project: Project) -> None:
    """Show one pixel of the picture as one pixel of the screen, around the same centre."""
    set_view(session, replace(project.view_on(session.display.screen), scale=1.0))


def set_viewport_size(session: Session, width: int, height: int) -> None:
    """Note the viewport's size in pixels."""
    session.display.resize(width, height)


def toggle_overlay(session: Session, overlay: OverlayName) -> None:
    session.display.show_overlays(**{overlay: not getattr(session.display.overlays, overlay)})


def _overlay(overlay: OverlayName, label: str, keys: str, **more: Any) -> ActionSpec:
    def is_shown(session: Session) -> bool:
        return bool(getattr(session.display.overlays, overlay))

    return ActionSpec(do(toggle_overlay, overlay), label, keys, active=is_shown, **more)


HANDLES = _overlay(
    "handles", _("Handles"), "H", icon="CIRCLE_DOT", hint=_("Show or hide the handles")
)
WIREFRAME = _overlay(
    "wireframe", _("Wireframe"), "W", icon="DRAW_POLYGON", hint=_("Show the triangles")
)
OUTLINE = _overlay(
    "outline", _("Outline"), "C", icon="VECTOR_SQUARE", hint=_("Show the edge of the shape")
)
ONION_SKIN = _overlay(
    "onion", _("Onion skin"), "O", icon="GHOST", hint=_("Show the poses before and after")
)
MIRROR_AXIS = _overlay("mirror", _("Mirror axis"), "Ctrl+M", mac_keys="Ctrl+Shift+M")
MOTION_PATHS = _overlay(
    "paths",
    _("Motion paths"),
    "J",
    icon="ROUTE",
    hint=_("Show the paths of the selected handles, with a dot for each frame"),
)


def show_heat_map(session: Session, heat_map: HeatMap) -> None:
    """Colour the shape by one of the distortions, or show its picture."""
    session.display.show_overlays(heat_map=heat_map)


@named_action(
    _("Heat map"),
    "D",
    icon="TEMPERATURE_HALF",
    hint=_("Colour the shape by its distortion"),
    active=lambda session: session.display.overlays.heat_map != "none",
)
def toggle_heat_map(session: Session) -> None:
    """Show the heat map of the conformal distortion, or hide the heat map."""
    show_heat_map(session, "k" if session.display.overlays.heat_map == "none" else "none")


def show_curves(session: Session, kind: CurveKind) -> None:
    """Show the curves of the distortion, relative to the keys or absolute."""
    session.display.show_curves(kind)


@named_action(
    _("Split view"),
    "U",
    icon="TABLE_COLUMNS",
    hint=_("Compare with another method, beside a divider that can be dragged"),
    active=lambda session: session.display.compare_view is not None,
)
def toggle_comparison(session: Session) -> None:
    """Show a second method beside the drawing's method, or the drawing alone."""
    session.display.toggle_comparison()


def compare_with_method(session: Session, method: Variant | Baseline | None) -> None:
    """Show a method beside the drawing's method; None shows the drawing alone."""
    if (method is None) != (session.display.compare_view is None):
        session.display.toggle_comparison()
    if method is not None:
        session.display.change_comparison(method=method)


def move_comparison_divider(session: Session, place: float) -> None:
    """Move the divider to a share of the viewport's width."""
    session.display.change_comparison(divider=min(max(place, LEAST_PART), 1.0 - LEAST_PART))


def set_side_by_side(session: Session, beside: bool) -> None:  # noqa: FBT001 - a panel's two choices
    """Show the two methods side by side, or at one place under a divider."""
    session.display.change_comparison(is_side_by_side=beside)


def set_onion_skin(session: Session, before: int, after: int, step: int) -> None:
    """Set the number of ghosts of the onion skin, and the frames between them."""
    session.settings.prefer(
        ghosts_before=min(max(before, 0), MOST_GHOSTS),
        ghosts_after=min(max(after, 0), MOST_GHOSTS),
        ghost_step=min(max(step, 1), LARGEST_GHOST_STEP),
    )


def set_onion_skin_in_front(session: Session, in_front: bool) -> None:  # noqa: FBT001 - a checkbox's
    session.settings.prefer(ghosts_in_front=in_front)


def set_path_range(session: Session, reach: int) -> None:
    """Set how many frames around the playhead motion paths cover; 0 means all played frames."""
    session.settings.prefer(path_reach=reach)


def set_backdrop(session: Session, backdrop: str) -> None:
    """Set the backdrop behind the drawing: "checker" or "#rrggbb"."""
    session.settings.prefer(backdrop=backdrop)


@with_project
def preview_meshing(_: Session, project: Project, meshing: Meshing) -> None:
    """Note the meshing that the next rebuild of the mesh uses."""
    project.layer_setup.preview_meshing(meshing)


@named_action(_("Light or dark"), needs_project=False)
def toggle_theme(session: Session) -> None:
    """Switch between the dark and the light theme."""
    theme: ThemeName = "light" if session.settings.preferences.theme == "dark" else "dark"
    session.settings.prefer(theme=theme)


def set_language(session: Session, language: str) -> None:
    """Set the code of the language, or "" for the system's, for the next start."""
    session.settings.prefer(language=language)
    session.notices.show(_("The language changes when Lissom starts again."), topic="language")


@named_action(
    _("Larger interface"), "Ctrl+Equal, Ctrl+Shift+Equal, Ctrl+KeypadAdd", needs_project=False
)
def enlarge_interface(session: Session) -> None:
    _scale_interface(session, SCALE_STEP)


@named_action(_("Smaller interface"), "Ctrl+Minus, Ctrl+KeypadSubtract", needs_project=False)
def shrink_interface(session: Session) -> None:
    _scale_interface(session, -SCALE_STEP)


def _scale_interface(session: Session, step: float) -> None:
    scale = min(max(session.settings.preferences.scale + step, SMALLEST_SCALE), LARGEST_SCALE)
    session.settings.prefer(scale=scale)


def focus_timeline(session: Session, in_timeline: bool) -> None:  # noqa: FBT001 - the only argument
    """Note whether the person works in the timeline or in the drawing."""
    session.display.focus_timeline(focused=in_timeline)


@named_action(
    _("Auto-key"),
    "K",
    icon="KEY",
    hint=_("Set keys by posing"),
    active=lambda session: session.settings.preferences.auto_key,
)
def toggle_auto_key(session: Session) -> None:
    """Switch auto-key: whether posing makes and changes keys."""
    auto_key = not session.settings.preferences.auto_key
    session.settings.prefer(auto_key=auto_key)


@named_action(
    _("Panel"),
    "Tab",
    hint=_("Show or fold the panel at the right"),
    active=lambda session: not session.display.is_panel_folded,
)
def toggle_panel(session: Session) -> None:
    session.display.fold_panel(folded=not session.display.is_panel_folded)


@named_action(
    _("Measure tab"),
    hint=_("Show distortion, its curves and its values at every key"),
    active=lambda session: session.display.is_measuring,
)
def toggle_measuring(session: Session) -> None:
    """Show the tab of measures in front, or hide it."""
    session.display.measure(shown=not session.display.is_measuring)
    if session.display.is_measuring:
        session.display.focus_panel("Measure")


def show_tab(session: Session, title: str) -> None:
    session.display.focus_panel(title)


def set_tint(session: Session, by: Tint | None) -> None:
    """Colour the drawing by depth or by stiffness; None shows its own colours."""
    session.display.show_tint(by)
