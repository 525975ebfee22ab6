"""Tool that poses: a press on the shape adds a handle, and drags move handles.

While Ctrl is held, a dragged end of a limb turns its last bone alone (forward kinematics).

If the row of a handle's track is selected, the drag keys the track or is recorded.
"""

from collections.abc import Iterable, Mapping
from dataclasses import dataclass, field, replace
from typing import Self

from app.document import Target
from app.editor.actions import editing, playback
from app.editor.actions.posing.handles import add_handle
from app.editor.actions.posing.limb_editing import turn_last_bones
from app.editor.actions.posing.pose_drag import drag_handles, release_drag_forced
from app.editor.actions.tracking.recording import (
    discard_recording,
    drag_recorded_handle,
    start_recording,
    stop_recording,
)
from app.editor.actions.tracking.track_dragging import (
    drag_track_handle,
    draggable_track,
)
from app.editor.actions.tracking.track_space import track_target
from app.editor.overlay_shapes import OverlayShape
from app.editor.parts.tools import Hint
from app.editor.project import Project
from app.editor.session import Session
from app.editor.tools.numeric_entry import NumericEntry
from app.editor.tools.select_tools import pressed_other_layer
from app.editor.tools.tool import PointerHit, Tool, movable_handles, to_scene
from app.editor.work.drag_session import DragStart
from app.texts import _
from engine.deform import BoundedPull


@dataclass(slots=True, kw_only=True, eq=False)
class PoseTool(Tool):
    """The pointer drags handles."""

    start: complex  # place of the press
    dragged: frozenset[int] = frozenset()  # ids of the dragged handles
    taken: int | None = None  # the existing handle under the press
    at_target: bool = False  # whether the drag begins at the targets and not at the handles
    entry: NumericEntry = field(default_factory=NumericEntry)  # typed offset
    place: complex | None = None  # place of the pointer; None before it has moved
    moved: bool = False  # whether it moved farther than in a click, or an offset was typed
    # The handle whose track is keyed in place of the pose, and its place at the start.
    tracked: int | None = None
    origin: complex = 0j
    # Whether the drag is recorded; then places are in the scene, where the body moves.
    records: bool = False
    stood: int | None = None  # the playhead's frame before it went to a key of the path

    @classmethod
    def hints(cls, session: Session, project: Project, spot: PointerHit) -> tuple[Hint, ...]:
        if spot.handle is not None:
            if project.layer.is_locked(spot.handle):
                return (Hint(_("click to select the locked handle")),)
            if session.tools.mode == "record":
                return (Hint(_("drag to record the motion")),)
            on_track = draggable_track(project, spot.handle) is not None
            return (Hint(_("drag to key this handle only") if on_track else _("drag to pose")),)
        if spot.track_key is not None:
            text = _("drag to move the key at frame {frame}")
            return (Hint(text.format(frame=spot.track_key)),)
        adds = spot.on_shape and session.display.overlays.handles and not project.layer.still
        is_used = spot.on_gizmo or pressed_other_layer(project, spot) is not None
        if adds and not (is_used or session.tools.mode == "record"):
            return (Hint(_("click to add a handle")),)
        return ()

    @classmethod
    def press(cls, session: Session, project: Project, spot: PointerHit) -> Self | None:
        """Grab a handle with all selected handles, or add a handle."""
        if spot.ctrl or spot.shift or spot.on_gizmo:
            return None
        if spot.handle is not None:
            return None if spot.alt else cls._take(session, project, spot, spot.handle)
        if spot.track_key is not None and project.selected_track is not None:
            pulling = cls(project=project, start=spot.place)
            pulling._take_key(session, project.selected_track, spot.track_key)
            return pulling
        if (
            not spot.on_shape
            or not session.display.overlays.handles
            or session.tools.mode == "record"
        ):
            return None
        pulling = cls(project=project, start=spot.place)
        add_handle(session, spot.place, gesture=pulling)
        pulling.dragged = project.selection.handles
        return pulling

    @classmethod
    def _take(cls, session: Session, project: Project, spot: PointerHit, handle: int) -> Self:
        pulling = cls(project=project, start=spot.place, taken=handle, at_target=spot.at_target)
        if handle not in project.selection.handles:
            editing.select_handles(session, project.layer.grouped_handles(handle))
        pulling.dragged = movable_handles(project)
        if handle in pulling.dragged:
            pulling._take_to_track(session, handle)
        return pulling

    def _take_to_track(self, session: Session, pressed: int) -> None:
        """Drag on the handle's track if its row is selected or the drag is recorded."""
        project, shown = self.project, self.project.layer_runtime.shown
        track = draggable_track(project, pressed)
        if session.tools.mode == "record":
            track = project.layer.track_of(pressed)
        elif track is None:
            return
        if shown is None:
            return
        self.tracked = pressed if track is None else track.handles[0]
        identities = [handle.id for handle in shown.clip.layer.handles]
        self.origin = complex(shown.handle_positions[identities.index(self.tracked)])
        if self.at_target and shown.correction is not None:
            self.origin = shown.correction.targets.get(self.tracked, self.origin)
        if session.tools.mode == "record":
            self.records = True
            self.start, self.origin = (
                to_scene(project, each) for each in (self.start, self.origin)
            )
            start_recording(session, self.tracked, self.origin, gesture=self)

    def _take_key(self, session: Session, handle: int, frame: int) -> None:
        """Grab the track key shown at a frame; the playhead goes there."""
        project, track = self.project, self.project.layer.track_of(handle)
        place = None if track is None else track_target(project, track, frame)
        if track is not None and place is not None:
            self.tracked, self.origin = track.handles[0], place
            self.stood = playback.current_frame(session, project)
            playback.scrub(session, frame)

    def move(self, session: Session, place: complex) -> None:
        """Move the handles' targets by the pointer's offset; target rotations stay."""
        self.place = to_scene(self.project, place) if self.records else place
        self.moved = self.moved or self.is_away(session, self.start, self.place)
        self._pull(session)

    def type(self, session: Session, characters: str) -> None:
        """Move the handles by the typed offset or along an axis; a recorded drag ignores typing."""
        if self.records:
            return
        self.entry.type(characters)
        self.moved = self.moved or self.entry.value is not None
        self._pull(session)

    @property
    def offset(self) -> complex:
        """The pointer's offset, or the typed one."""
        return self.entry.constrain_offset(
            (self.start if self.place is None else self.place) - self.start
        )

    def _pull(self, session: Session) -> None:
        if self.tracked is not None:
            place = self.origin + self.offset
            if self.records:
                drag_recorded_handle(session, place)
            elif self.moved:
                drag_track_handle(session, self.tracked, place, gesture=self)
            return
        pulled = self.dragged & {handle.id for handle in self.project.layer.handles}
        if not (self.moved and pulled):
            return
        way, turns_bones = self.offset, session.tools.is_snapping
        layer = self.project.layer

        def as_far(start: DragStart, targets: Mapping[int, Target]) -> Mapping[int, Target]:
            wanted = {i: target.position for i, target in start.targets.items()}
            places = wanted if self.at_target else start.places
            known = pulled & targets.keys()
            moved = {i: replace(targets[i], position=places[i] + way) for i in known}
            return turn_last_bones(layer, start, moved) if turns_bones else moved

        drag_handles(session, as_far, gesture=self, hand=BoundedPull(pulled))

    def end(self, session: Session, _: complex) -> None:
        """Release the handles; forced targets stay beyond the handles' reach.

        A click selects only the handle under it, or its group.
        """
        if self.records:
            stop_recording(session, has_moved=self.moved)
        elif session.tools.is_forcing_targets:
            release_drag_forced(session)
        else:
            self.project.history.release(self)
        shown = self.project.layer_runtime.shown
        if self.moved and self.tracked is None and shown is not None:
            self.project.selection.move_pivot(self.offset * shown.placement.factor)
        if not self.moved and self.taken is not None:
            editing.select_handles(session, self.project.layer.grouped_handles(self.taken))

    def cancel(self, session: Session) -> None:
        """Undo the drag; the playhead goes back to its earlier frame."""
        if self.records:
            discard_recording(session)
        if self.stood is not None:
            playback.seek(session, self.stood)
        super(PoseTool, self).cancel(session)

    @classmethod
    def mode(cls, session: Session, _project: Project) -> str:
        return _("Recording the next drag of a handle") if session.tools.mode == "record" else ""

    def shapes(self, _place: complex, _em: float) -> Iterable[OverlayShape]:
        return self.entry.shapes(self.start, "px")

    @property
    def active_hints(self) -> tuple[Hint, ...]:
        if self.records:
            return (Hint(_("let go to end the recording")),)
        typed = (Hint(_("type a number of pixels")), Hint(_("X or Y to lock to an axis")))
        if self.tracked is not None:
            return typed
        return (*typed, Hint(_("let go to keep the target where the pointer is"), "alt"))
