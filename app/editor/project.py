"""The project that is open: its document, what the window has of it, and what is under way."""

from collections.abc import Iterable, Sequence
from dataclasses import dataclass, field, replace
from math import inf
from pathlib import Path

import numpy as np

from app.document import (
    Baseline,
    Clip,
    Document,
    History,
    Keyframe,
    Layer,
    Meshing,
    PictureFile,
    Playhead,
    Pose,
    PreviewPose,
    Track,
    TreeRow,
    Variant,
    camera_at,
    clip_of,
    layer_tree,
    transform_at,
)
from app.editor.timeline_view import KeyRow, KeysByRow, TimelineState, TrackRow, row_of
from app.editor.work import (
    Afterwards,
    ComparisonRuntime,
    Derived,
    LayerRuntime,
    MotionJob,
    MotionSetup,
    Promise,
    Pull,
    Recording,
    TrackDrag,
)
from app.motion import (
    BoundingBox,
    MotionPaths,
    ParentTransforms,
    PoseSampler,
    parenting_key,
)
from app.render import View, fit_view
from app.reports import Curves
from app.solving import KeyResolver
from app.storage import FileLock, Picture, SourceInfo
from engine.geometry import RigidMotion
from engine.maps import Bounds

EXTENTS = 32  # of the motion, which are remembered for undo and redo
# Bytes of what layers that nobody edits may be prepared with, once series show them.
MOST_RELEASABLE_BYTES = 64 * 2**20
FIT_MARGIN = 0.08  # of the viewport, left free around what is fitted into it


@dataclass(frozen=True, slots=True, kw_only=True, eq=False)
class LastFlip:
    """What was flipped last.

    The `keys` are as they were copied; `poses` took their place in a layer, at its `frames`.
    """

    layer: int
    keys: tuple[Keyframe, ...]
    frames: frozenset[int]
    poses: tuple[Pose, ...]


@dataclass(frozen=True, slots=True, kw_only=True, eq=False)
class BlendPreview:
    """A pose of a layer's library, by its name, that is mixed into the one at a frame.

    Its `share` goes from 0 to 1; all that is mixed in one gesture is one step of undo.
    """

    name: str
    owner: int
    gesture: object
    share: float = 0.0


@dataclass(slots=True, kw_only=True, eq=False)
class Project:
    """The document that is open, and how the person looks at it."""

    history: History
    name: str  # of the picture or the project, without its suffix
    path: Path | None  # of the project file; None for a new one
    # The files that its pictures were read from, which nothing is written over.
    drawings: set[Path] = field(default_factory=set)
    is_import_log_open: bool = False  # whether the panel of layers shows what was told of them
    file_lock: FileLock | None = None  # by which other windows see that the file is open here
    # What the file held when it was opened or saved here last; None for a new one.
    read_as: str | None = None
    # Whether it is unsaved work of an earlier time, not saved before the person has seen where.
    is_recovered: bool = False
    # The document and the pose that no key holds, as the autosave has them, and the clock's seconds
    # when it got them, and when what is here was first seen to differ.
    autosaved: tuple[Document, PreviewPose | None] | None = None
    autosaved_at: float = 0.0
    changed_at: float | None = None

    layer_runtimes: dict[int, LayerRuntime]  # one for each layer, by its id
    # Those that are decoded, of layers that come back by undo among them.
    pictures: dict[PictureFile, Picture] = field(default_factory=dict)
    active: int  # the id of the layer whose handles and keys are shown and changed
    pending: list[Promise] = field(default_factory=list)  # all on its way to the document
    # What decided which jobs are due, when that was looked at last.
    polled: tuple[object, ...] = ()
    # On what it depended what is drawn, when that was settled last.
    settled: tuple[object, ...] = ()
    afterwards: list[Afterwards] = field(default_factory=list)  # what is done once it is there
    # Commands given during a gesture make one step of undo together; it is that of a widget.
    gesture: object | None = None
    used_widget: int = 0

    # Distortion over time, of the active layer and of its twin.
    curves: Derived[Clip, Curves | None] = field(default_factory=lambda: Derived(None))
    comparison_curves: Derived[Clip, Curves | None] = field(default_factory=lambda: Derived(None))
    # Of the active layer's handles; they are traced while they are shown.
    paths: Derived[Clip, MotionPaths | None] = field(default_factory=lambda: Derived(None))
    # Of the layers that hang on others; `hung` has those of the document as it is now.
    parent_transforms: Derived[tuple[object, ...], ParentTransforms | None] = field(
        default_factory=lambda: Derived(None)
    )
    # Of the motion; where the settings of an export are shown it is measured first, else last.
    extent: Derived[tuple[object, ...], BoundingBox | None] = field(
        default_factory=lambda: Derived(None, remembers=EXTENTS)
    )

    # What the domain will be rebuilt with; None as long as that is what it has.
    meshing: Meshing | None = None
    previewed_limits: Bounds | None = None  # what the person drags them to
    # The layer whose domain is older than its cut-out, and the clock's seconds when it was seen.
    stale: tuple[Layer, float] | None = None
    unbuildable: Layer | None = None  # one whose cut-out is known to give no domain
    brush: float | None = None  # radius in pixels of the picture; None until somebody chooses it
    # Where the next export of a format goes: as its last one, or as was told; the newest last.
    export_destinations: dict[str, Path] = field(default_factory=dict)
    # The format and the place of one that may take the place of other files: the person agreed, or
    # they are an export's.
    replaceable: tuple[str, Path] | None = None

    playhead: Playhead = field(default_factory=Playhead)
    moved_at: float = -inf  # the clock's seconds when the playhead was last seen to move
    timeline: TimelineState = field(default_factory=TimelineState)
    selected_handles: frozenset[int] = frozenset()  # ids of handles
    # The chosen keys; rows without any are not in it.
    selected_keys: KeysByRow = field(default_factory=dict)
    track_row: TrackRow | None = None  # that of a track which is chosen
    motion_setup: MotionSetup | None = None  # a motion that is about to be given
    last_motion_setup: MotionSetup | None = None  # that was put away, or was given
    recording: Recording | None = None  # a drag that is recorded, until that is kept or given up
    camera: View | None = None  # None fits the picture into the viewport
    is_camera_view: bool = False  # whether the viewport shows what the scene's camera does
    awaits_extent: bool = False  # whether the camera fits the motion once that is measured
    last_flip: LastFlip | None = None
    blend_preview: BlendPreview | None = None
    picked_pose: tuple[int, str] | None = None  # whose, by its id, and its name in the library
    # The ids of layers that are chosen beside the one that is posed, and of those that alone are
    # looked at, if any.
    other_selected_layers: frozenset[int] = frozenset()
    solo: frozenset[int] = frozenset()
    toggled_rows: frozenset[str] = frozenset()  # rows of the tree of layers, open or closed by hand
    dismissed_suggestions: frozenset[str] = frozenset()  # groups of which no choice is to be made
    # Layers that were posed, and whose rows stay until the pointer is over the drawing again.
    lingering: frozenset[int] = frozenset()
    last_listed_layer: int | None = None  # the layer that the list of layers was scrolled to
    # Those of the list of layers; of a document, what is toggled in it, and what is kept in it.
    tree_rows: Derived[tuple[Document, frozenset[str], frozenset[int]], tuple[TreeRow, ...]] = (
        field(default_factory=lambda: Derived(()))
    )

    @property
    def document(self) -> Document:
        """The document as it is now."""
        return self.history.document

    @property
    def origin(self) -> SourceInfo:
        """What is kept with its changes, so that they are found again under their name."""
        return SourceInfo(self.name, self.path)

    @property
    def layer(self) -> Layer:
        """The layer that is posed, as it is now."""
        return self.document.layer(self.active)

    @property
    def tree(self) -> tuple[TreeRow, ...]:
        """The rows of the layers that are listed, the one in front on top."""
        source = self.document, self.toggled_rows, self.lingering | {self.active}
        if not self.tree_rows.follows(source):
            self.tree_rows.set(source, layer_tree(*source))
        return self.tree_rows.value

    @property
    def selected_layers(self) -> tuple[int, ...]:
        """The ids of the chosen layers, from front to back; the one that is posed is among them."""
        chosen = self.other_selected_layers | {self.active}
        return tuple(each.id for each in reversed(self.document.layers) if each.id in chosen)

    @property
    def rows(self) -> list[KeyRow]:
        """The rows of the timeline from top to bottom: the layer in front comes first."""
        rows: list[KeyRow] = []
        for layer in (row.layer for row in self.tree if row.layer):
            rows.append(layer.id)
            if layer.id in self.timeline.expanded_layers:
                rows += [row_of(layer, track) for track in layer.tracks]
        return rows

    def track_in(self, row: KeyRow) -> Track | None:
        """Return the track of a row; None where it is of poses, or not there any more."""
        if not isinstance(row, TrackRow) or row.layer not in self.layer_runtimes:
            return None
        return self.document.layer(row.layer).track_of(row.handle)

    @property
    def selected_frames(self) -> frozenset[int]:
        """The frames of the chosen keys of the active layer's poses.

        Setting them lets all others go.
        """
        return self.selected_keys.get(self.active, frozenset())

    @selected_frames.setter
    def selected_frames(self, frames: frozenset[int]) -> None:
        self.selected_keys = {self.active: frames} if frames else {}

    @property
    def selected_track(self) -> int | None:
        """The id of the handle whose track's row is chosen, of the layer that is posed.

        None where its whole pose's row is. Setting it chooses a row.
        """
        row = self.track_row
        if row is None or row.layer != self.active or self.layer.track_of(row.handle) is None:
            return None
        return row.handle

    @selected_track.setter
    def selected_track(self, handle: int | None) -> None:
        self.track_row = None if handle is None else TrackRow(self.active, handle)

    @property
    def row(self) -> KeyRow:
        """The row that is chosen: of the poses of the layer that is posed, or of a track of it."""
        handle = self.selected_track
        return row_of(self.layer, None if handle is None else self.layer.track_of(handle))

    @property
    def selected_key_count(self) -> int:
        """How many keys are chosen, in all rows."""
        return sum(map(len, self.selected_keys.values()))

    @property
    def sources(self) -> tuple[Path, ...]:
        """The files that it was read from."""
        return (*self.drawings, *([] if self.path is None else [self.path]))

    def keys_with(self, row: KeyRow, frame: int) -> KeysByRow:
        """Return the chosen keys of all rows, if a key is one of them, or else that key."""
        if frame in self.selected_keys.get(row, ()):
            return self.selected_keys
        return {row: frozenset({frame})}

    @property
    def clip(self) -> Clip:
        """The layer that is posed, in the time of its scene."""
        return clip_of(self.document, self.active)

    @property
    def layer_runtime(self) -> LayerRuntime:
        """The layer that is posed, as the window has it."""
        return self.layer_runtimes[self.active]

    @property
    def samplers(self) -> dict[int, PoseSampler]:
        """What is known of the layers' outlines, by their ids."""
        samplers = {layer: puppet.store.sampler for layer, puppet in self.layer_runtimes.items()}
        return {layer: sampler for layer, sampler in samplers.items() if sampler is not None}

    @property
    def is_crowded(self) -> bool:
        """Whether layers that nobody edits hold much that `Puppet.rest` lets go, or will."""
        return (
            sum(puppet.releasable_bytes(clip) for clip, puppet in self._unedited())
            > MOST_RELEASABLE_BYTES
        )

    def free_memory(self) -> None:
        """Let go of what layers that nobody edits were made with, as long as that is much."""
        unedited = self._unedited()
        held = {puppet: puppet.releasable_bytes(clip) for clip, puppet in unedited}
        for clip, puppet in unedited:
            if sum(held.values()) <= MOST_RELEASABLE_BYTES:
                return
            puppet.release_intermediates(clip)
            held[puppet] = puppet.releasable_bytes(clip)

    def _unedited(self) -> list[tuple[Clip, LayerRuntime]]:
        return [
            (clip_of(self.document, layer), puppet)
            for layer, puppet in self.layer_runtimes.items()
            if layer != self.active
        ]

    @property
    def unkeyed_pose(self) -> Pose | None:
        """The pose that is shown though no key holds it; None where there is none at this frame."""
        unkeyed = self.history.preview_pose
        if unkeyed is None or unkeyed.layer != self.active or self.playhead.since is not None:
            return None
        here = self.layer.source_of(self.playhead.frame)
        return unkeyed.pose if unkeyed.frame == here else None

    @property
    def pulls(self) -> list[Pull]:
        """The poses that are on their way, in the order in which they were begun."""
        return [promise for promise in self.pending if isinstance(promise, Pull)]

    @property
    def track_drags(self) -> list[TrackDrag]:
        """The handles that hands want elsewhere by their tracks, which have no such keys yet."""
        return [promise for promise in self.pending if isinstance(promise, TrackDrag)]

    @property
    def pull(self) -> Pull | None:
        """The one on its way that is shown of the layer that is posed."""
        if self.playhead.since is not None:
            return None
        here = (self.active, self.layer.source_of(self.playhead.frame))
        mine = [pull for pull in self.pulls if (pull.layer, pull.frame) == here]
        return mine[-1] if mine else None

    @property
    def is_posing(self) -> bool:
        """Whether the document has a pose that is on its way, or is to have the first."""
        return any(pull.is_in(self.history) for pull in self.pulls)

    @property
    def key_resolver(self) -> KeyResolver | None:
        """Keys that are being solved again, as far as that is."""
        return next(
            (promise.key_resolver for promise in self.pending if promise.key_resolver), None
        )

    @property
    def motion_job(self) -> MotionJob | None:
        """A motion on its way to a layer."""
        return next((promise.motion_job for promise in self.pending if promise.motion_job), None)

    @property
    def stale_layer(self) -> Layer | None:
        """One whose domain is older than its cut-out, and will be built anew."""
        layers = self.document.layers
        stale = next((each for each in layers if each.is_stale and not each.still), None)
        return None if stale is self.unbuildable else stale

    @property
    def current_parent_transforms(self) -> ParentTransforms | None:
        """The joints of the document as it is now; None where there are none, or not yet."""
        follows = self.parent_transforms.follows(parenting_key(self.document))
        return self.parent_transforms.value if follows else None

    def placements(self, frames: Iterable[int], unknown: RigidMotion) -> list[RigidMotion]:
        """Return where the layer that is posed is at some frames: `unknown` till that is known."""
        frames = list(frames)
        return self.placed_at(self.active, frames) or [unknown for _ in frames]

    def placed_at(self, layer: int, frames: Sequence[int]) -> list[RigidMotion] | None:
        """Return where a layer, by its id, is at some frames; None till that is known.

        While it is posed itself, it hangs as before: its joint holds.
        """
        own, joints = self.document.layer(layer), self.current_parent_transforms
        if not own.attachments:
            return [transform_at(self.document, own, frame) for frame in frames]
        if joints is None and (before := self.parent_transforms.value) is not None:
            joints = before if self._has_same_parents(before.document, own) else None
        return None if joints is None else [joints.placement(layer, frame) for frame in frames]

    def _has_same_parents(self, before: Document, layer: Layer) -> bool:
        """Tell whether a layer hangs on the very same others as in an earlier document."""
        was = {each.id: each for each in before.layers}
        document, own = self.document, was.get(layer.id)
        return (
            own is not None
            and (before.frames, before.loop) == (document.frames, document.loop)
            and (own.attachments, own.anchor, own.domain, own.transform_keys, own.cycles)
            == (layer.attachments, layer.anchor, layer.domain, layer.transform_keys, layer.cycles)
            and all(was.get(each.id) is each for each in document.all_ancestors(layer.id))
        )

    def update_comparisons(self, method: Variant | Baseline | None) -> None:
        """Let each layer have a twin by a method, or none."""
        for layer in self.document.layers:
            puppet = self.layer_runtimes[layer.id]
            if method is None:
                puppet.comparison = None
                continue
            twin = puppet.comparison or ComparisonRuntime(
                original=layer, layer=layer, method=layer.variant
            )
            if twin.original is not layer or twin.method is not method:
                twin.original, twin.method = layer, method
                twin.layer = (
                    layer if isinstance(method, Baseline) else replace(layer, variant=method)
                )
            puppet.comparison = twin

    def view(self, screen: tuple[int, int]) -> View:
        """Return what the viewport shows on a screen of this size in pixels."""
        whole = fit_view_around(BoundingBox(0j, complex(*self.document.canvas)), screen)
        shown = self.layer_runtime.shown
        shot = camera_at(self.document, self.playhead.frame if shown is None else shown.frame)
        if self.is_camera_view and shot is not None:
            turn = complex(np.exp(1j * shot.turn))
            return replace(whole, centre=shot.centre, scale=whole.scale * shot.zoom, turn=turn)
        return whole if self.camera is None else replace(self.camera, size=screen)


def fit_view_around(box: BoundingBox, screen: tuple[int, int]) -> View:
    """Return the view of a box on a screen of this size in pixels, with some room around it."""
    return fit_view(*box, screen, margin=FIT_MARGIN * min(screen))
