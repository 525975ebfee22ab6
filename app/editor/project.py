"""The open project: its document, its runtime values, and the person's view of it."""

from collections.abc import Iterable, Sequence
from dataclasses import dataclass, field, replace
from typing import Any

import numpy as np

from app.document import (
    CAMERA,
    MARKER,
    SWITCH,
    VOLUME,
    Baseline,
    Channel,
    Clip,
    Document,
    History,
    Layer,
    Pose,
    TreeRow,
    Variant,
    camera_at,
    channels_of,
    clip_of,
    footage_picture_at,
    keys_in,
    pose_channel,
    track_in,
)
from app.editor.parts.export_state import ExportDestinations
from app.editor.parts.layer_list import LayerListState
from app.editor.parts.project_file import ProjectFile
from app.editor.parts.selection import Selection
from app.editor.parts.timeline.graph import GraphState
from app.editor.parts.timeline.timeline_state import TimelineState
from app.editor.parts.viewport_state import ViewportState, fit_view_around
from app.editor.work.drag_session import DragSession
from app.editor.work.layer_runtime import ComparisonRuntime, LayerRuntime, LayerRuntimes
from app.editor.work.layer_setup import LayerSetup
from app.editor.work.measurements import Measurements
from app.editor.work.motion_setup import MotionJob
from app.editor.work.pending_work import PendingWork
from app.editor.work.pose_edits import PoseEdits
from app.editor.work.revised import Revised
from app.editor.work.track_keys import PendingTrackKey
from app.motion import (
    BoundingBox,
    Evaluator,
    PoseSampler,
)
from app.render import View
from app.solving import KeyResolver
from app.storage import FootageCache
from engine.arrays import Bytes
from engine.geometry import Similarity

# Most bytes of intermediate values that inactive layers keep, once they have series.
MOST_RELEASABLE_BYTES = 64 * 2**20


@dataclass(slots=True, kw_only=True, eq=False)
class Project(Revised):
    """The open document, and the person's view of it."""

    history: History
    file: ProjectFile
    selection: Selection
    layer_list: LayerListState = field(default_factory=LayerListState)
    viewport: ViewportState = field(default_factory=ViewportState)
    exports: ExportDestinations = field(default_factory=ExportDestinations)
    runtimes: LayerRuntimes
    footage: FootageCache = field(default_factory=FootageCache)
    pending: PendingWork = field(default_factory=PendingWork)
    measured: Measurements = field(default_factory=Measurements)
    layer_setup: LayerSetup = field(default_factory=LayerSetup)
    pose_edits: PoseEdits = field(default_factory=PoseEdits)
    timeline: TimelineState = field(default_factory=TimelineState)
    graph: GraphState = field(default_factory=GraphState)

    @property
    def document(self) -> Document:
        """The document as displayed: with the preview of an unfinished drag."""
        return self.history.document

    @property
    def layer(self) -> Layer:
        return self.document.layer(self.selection.active)

    @property
    def listed_layer(self) -> Layer:
        """The layer that is selected in the list: the active one, or a member of it."""
        return self.document.layer(self.selection.listed)

    @property
    def tree(self) -> tuple[TreeRow, ...]:
        """Rows of the layer list, the front layer on top."""
        return self.layer_list.rows(self.document, self.selection.listed)

    @property
    def selected_layers(self) -> tuple[int, ...]:
        """Ids of the selected layers from front to back, with the listed layer."""
        chosen = self.selection.other_layers | {self.selection.listed}
        return tuple(each.id for each in reversed(self.document.layers) if each.id in chosen)

    @property
    def lanes(self) -> list[Channel[Any]]:
        """Channels with a lane in the timeline, from top to bottom, the front layer first."""
        document = self.document
        lanes = [Channel(MARKER)] if document.markers else []
        lanes += [Channel(CAMERA)] if document.camera else []
        lanes += [Channel(VOLUME, part=sound.name) for sound in document.sounds]
        for row in self.tree:
            if row.switch_group is not None:
                lanes.append(Channel(SWITCH, part=row.switch_group.name))
            if row.layer is not None:
                lanes += self.lanes_of(row.layer)
        return lanes

    def lanes_of(self, layer: Layer) -> list[Channel[Any]]:
        """Channels of a layer with a lane in the timeline: the poses, then the others if shown."""
        if layer.id not in self.timeline.expanded_layers:
            return [pose_channel(layer.id)]
        return [*channels_of(layer)]

    @property
    def channel(self) -> Channel[Any]:
        """The selected channel: of the scene or of the active layer, by default its poses."""
        chosen, active = self.selection.channel, self.selection.active
        is_shown = chosen is not None and chosen.layer in (None, active, self.selection.listed)
        is_keyed = chosen is not None and bool(keys_in(self.document, chosen))
        return chosen if chosen is not None and is_shown and is_keyed else pose_channel(active)

    @property
    def selected_track(self) -> int | None:
        """The handle id of the selected track of the active layer, if a track is selected."""
        track = track_in(self.document, self.channel)
        return None if track is None else track.handles[0]

    @property
    def clip(self) -> Clip:
        """The active layer in the time of its scene."""
        return clip_of(self.document, self.selection.active)

    @property
    def clips(self) -> list[tuple[Clip, LayerRuntime]]:
        """All layers in the time of their scene, with their runtimes."""
        return [(each.clip(self.document), each) for each in self.runtimes.layers.values()]

    @property
    def layer_runtime(self) -> LayerRuntime:
        """The active layer's runtime."""
        return self.runtimes.layers[self.selection.active]

    @property
    def samplers(self) -> dict[int, PoseSampler]:
        """Pose samplers of the layers, by id."""
        samplers = {layer: runtime.store.sampler for layer, runtime in self.runtimes.layers.items()}
        return {layer: sampler for layer, sampler in samplers.items() if sampler is not None}

    @property
    def is_crowded(self) -> bool:
        """Whether inactive layers hold, or will hold, much memory that can be freed."""
        return (
            sum(runtime.releasable_bytes(clip) for clip, runtime in self._unedited())
            > MOST_RELEASABLE_BYTES
        )

    def free_memory(self) -> None:
        """Free intermediate values of inactive layers while they take much memory."""
        unedited = self._unedited()
        held = {runtime: runtime.releasable_bytes(clip) for clip, runtime in unedited}
        for clip, runtime in unedited:
            if sum(held.values()) <= MOST_RELEASABLE_BYTES:
                return
            runtime.release_intermediates(clip)
            held[runtime] = runtime.releasable_bytes(clip)

    def _unedited(self) -> list[tuple[Clip, LayerRuntime]]:
        return [each for each in self.clips if each[1] is not self.layer_runtime]

    @property
    def unkeyed_pose(self) -> Pose | None:
        """The unkeyed pose of the active layer at this frame, if any."""
        unkeyed = self.history.preview_pose
        if (
            unkeyed is None
            or unkeyed.layer != self.selection.active
            or self.timeline.playhead.since is not None
        ):
            return None
        here = self.layer.source_of(self.timeline.playhead.frame)
        return unkeyed.pose if unkeyed.frame == here else None

    @property
    def drag(self) -> DragSession | None:
        """The unfinished drag of a pose."""
        for change in self.pending.changes:
            if isinstance(change, DragSession):
                return change
        return None

    @property
    def pending_track_keys(self) -> list[PendingTrackKey]:
        """Keys of dragged tracks that wait for their base motion."""
        return [each for each in self.pending.changes if isinstance(each, PendingTrackKey)]

    @property
    def visible_drag(self) -> DragSession | None:
        """The unfinished drag if its pose is the active layer's at the playhead."""
        drag = self.drag
        if drag is None or self.timeline.playhead.since is not None:
            return None
        here = (self.selection.active, self.layer.source_of(self.timeline.playhead.frame))
        return drag if (drag.layer, drag.frame) == here else None

    @property
    def key_resolver(self) -> KeyResolver | None:
        """Keys that are solved again, with progress."""
        return next(
            (change.key_resolver for change in self.pending.changes if change.key_resolver), None
        )

    @property
    def motion_job(self) -> MotionJob | None:
        """The pending motion of a layer."""
        return next(
            (change.motion_job for change in self.pending.changes if change.motion_job), None
        )

    @property
    def stale_layer(self) -> Layer | None:
        """The layer with a domain older than its cut-out that will be rebuilt."""
        layers = self.document.layers
        stale = next((each for each in layers if each.is_stale and not each.still), None)
        return None if stale is self.layer_setup.unbuildable else stale

    @property
    def evaluator(self) -> Evaluator:
        """The evaluator of displayed frames."""
        return Evaluator(
            layers=self.runtimes.layers, transforms=self.measured.parent_transforms.value
        )

    def placements(self, frames: Iterable[int], unknown: Similarity) -> list[Similarity]:
        """Return the active layer's placements at some frames; `unknown` while they are unknown."""
        frames = list(frames)
        return self.placed_at(self.selection.active, frames) or [unknown for _ in frames]

    def placed_at(self, layer: int, frames: Sequence[int]) -> list[Similarity] | None:
        """Return a layer's placements at some frames; None while they are unknown."""
        return self.evaluator.placements(self.document, layer, frames)

    def update_comparisons(self, method: Variant | Baseline | None) -> None:
        """Compare each layer with a method, or with none."""
        for layer in self.document.layers:
            runtime = self.runtimes.layers[layer.id]
            if method is None:
                runtime.comparison = None
                continue
            comparison = runtime.comparison or ComparisonRuntime(
                layer_id=layer.id,
                store=runtime.store,
                shown=runtime.shown,
                original=layer,
                layer=layer,
                method=layer.variant,
            )
            comparison.store = runtime.store
            if comparison.original is not layer or comparison.method is not method:
                comparison.original, comparison.method = layer, method
                comparison.layer = (
                    layer if isinstance(method, Baseline) else replace(layer, variant=method)
                )
            runtime.comparison = comparison

    def footage_picture(self, layer: Layer) -> Bytes | None:
        """Return the picture of a layer's footage at the shown frame; None without one yet."""
        shown = self.runtimes.layers[layer.id].shown
        if layer.footage is None or shown is None:
            return None
        number = footage_picture_at(self.document, layer, shown.frame)
        return None if number is None else self.footage.show(layer.id, layer.footage, number)

    def view_on(self, screen: tuple[int, int]) -> View:
        """Return the viewport's view on a screen of this size in pixels."""
        whole = fit_view_around(BoundingBox(0j, complex(*self.document.canvas)), screen)
        shown = self.layer_runtime.shown
        shot = camera_at(
            self.document, self.timeline.playhead.frame if shown is None else shown.frame
        )
        if self.viewport.is_camera_view and shot is not None:
            turn = complex(np.exp(1j * shot.turn))
            return replace(whole, centre=shot.centre, scale=whole.scale * shot.zoom, turn=turn)
        view = self.viewport.view
        return whole if view is None else replace(view, size=screen)
