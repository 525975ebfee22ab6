"""The selection: layers, handles, keys and a channel."""

from dataclasses import dataclass, field
from typing import Any

from app.document import (
    TRACK,
    VOLUME,
    Channel,
    Document,
    KeysByChannel,
    Layer,
    frames_in,
    pose_channel,
)
from app.editor.work.revised import Revised


@dataclass(slots=True, kw_only=True, eq=False)
class Selection(Revised):
    """What is selected; handles are always of the active layer."""

    active: int  # id of the active layer
    # Id of the member selected in the list while the deform group that bends it is active.
    member: int | None = None
    other_layers: frozenset[int] = frozenset()  # ids of selected layers besides the listed one
    handles: frozenset[int] = frozenset()  # ids
    # Channels without selected keys are left out.
    keys: KeysByChannel = field(default_factory=dict)
    channel: Channel[Any] | None = None  # None for the poses
    # The moved pivot of the box around handles or a layer, in the scene; None where it is by itself
    pivot: complex | None = None

    @property
    def frames(self) -> frozenset[int]:
        """Frames of the selected pose keys of the active layer."""
        return self.keys.get(pose_channel(self.active), frozenset())

    @property
    def key_count(self) -> int:
        """The number of selected keys in all channels."""
        return sum(map(len, self.keys.values()))

    def keys_with(self, channel: Channel[Any], frame: int) -> KeysByChannel:
        """Return all selected keys if a key is one of them, or else only this key."""
        if frame in self.keys.get(channel, ()):
            return self.keys
        return {channel: frozenset({frame})}

    @property
    def listed(self) -> int:
        """Id of the layer that is selected in the list: the active one, or a member of it."""
        return self.active if self.member is None else self.member

    def activate_layer(self, layer: int, member: int | None = None) -> None:
        """Make a layer active and select it alone; of another layer, nothing else is selected."""
        self.other_layers, self.member = frozenset(), member
        if layer != self.active:
            self.active, self.channel, self.pivot = layer, None, None
            self.clear()

    def select_other_layers(self, layers: frozenset[int]) -> None:
        """Select other layers besides the listed one."""
        self.other_layers = layers - {self.listed}

    def select_handles(self, handles: frozenset[int]) -> None:
        """Select these handles, and no keys; the pivot of other handles is forgotten."""
        if handles != self.handles:
            self.pivot = None
        self.handles, self.keys = handles, {}

    def deselect_handles(self, handles: frozenset[int]) -> None:
        self.handles -= handles

    def set_pivot(self, pivot: complex | None) -> None:
        """Move the pivot of the box to a place in the scene, or put it back."""
        self.pivot = pivot

    def move_pivot(self, way: complex) -> None:
        """Move a moved pivot along with the selected things."""
        if self.pivot is not None:
            self.pivot += way

    def select_keys(self, keys: KeysByChannel) -> None:
        """Select these keys, and no handles."""
        self.handles, self.keys = frozenset(), keys

    def select_pose_key(self, frame: int) -> None:
        """Select one pose key of the active layer, and no other keys."""
        self.keys = {pose_channel(self.active): frozenset({frame})}

    def add_keys(self, channel: Channel[Any], frames: frozenset[int]) -> None:
        """Select keys of a channel, too."""
        self.keys = {**self.keys, channel: frames}

    def deselect_keys(self) -> None:
        self.keys = {}

    def clear(self) -> None:
        """Deselect all handles and keys."""
        self.handles, self.keys = frozenset(), {}

    def restore(self, handles: frozenset[int], keys: KeysByChannel) -> None:
        """Select handles and keys as they were selected before."""
        self.handles, self.keys = handles, keys

    def select_channel(self, channel: Channel[Any] | None) -> None:
        self.channel = channel

    def select_sound(self, name: str) -> None:
        self.channel = Channel(VOLUME, part=name)

    def select_track(self, layer: Layer, handle: int) -> None:
        """Select the track of a handle; a track without keys is selected once it has keys."""
        track = layer.track_of(handle)
        self.channel = Channel(TRACK, layer.id, handle if track is None else track.handles[0])

    def keep_existing(self, document: Document) -> None:
        """Deselect what a document does not have, and activate another layer if necessary."""
        layers = document.layers
        if self.active not in [layer.id for layer in layers]:
            self.active = ([layer for layer in layers if not layer.still] or layers)[-1].id
            self.clear()
        if self.member not in [each.id for each in document.deform_members(self.active)]:
            self.member = None
        self.other_layers &= {layer.id for layer in layers}
        self.handles &= {handle.id for handle in document.layer(self.active).handles}
        chosen = {channel: at & frames_in(document, channel) for channel, at in self.keys.items()}
        self.keys = {channel: frames for channel, frames in chosen.items() if frames}


def foremost_posable(document: Document) -> int:
    """Return the layer to pose first: the front one, still pictures aside."""
    return next(
        (layer.id for layer in reversed(document.layers) if not layer.still),
        document.layers[-1].id,
    )
