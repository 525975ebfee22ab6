"""Tool that rotates the shape around a handle, by its ring or with a modifier key.

If the row of the handle's track is selected, the track is keyed and the pose stays.
"""

import cmath
from collections.abc import Iterable, Mapping
from dataclasses import dataclass
from typing import Self

from app.document import Target
from app.editor.actions import editing, playback
from app.editor.actions.posing.handles import remove_handles
from app.editor.actions.posing.pose_drag import drag_handles
from app.editor.actions.tracking.track_dragging import (
    draggable_track,
    rotate_track_handle,
)
from app.editor.actions.tracking.track_space import track_target_angle
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
from app.editor.tools.tool import PointerHit, Tool, handle_places
from app.editor.tools.transform_tools.turning import Turning
from app.editor.work.drag_session import DragStart
from app.texts import _

RING, BAND, KNOB = 2.2, 0.5, 0.3  # em: radius of the ring, half its hit area, radius of its knob
LEAST_ARM = 12.0  # screen pixels around a handle; a press within has no direction


@dataclass(slots=True, kw_only=True, eq=False)
class RotateTool(Tool):
    """The pointer rotates the shape around a handle."""

    cursor = "hand"
    snaps = True
    snaps_by_shift = True
    handle: int
    start: complex  # place of the press
    turning: Turning  # around the handle
    turn: float  # rotation of the shape there at the start, in radians
    on_track: bool  # whether the handle's track is keyed in place of the pose
    deletes: bool  # whether a click without a rotation deletes the handle
    moved: bool = False

    @classmethod
    def has_gizmo_at(cls, session: Session, project: Project, spot: PointerHit) -> bool:
        found = find_ring(session, project)
        return found is not None and abs(abs(spot.place - found[0]) - RING * spot.em) < (
            BAND * spot.em
        )

    @classmethod
    def hints(cls, session: Session, project: Project, spot: PointerHit) -> tuple[Hint, ...]:
        if spot.on_gizmo and len(project.selection.handles) == 1:
            (handle,) = project.selection.handles
            is_alone = draggable_track(project, handle) is not None
            text = _("drag to turn the shape around the handle")
            return (Hint(_("drag to key this handle's rotation only") if is_alone else text),)
        is_recorded = session.tools.mode == "record"
        if spot.handle is None or is_recorded or project.layer.is_locked(spot.handle):
            return ()
        # The hint names the ring, since many window managers take Alt+drag.
        return (Hint(_("drag its ring to turn")),)

    @classmethod
    def press(cls, session: Session, project: Project, spot: PointerHit) -> Self | None:
        """Grab the ring around the selected handle, or a handle with Alt."""
        shown = project.layer_runtime.shown
        is_by_key = spot.handle is not None and spot.alt and not (spot.ctrl or spot.shift)
        is_by_ring = spot.on_gizmo and len(project.selection.handles) == 1
        if shown is None or not (is_by_key or is_by_ring):
            return None
        handle = spot.handle if is_by_key else next(iter(project.selection.handles))
        identities = [handle.id for handle in shown.clip.layer.handles]
        if handle is None or handle not in identities or project.layer.is_locked(handle):
            return None
        index = identities.index(handle)
        on_track = draggable_track(project, handle) is not None
        frame = playback.current_frame(session, project)
        target_angle = track_target_angle(project, handle, frame) if on_track else None
        centre = complex(shown.handle_positions[index])
        rotating = cls(
            project=project,
            handle=handle,
            start=spot.place,
            turning=Turning(centre=centre, start=spot.place),
            turn=shown.handle_rotations[index] if target_angle is None else target_angle,
            on_track=on_track,
            deletes=is_by_key,
        )
        editing.select_handles(session, frozenset({handle}))
        return rotating

    def move(self, session: Session, place: complex) -> None:
        """Rotate the shape by the pointer's angle around the handle; it may snap to steps."""
        if not (self.moved or self.is_away(session, self.start, place)):
            return
        turning = self.turning
        if not self.moved:
            scale = self.project.view_on(session.display.screen).scale
            if abs(turning.start - turning.centre) * scale < LEAST_ARM:
                # After a press this near, the rotation begins where the pointer leaves.
                turning.start = place
        self.moved = True
        if turning.follow(place, snaps=session.tools.is_snapping):
            self._turn(session)

    def type(self, session: Session, characters: str) -> None:
        """Rotate the shape by the typed degrees."""
        if self.turning.type(characters):
            self.moved = True
            self._turn(session)

    def _turn(self, session: Session) -> None:
        handle, swept = self.handle, self.turning.angle
        if handle not in {each.id for each in self.project.layer.handles}:
            return
        if self.on_track:
            rotate_track_handle(session, handle, self.turn + swept, gesture=self)
            return

        def turned(start: DragStart, targets: Mapping[int, Target]) -> Mapping[int, Target]:
            if handle not in targets:
                return {}
            place, turn = start.places[handle], start.angles[handle] + swept
            return {handle: Target(position=place, rotation=turn)}

        drag_handles(session, turned, gesture=self)

    def end(self, session: Session, _: complex) -> None:
        """End the rotation; delete the handle after a mere click."""
        if self.deletes and not self.moved:
            remove_handles(session, frozenset({self.handle}))
        self.project.history.release(self)

    @classmethod
    def idle_shapes(
        cls, session: Session, project: Project, spot: PointerHit
    ) -> Iterable[OverlayShape]:
        """Return the ring around the only selected handle, with a knob at the shape's top."""
        found = find_ring(session, project) if session.tools.active_tool is None else None
        return () if found is None else _ring(*found, spot.em, is_hot=spot.on_gizmo)

    def shapes(self, _place: complex, em: float) -> Iterable[OverlayShape]:
        """Return the dragged ring with its angle, and the typed text."""
        centre = handle_places(self.project).get(self.handle, self.turning.centre)
        turn = self.turn + self.turning.angle
        top = centre + RING * em * cmath.exp(1j * turn) * 1j
        return [
            *_ring(centre, turn, em, is_hot=True),
            LineShape(points=[centre, top]),
            TagShape(text=self.turning.text, place=centre + (RING + 0.8) * em * 1j),
            *self.turning.entry_shapes(centre),
        ]

    @property
    def active_hints(self) -> tuple[Hint, ...]:
        return (Hint(_("turn in steps of 15°"), "shift"), Hint(_("type a number of degrees")))


def find_ring(session: Session, project: Project) -> tuple[complex, float] | None:
    """Return the place and the rotation of the only selected handle, if it can be rotated."""
    shown, selected = project.layer_runtime.shown, project.selection.handles
    is_idle = (
        session.tools.is_posing
        and session.tools.mode != "record"
        and project.timeline.playhead.since is None
    )
    if shown is None or len(selected) != 1 or not (is_idle and session.display.overlays.handles):
        return None
    (handle,) = selected
    identities = [each.id for each in shown.clip.layer.handles]
    if handle not in identities or project.layer.is_locked(handle):
        return None
    index = identities.index(handle)
    return complex(shown.handle_positions[index]), float(shown.handle_rotations[index])


def _ring(centre: complex, turn: float, em: float, *, is_hot: bool) -> list[OverlayShape]:
    """Return the ring around a handle, with a knob at the shape's top."""
    role: ColourRole = "accent" if is_hot else "text"
    top = centre + RING * em * cmath.exp(1j * turn) * 1j
    opacity = 1.0 if is_hot else 0.55
    return [
        CircleShape(centre=centre, radius=RING * em, role=role, opacity=opacity),
        KnobShape(centre=top, radius=KNOB * em, role=role),
    ]
