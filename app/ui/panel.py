"""A dockable panel of the window."""

from collections.abc import Callable
from dataclasses import dataclass
from typing import Literal

from imgui_bundle import hello_imgui, imgui

from app.editor import Action, Project, Session
from app.texts import _
from app.ui.style.theme import Look


@dataclass(frozen=True, slots=True, eq=False)
class Panel:
    """A dockable part of the window, with the icon of its tab and its initial dock.

    `draw` reads the session and its project, and returns the person's actions. Without a project
    it is not called.
    """

    title: str  # its name in the program; the tab shows it in the person's language
    icon: str
    draw: Callable[[Session, Look, Project], list[Action]]
    place: Literal["MainDockSpace", "side", "bottom"] = "side"
    # Drawn before the panel. It stays visible if `draw` fails.
    draw_background: Callable[[Session, Look, Project], list[Action]] | None = None
    # Whether the person has switched it on; None for panels that always have a tab.
    is_shown: Callable[[Session], bool] | None = None
    # The height in em that its contents want; None if that never changes.
    wanted_height: Callable[[Project], float] | None = None

    def height_of(self, session: Session) -> float:
        """Return the height in em that its contents want, 0 if they want none."""
        project = session.project
        return self.wanted_height(project) if self.wanted_height and project else 0.0

    def has_tab(self, session: Session) -> bool:
        """Return whether it has a tab now. All tabs go while the panel is folded."""
        if self.place == "side" and session.display.is_panel_folded:
            return False
        return self.is_shown is None or self.is_shown(session)

    @property
    def labels(self) -> tuple[str, str, str]:
        """The tab's texts, from the longest to the icon alone. The title is their ImGui id."""
        title = _(self.title)
        texts = (f"{self.icon}  {title}", title, self.icon)
        full, short, icon = (f"{text}###{self.title}" for text in texts)
        return full, short, icon

    @property
    def label(self) -> str:
        """The name of the panel's window. Its id stays the same while the text changes."""
        return self.labels[0]


def bring_to_front(title: str) -> bool:
    """Show a panel in the next frame. Return whether it was in front already."""
    for panel in hello_imgui.get_runner_params().docking_params.dockable_windows:
        if panel.label.endswith(f"###{title}"):
            panel.focus_window_at_next_frame = True
    return is_in_front(title)


def is_in_front(title: str) -> bool:
    """Return whether a panel is visible. A tab behind another tab or a folded one is not."""
    window = imgui.internal.find_window_by_name(f"###{title}")
    node = None if window is None else window.dock_node
    if window is None or not (window.active or window.was_active):
        return False
    return node is None or bool(node.selected_tab_id == window.tab_id)
