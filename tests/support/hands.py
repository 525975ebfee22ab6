"""Hands that change a project in every way that a drag can, without a pointer."""

from collections.abc import Callable
from dataclasses import dataclass, field, replace

from app.document import CAMERA, OPACITY, Camera, Channel, camera_at, pose_channel
from app.editor.actions.posing.pose_drag import drag_handles, move_pose
from app.editor.actions.timing import channel_keys, timeline_drag
from app.editor.actions.tracking.track_dragging import drag_track_handle, rotate_track_handle
from app.editor.parts.timeline.gestures import CycleDrag, EdgeDrag, KeyDrag
from app.editor.parts.timeline.time_range import TimeRangeView
from app.editor.poses import flipping
from app.editor.session import Session
from app.editor.tools import tool_pointer
from app.editor.tools.tool import PointerHit
from engine.deform import BoundedPull

VIEW = TimeRangeView(0.0, 48.0)
WIDGET = 7


@dataclass(eq=False)
class Hand:
    """A hand that changes the active layer, or its scene, by amounts from 1 on.

    `call` runs a verb on the session, by default at once.
    """

    session: Session
    call: Callable[..., None] = None
    drag: object = field(default_factory=object)

    def __post_init__(self):
        self.call = self.call or (lambda verb, *args, **words: verb(self.session, *args, **words))
        self.project = self.session.project
        self.layer = self.project.layer
        self.frame = self.project.timeline.playhead.frame

    @property
    def is_possible(self) -> bool:
        return True

    def press(self) -> None:
        """Begin."""

    def move(self, amount: float) -> None:
        raise NotImplementedError

    def let_go(self) -> None:
        self.call(lambda session: session.project.history.release(self.drag))

    @property
    def size(self) -> float:
        return abs(complex(*self.project.document.canvas))


class PoseHand(Hand):
    @property
    def is_possible(self):
        return bool(self.layer.handles) and self.project.layer_runtime.shown is not None

    def press(self):
        self.handle = self.layer.handles[-1].id

    def move(self, amount):
        way = 0.03j * amount * self.size

        def moved(start, targets):
            known = {self.handle} & targets.keys()
            return {i: replace(targets[i], position=start.places[i] + way) for i in known}

        pull = BoundedPull(frozenset({self.handle}))
        self.call(drag_handles, moved, gesture=self.drag, hand=pull)


class MoveHand(PoseHand):
    def move(self, amount):
        self.call(move_pose, 0.02 * amount * self.size, gesture=self.drag)


class KeyHand(Hand):
    def press(self):
        key = self.layer.keys[-1].frame
        self.keys = {pose_channel(self.layer.id): frozenset({key})}
        options = {"pressed": key, "mark": self.keys, "copies": False}
        channel = pose_channel(self.layer.id)
        self.begin(KeyDrag(start=key, keys=self.keys, channel=channel, **options))

    def begin(self, drag):
        self.start = drag.start
        self.call(timeline_drag.begin_timeline_drag, drag, VIEW)

    def move(self, amount):
        frame, channel = self.start + amount, pose_channel(self.layer.id)
        self.call(timeline_drag.move_timeline_drag, frame, channel)

    def let_go(self):
        self.call(timeline_drag.end_timeline_drag)


class EndHand(KeyHand):
    def press(self):
        self.begin(EdgeDrag(start=self.project.document.frames.last, edge="animation end"))


class CycleHand(KeyHand):
    @property
    def is_possible(self):
        return bool(self.layer.cycles)

    def press(self):
        cycle = self.layer.cycles[0]
        options = {"layer": self.layer.id, "first": cycle.first, "is_stretch": True}
        self.begin(CycleDrag(start=cycle.last, **options))


class SliderHand(Hand):
    def press(self):
        self.call(tool_pointer.note_widget_in_use, WIDGET, is_pressed=True)

    def move(self, amount):
        channel = Channel(OPACITY, self.layer.id)
        self.call(channel_keys.set_channel_value, channel, 1 / (1 + amount))

    def let_go(self):
        self.call(tool_pointer.note_widget_in_use, 0, is_pressed=False)


class CameraHand(SliderHand):
    def move(self, amount):
        shot = camera_at(self.project.document, self.frame) or Camera(0j)
        shot = replace(shot, zoom=1 + 0.1 * amount)
        self.call(channel_keys.set_channel_value, Channel(CAMERA), shot)


class TrackHand(Hand):
    @property
    def is_possible(self):
        return bool(self.layer.tracks) and self.project.layer_runtime.shown is not None

    def press(self):
        self.handle = self.layer.tracks[0].handles[0]
        shown = self.project.layer_runtime.shown
        identities = [handle.id for handle in shown.clip.layer.handles]
        places = dict(zip(identities, shown.handle_positions, strict=True))
        self.place = complex(places.get(self.handle, 0j))

    def move(self, amount):
        place = self.place + 0.02j * amount * self.size
        self.call(drag_track_handle, self.handle, place, gesture=self.drag)


class TurnHand(TrackHand):
    def move(self, amount):
        if self.handle in [handle.id for handle in self.project.layer.handles]:
            self.call(rotate_track_handle, self.handle, 0.1 * amount, gesture=self.drag)


class AxisHand(Hand):
    def move(self, amount):
        self.call(flipping.move_mirror_axis, 0.4 * self.size + amount, self.drag)


class BrushHand(Hand):
    """A stroke of a brush; the document has it from the release on."""

    mode = "stiff"

    @property
    def is_possible(self):
        return self.project.layer_runtime.shown is not None

    def press(self):
        self.place = complex(self.layer.domain.mesh.vertices[0])
        self.call(lambda session: session.tools.select(self.mode))
        self.call(tool_pointer.press_pointer, PointerHit(place=self.place, on_shape=True))

    def move(self, amount):
        self.place += 0.02 * amount * self.size
        self.call(tool_pointer.move_pointer, self.place)

    def let_go(self):
        self.call(tool_pointer.release_pointer, self.place)
        self.call(lambda session: session.tools.leave(self.mode))


class CutHand(BrushHand):
    mode = "keep"


HANDS = {
    "pose": PoseHand,
    "move": MoveHand,
    "keys": KeyHand,
    "end": EndHand,
    "cycle": CycleHand,
    "slider": SliderHand,
    "camera": CameraHand,
    "track": TrackHand,
    "turn": TurnHand,
    "axis": AxisHand,
    "brush": BrushHand,
    "cut": CutHand,
}
