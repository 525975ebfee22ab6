"""Joint tool: a drag places a joint of a motion, and a click leaves it out."""

from collections.abc import Iterable
from dataclasses import dataclass
from typing import Self

from app.editor.actions.posing.motion_presets import joint_placement
from app.editor.overlay_shapes import (
    CircleShape,
    ColourRole,
    KnobShape,
    LineShape,
    OverlayShape,
    TagShape,
)
from app.editor.parts.tools import Hint
from app.editor.project import Project
from app.editor.session import Session
from app.editor.tools.tool import PointerHit, Tool
from app.editor.work.motion_setup import MotionSetup
from app.texts import _

REACH = 14.0  # screen pixels: reach of the pointer around a joint
DOT = 0.42  # em: radius of a joint


@dataclass(slots=True, kw_only=True, eq=False)
class JointTool(Tool):
    """The pointer drags a joint; a click with Ctrl or Alt leaves the joint out."""

    name: str
    start: complex
    draft: MotionSetup  # the draft before the drag
    is_drag: bool = False

    @classmethod
    def mode(cls, _session: Session, _project: Project) -> str:
        return _("Setting joints")

    @classmethod
    def idle_shapes(
        cls, session: Session, project: Project, spot: PointerHit
    ) -> Iterable[OverlayShape]:
        """Yield joints and bones, each side in its own colour, and the pointed joint's name."""
        draft = session.tools.motion_setup
        if draft is None or project.timeline.playhead.since is not None:
            return
        places = joint_placement.shown_joint_places(session, project)
        for name, place in places.items():
            before = draft.body_kind.parent(name, places)
            if before:
                yield LineShape(points=[places[before], place], role=joint_role(name))
        for name, place in places.items():
            yield KnobShape(centre=place, radius=DOT * spot.em, role=joint_role(name))
        near = find_joint_near(session, project, spot.place)
        hot = near if session.tools.active_tool is None else draft.selected_joint
        for name, place in places.items():
            if name in {draft.selected_joint, hot}:
                yield CircleShape(centre=place, radius=1.7 * DOT * spot.em, role="text", width=0.1)
            if name == hot:
                yield TagShape(text=_(name), place=place + 1.2j * spot.em)

    @classmethod
    def hints(cls, session: Session, project: Project, spot: PointerHit) -> tuple[Hint, ...]:
        name = find_joint_near(session, project, spot.place)
        if name is None:
            return (Hint(_("drag each joint to its place")),)
        text = _("drag {joint} to its place").format(joint=_(name))
        return (Hint(text), Hint(_("click to leave the joint out"), "ctrl"))

    @classmethod
    def press(cls, session: Session, project: Project, spot: PointerHit) -> Self | None:
        """Grab a joint, or leave it out."""
        name, draft = find_joint_near(session, project, spot.place), session.tools.motion_setup
        if draft is None:
            return None
        if name is None:
            joint_placement.select_joint(session, None)
            return None
        if spot.is_opposite:
            joint_placement.exclude_joint(session, name)
            return None
        joint_placement.select_joint(session, name)
        return cls(project=project, name=name, start=spot.place, draft=draft)

    def move(self, session: Session, place: complex) -> None:
        """Move the joint to the pointer, within the drawing."""
        self.is_drag = self.is_drag or self.is_away(session, self.start, place)
        if self.is_drag and session.tools.motion_setup is not None:
            session.tools.select(self.draft)
            joint_placement.move_shown_joint(session, self.name, place)

    def end(self, session: Session, place: complex) -> None:
        self.move(session, place)

    def cancel(self, session: Session) -> None:
        if session.tools.motion_setup is not None:
            session.tools.select(self.draft)

    @property
    def active_hints(self) -> tuple[Hint, ...]:
        return (Hint(_("let go at its place")),)


def joint_role(name: str) -> ColourRole:
    """Return the colour of a joint, which depends on its side."""
    return "good" if name.endswith(".L") else "warning" if name.endswith(".R") else "accent"


def find_joint_near(session: Session, project: Project, place: complex) -> str | None:
    """Return the joint nearest to a place, within reach."""
    reach = REACH / project.view_on(session.display.screen).scale
    away = {
        name: abs(at - place)
        for name, at in joint_placement.shown_joint_places(session, project).items()
    }
    nearest = min(away, key=away.__getitem__, default=None)
    return nearest if nearest is not None and away[nearest] <= reach else None
