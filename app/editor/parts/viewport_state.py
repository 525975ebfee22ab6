"""What is shown: the view of the scene, the overlays of the viewport, and the panel in front."""

from dataclasses import dataclass, field, replace
from typing import Any, Literal

from app.document import Baseline, Variant
from app.editor.work.revised import Revised
from app.motion import BoundingBox
from app.render import View, fit_view

HeatMap = Literal["none", "k", "sigma_a", "sigma_b"]
CurveKind = Literal["relative", "absolute"]
Tint = Literal["depth", "stiffness"]
FIT_MARGIN = 0.08  # of the viewport: margin around a fitted box


@dataclass(frozen=True, slots=True, kw_only=True)
class Overlays:
    """Overlays of the viewport."""

    handles: bool = True
    wireframe: bool = False
    outline: bool = False
    cage: bool = False
    onion: bool = False
    mirror: bool = False  # the mirror axis of poses
    paths: bool = False  # of the selected handles
    heat_map: HeatMap = "none"


@dataclass(frozen=True, slots=True, kw_only=True)
class CompareView:
    """The compared method, and the division of the viewport."""

    method: Variant | Baseline  # method of all layers in the right part
    divider: float = 0.5  # place of the divider, as a share of the viewport's width
    # Whether both methods are shown whole, side by side, instead of under a divider.
    is_side_by_side: bool = False


@dataclass(slots=True, kw_only=True, eq=False)
class ViewportState(Revised):
    """The person's view of the scene."""

    view: View | None = None  # None fits the picture into the viewport
    is_camera_view: bool = False  # whether the viewport shows the camera's view
    awaits_extent: bool = False  # whether the view fits the motion once it is measured

    def show(self, view: View | None) -> None:
        """Move the view; None fits the picture's frame into the viewport at any size."""
        self.view, self.is_camera_view, self.awaits_extent = view, False, False

    def toggle_camera_view(self) -> None:
        """Show the camera's view, or the earlier view again."""
        self.is_camera_view = not self.is_camera_view

    def await_extent(self) -> None:
        """Show the extent of the motion as soon as it is measured."""
        self.awaits_extent = True

    def stop_awaiting_extent(self) -> None:
        """Keep the view, since the extent of the motion cannot be measured."""
        self.awaits_extent = False


@dataclass(slots=True, kw_only=True, eq=False)
class DisplayState(Revised):
    """What the window shows of any project, and where the person works in it."""

    overlays: Overlays = field(default_factory=Overlays)
    tint: Tint | None = None  # quantity that colours the drawing
    curve_kind: CurveKind = "relative"
    compare_view: CompareView | None = None  # None shows the drawing alone
    last_compare_view: CompareView = CompareView(method=Variant.LINEAR)  # before it was closed
    screen: tuple[int, int] = (640, 480)  # pixels of the viewport
    full_detail: bool = True  # whether the full mesh is drawn fast enough in motion
    panel_to_focus: str = ""  # to be brought to the front in the next frame
    is_panel_folded: bool = False  # whether the drawing has the panel's room
    is_measuring: bool = False  # whether the tab of measures is there
    # Whether actions on the selection mean the timeline: it has the pointer, or else the focus.
    is_timeline_focused: bool = False

    def show_overlays(self, **shown: Any) -> None:
        """Show or hide overlays."""
        self.overlays = replace(self.overlays, **shown)

    def show_tint(self, tint: Tint | None) -> None:
        """Colour the drawing by a quantity; None shows its own colours."""
        self.tint = tint

    def show_curves(self, kind: CurveKind) -> None:
        self.curve_kind = kind

    def toggle_comparison(self) -> None:
        """Show the last compared method beside the drawing's method, or the drawing alone."""
        if self.compare_view is None:
            self.compare_view = self.last_compare_view
        else:
            self.last_compare_view, self.compare_view = self.compare_view, None

    def change_comparison(self, **values: Any) -> None:
        """Change the compared method or the division, if a method is compared."""
        if self.compare_view is not None:
            self.compare_view = replace(self.compare_view, **values)

    def resize(self, width: int, height: int) -> None:
        """Note the viewport's size in pixels."""
        self.screen = max(width, 1), max(height, 1)

    def note_speed(self, *, full_detail: bool) -> None:
        """Note whether the full mesh is drawn fast enough in motion."""
        self.full_detail = full_detail

    def focus_panel(self, title: str) -> None:
        """Bring a tab to the front in the next frame, also of the folded panel; "" once there."""
        self.panel_to_focus = title
        self.is_panel_folded = self.is_panel_folded and not title

    def fold_panel(self, *, folded: bool) -> None:
        self.is_panel_folded = folded

    def measure(self, *, shown: bool) -> None:
        """Show or hide the tab of measures."""
        self.is_measuring = shown

    def focus_timeline(self, *, focused: bool) -> None:
        """Note whether the person works in the timeline or in the drawing."""
        self.is_timeline_focused = focused


def fit_view_around(box: BoundingBox, screen: tuple[int, int]) -> View:
    """Return the view of a box with a margin, on a screen of this size in pixels."""
    return fit_view(*box, screen, margin=FIT_MARGIN * min(screen))
