"""The document: layers on one timeline, with settings for playback and export.

Every value is frozen, and every existing document is valid. Commands make new documents often, so
constructors check only what is cheap. Costly checks are made at the source: the engine builds or
tests a domain, and certificates are proven after loading, never read.
"""

from bisect import bisect_left, bisect_right
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field, replace
from graphlib import CycleError, TopologicalSorter
from itertools import groupby, pairwise
from operator import itemgetter
from typing import NoReturn

from app.document.channels.cycles import count_repeated_changes
from app.document.channels.key import Key
from app.document.channels.kinds import CAMERA, LAYER_KINDS, VISIBILITY, SwitchMember
from app.document.channels.sounds import Sound
from app.document.channels.values import Camera
from app.document.checks import NOTHING, Unknown, require, require_distinct, require_size
from app.document.layer import Layer
from app.document.layers.attachments import Attachment, repeated_joints
from app.document.layers.drawing_files import DrawingFile, FileLayer
from app.document.layers.groups import Group, ancestor_paths
from app.document.layers.switch_group import SwitchGroup
from app.document.rig.mirror_names import PAIRS, SidePairs, require_pairs
from app.document.settings import ExportSettings, FrameRange, Marker, require_fps
from app.errors import EMPTY_IMPORT_LOG, ImportLog, LissomError
from app.texts import N_, _

NO_LAYER = N_("There is no layer with the id {identity}.")
PARENT_CIRCLE = N_(
    "{name!r} would be attached to itself at frame {frame:g}: {links}. Detach one of these "
    "layers first."
)
# Sum over all layers, repeats of cycles included.
MAX_CHANGES = 100_000


@dataclass(frozen=True, slots=True, weakref_slot=True, kw_only=True, eq=False)
class Document:
    """All contents of a project file."""

    # From back to front, at least one.
    layers: tuple[Layer, ...]
    frames: FrameRange = FrameRange(0, 48)  # every key lies in this range
    # Range of playback in the window; None plays all frames. Exports ignore the range.
    preview: FrameRange | None = None
    # A layer or a group is a member of at most one switch group; members of a member may switch.
    switch_groups: tuple[SwitchGroup, ...] = ()
    markers: tuple[Marker, ...] = ()  # in the order of their frames, at most one per frame
    fps: float = 24.0  # frames per second
    # Whether the animation loops: the last frame equals the first.
    loop: bool = False
    export: ExportSettings = ExportSettings()
    # Words or whole names of layers and handles that stand for the left and the right side.
    pairs: SidePairs = PAIRS
    # Fields of the project file that this version does not know. Saving writes them unchanged.
    unknown: Unknown = field(default_factory=lambda: NOTHING, repr=False, hash=False)
    # Members of the project file that this version does not know, by name.
    unknown_members: Mapping[str, bytes] = field(
        default_factory=lambda: NOTHING, repr=False, hash=False
    )
    # Width and height of the canvas; None takes the size of the rearmost picture.
    size: tuple[int, int] | None = None
    # An outer group comes before the groups inside it.
    groups: tuple[Group, ...] = ()
    # Keys of the visible part of the scene. Without keys, the canvas is visible.
    camera: tuple[Key[Camera], ...] = ()
    sounds: tuple[Sound, ...] = ()
    # Notices of all imports of layered drawings.
    import_log: ImportLog = EMPTY_IMPORT_LOG
    drawings: tuple[DrawingFile, ...] = ()  # files of which layers can be reloaded
    # Layers by id, switch groups by their members, groups by path.
    _layers: Mapping[int, Layer] = field(init=False, repr=False)
    _switch_groups: Mapping[SwitchMember, SwitchGroup] = field(init=False, repr=False)
    _groups: Mapping[str, Group] = field(init=False, repr=False)
    # Members of deform groups from back to front, by the group's layer id.
    _members: Mapping[int, tuple[Layer, ...]] = field(init=False, repr=False)

    def __post_init__(self) -> None:
        chosen = {member: each for each in self.switch_groups for member in each.members}
        for name, found in (
            ("_layers", {each.id: each for each in self.layers}),
            ("_switch_groups", chosen),
            ("_groups", {each.name: each for each in self.groups}),
            ("_members", _members_by_group(self.layers)),
        ):
            object.__setattr__(self, name, found)
        self._check_layers()
        require_pairs(self.pairs)
        require(
            self.preview is None
            or (self.preview.first in self.frames and self.preview.last in self.frames),
            N_("The preview range {preview} lies outside the frames {frames}."),
            preview=self.preview,
            frames=self.frames,
        )
        for before, after in pairwise(marker.frame for marker in self.markers):
            require(
                after != before,
                N_("Two markers are at frame {before}; move or delete one of them."),
                before=before,
            )
            require(
                after > before,
                N_("The markers at frames {before} and {after} are out of order."),
                before=before,
                after=after,
            )
        CAMERA.require(self.camera, _("scene"))
        for key in self.camera:
            self._require_inside(key.frame)
        require_fps(self.fps, _("The speed"))
        require_distinct(
            (sound.name for sound in self.sounds),
            N_("Two sounds have the name {value!r}; rename one of them."),
        )
        require_distinct(
            (drawing.id for drawing in self.drawings), N_("Two drawings have the id {value!r}.")
        )

    @property
    def played_frames(self) -> FrameRange:
        """The preview range, or all frames."""
        return self.preview or self.frames

    @property
    def canvas(self) -> tuple[int, int]:
        """Width and height of the canvas in pixels."""
        return self.layers[0].picture.size if self.size is None else self.size

    @property
    def exported_layers(self) -> tuple[Layer, ...]:
        """The layers that exports show at some frame, from back to front."""
        return tuple(
            each
            for each in self.layers
            if not (self.is_deform_group(each.id) or self._is_left_out(each))
            and not (each.deform_group is not None and self._is_left_out(self.deform_layer(each)))
        )

    def _is_left_out(self, layer: Layer) -> bool:
        is_hidden = layer.hidden and layer.id not in self._switch_groups
        return layer.reference or is_hidden or self.is_in_hidden(layer)

    def is_deform_group(self, identity: int) -> bool:
        """Return whether a layer bends members, which are drawn in its place."""
        return identity in self._members

    def deform_members(self, identity: int) -> tuple[Layer, ...]:
        """Return the layers that a deform group bends, from back to front."""
        return self._members.get(identity, ())

    def deform_layer(self, layer: Layer) -> Layer:
        """Return the layer whose mesh, keys and parents move a layer: itself or its group."""
        return layer if layer.deform_group is None else self.layer(layer.deform_group)

    def is_in_hidden(self, layer: Layer) -> bool:
        """Return whether a group around the layer is hidden at all frames.

        Groups of a switch are not: the switch decides.
        """
        around = self.groups_around(layer.group)
        return any(group.hidden and group.name not in self._switch_groups for group in around)

    def group(self, path: str) -> Group:
        if path not in self._groups:
            raise LissomError(_("There is no group {path!r}.").format(path=path))
        return self._groups[path]

    def groups_around(self, path: str) -> tuple[Group, ...]:
        """Return the group with this path and the groups around it, the outermost first."""
        return tuple(self.group(each) for each in ancestor_paths(path))

    def layer(self, identity: int) -> Layer:
        if identity not in self._layers:
            raise LissomError(_(NO_LAYER).format(identity=identity))
        return self._layers[identity]

    def find_layer(self, identity: int) -> Layer | None:
        """Return the layer with this id, if any."""
        return self._layers.get(identity)

    def drawing_of(self, layer: Layer) -> DrawingFile | None:
        """Return the file that a layer was imported from, if it is known."""
        origin = layer.origin
        known = (each for each in self.drawings if origin and each.id == origin.drawing)
        return next(known, None)

    def file_layer_of(self, layer: Layer) -> FileLayer | None:
        """Return a layer as it is in its file, if that is known."""
        drawing, origin = self.drawing_of(layer), layer.origin
        is_known = drawing is not None and origin is not None and origin.index < len(drawing.layers)
        return drawing.layers[origin.index] if is_known else None  # type: ignore[union-attr]

    def switch_group(self, name: str) -> SwitchGroup:
        for choice in self.switch_groups:
            if choice.name == name:
                return choice
        raise LissomError(_("There is no switch {name!r}.").format(name=name))

    def switch_group_of(self, member: SwitchMember) -> SwitchGroup | None:
        """Return the switch group of a layer or a group, if any."""
        return self._switch_groups.get(member)

    def switches_around(self, layer: Layer) -> tuple[tuple[SwitchGroup, SwitchMember], ...]:
        """Return the switch groups that decide about a layer, the outermost first.

        Each comes with its member: a group around the layer, or the layer.
        """
        if not self.switch_groups:
            return ()  # a fast path: this function is called often
        members: tuple[SwitchMember, ...] = (*ancestor_paths(layer.group), layer.id)
        found = ((self._switch_groups.get(member), member) for member in members)
        return tuple((switch, member) for switch, member in found if switch is not None)

    def member_layers(self, member: SwitchMember) -> tuple[Layer, ...]:
        """Return the layers of a member of a switch group, from back to front."""
        if not isinstance(member, str):
            return (self.layer(member),)
        return tuple(each for each in self.layers if member in ancestor_paths(each.group))

    def member_name(self, member: SwitchMember) -> str:
        """Return the name of a member of a switch group; of a group, without the groups around."""
        return member.rpartition("/")[2] if isinstance(member, str) else self.layer(member).name

    def moving_layers(self, switch: SwitchGroup) -> tuple[Layer, ...]:
        """Return the layers that share the time of a switch: still layers in groups do not."""
        return tuple(
            layer
            for member in switch.members
            for layer in self.member_layers(member)
            if not (isinstance(member, str) and layer.still)
        )

    def sound(self, name: str) -> Sound:
        for sound in self.sounds:
            if sound.name == name:
                return sound
        raise LissomError(_("There is no sound {name!r}.").format(name=name))

    @property
    def keyed_range(self) -> tuple[int, int]:
        """The first and the last frame of all keys that the document's frames contain."""
        frames = [frame for layer in self.layers for frame in layer.keyed_range]
        frames += [key.frame for key in self.camera]
        return min(frames), max(frames)

    def marker(self, frame: int) -> Marker:
        for marker in self.markers:
            if marker.frame == frame:
                return marker
        raise LissomError(_("There is no marker at frame {frame}.").format(frame=frame))

    def with_layer(self, changed: Layer) -> "Document":
        """Return the document with another layer of the same id; its frames extend to all keys."""
        if changed is self.layer(changed.id):
            return self
        first, last = changed.keyed_range
        frames = FrameRange(min(self.frames.first, first), max(self.frames.last, last))
        layers = tuple(
            changed
            if layer.id == changed.id
            else layer.with_cycles_of(changed)
            if layer.deform_group == changed.id
            else layer
            for layer in self.layers
        )
        return replace(self, layers=layers, frames=frames)

    def attachments_of(self, layer: Layer) -> tuple[Attachment, ...]:
        """Return the attachments of a layer, repeated with its cycles."""
        if not (layer.cycles and layer.attachments):
            return layer.attachments  # a fast path: this function is called often
        return repeated_joints(layer.attachments, layer.cycles, self.frames.last)

    def attachment_at(
        self, layer: Layer, frame: float, *, before: bool = False
    ) -> Attachment | None:
        """Return the attachment in effect at a frame, or just before it; None before the first."""
        joints = self.attachments_of(layer)
        count = (bisect_left if before else bisect_right)(
            joints, frame, key=lambda each: each.frame
        )
        return joints[count - 1] if count else None

    def parent_chain(
        self, identity: int, frame: float, *, before: bool = False
    ) -> tuple[Layer, ...]:
        """Return the layer with this id, its parent at a frame, and further ancestors in order.

        With `before`, the parents are those just before the frame.
        """
        frame = self.loop_frame(frame)
        layer = self.layer(identity)
        chain = {layer.id: layer}
        while (
            joint := self.attachment_at(layer, frame, before=before)
        ) and joint.parent is not None:
            layer = self.layer(joint.parent)
            if layer.id in chain:
                found = [*chain.values()]
                self._refuse_circle((*found[found.index(layer) :], layer), frame)
            chain[layer.id] = layer
        return tuple(chain.values())

    def all_ancestors(self, identity: int) -> tuple[Layer, ...]:
        """Return all ancestors of a layer at any frame."""
        found = [self.layer(identity)]
        known = {identity}
        for layer in found:
            for joint in layer.attachments:
                if joint.parent is not None and joint.parent not in known:
                    known.add(joint.parent)
                    found.append(self.layer(joint.parent))
        return tuple(found[1:])

    def loop_frame(self, frame: float) -> float:
        """Return the frame within the range that a loop shows; without a loop, the same."""
        return self.frames.wrap(frame) if self.loop else frame

    def _check_layers(self) -> None:
        require(len(self.layers) > 0, N_("A document must have at least one layer."))
        if self.size is not None:
            require_size(self.size, _("The canvas"))
        require_distinct(
            (layer.id for layer in self.layers), N_("Two layers have the id {value!r}.")
        )
        require_distinct(
            (layer.name for layer in self.layers),
            N_("Two layers have the name {value!r}; rename one of them."),
        )
        self._check_groups()
        self._check_deform_groups()
        for layer in self.layers:
            for frame in layer.keyed_range:
                self._require_inside(frame)
            for (name, _part), keys in layer.channels.items():
                kind = LAYER_KINDS[name]
                for field_name in kind.layer_fields:
                    for other in {kind.field_of(key.value, field_name) for key in keys} - {None}:
                        self.layer(other)
        self._check_switch_groups()
        self._check_repeats()
        self._check_attachments()
        for layer in self.layers:
            self._check_loop(layer)

    def _check_repeats(self) -> None:
        """Refuse documents with more visibility, order and attachment changes than MAX_CHANGES."""
        end, count = self.frames.last, 0
        for layer in self.layers:
            held = [
                keys for (name, _part), keys in layer.channels.items() if LAYER_KINDS[name].is_held
            ]
            for changes in (*held, layer.attachments):
                count += count_repeated_changes([each.frame for each in changes], layer.cycles, end)
        for choice in self.switch_groups:
            cycles = set.intersection(
                *({*each.cycles} for each in self.moving_layers(choice) or self.layers[:1])
            )
            count += count_repeated_changes([turn.frame for turn in choice.keys], cycles, end)
        require(
            count <= MAX_CHANGES,
            N_(
                "With repeats, layers have {count:,} keys of visibility, draw order, depth and "
                "parent, more than {most:,}. End the repeats earlier."
            ),
            count=count,
            most=MAX_CHANGES,
        )

    def _check_attachments(self) -> None:
        """Refuse layers that are attached to each other in a circle at any frame."""
        children = [each for each in self.layers if each.attachments]
        links = {
            each.id: {
                self.layer(joint.parent).id
                for joint in each.attachments
                if joint.parent is not None
            }
            for each in children
        }
        try:
            TopologicalSorter(links).prepare()
        except CycleError:
            self._check_circles(children)

    def _check_circles(self, children: Sequence[Layer]) -> None:
        """Refuse a circle of layers whose attachments begin at different frames.

        A circle begins at a frame where one of its layers is attached, so only these frames are
        tested.
        """
        first, last = self.frames.first, self.frames.last
        changes = sorted(
            # In a loop, a key before the first frame holds at the first frame.
            (
                max(joint.frame, first) if self.loop else joint.frame,
                joint.frame,
                place,
                joint.parent,
            )
            for place, each in enumerate(children)
            for joint in self.attachments_of(each)
            if not (self.loop and joint.frame > last)
        )
        parents: dict[int, int | None] = {}
        for frame, at_once in groupby(changes, key=itemgetter(0)):
            attached = {children[place].id: parent for _, _, place, parent in at_once}
            parents |= attached
            if any(_leads_back(parents, identity) for identity in attached):
                for layer in children:
                    self.parent_chain(layer.id, frame)  # raises the error about the circle

    def _require_inside(self, frame: int) -> None:
        require(
            frame in self.frames,
            N_("The key at frame {frame} lies outside the animation's frames {first} to {last}."),
            frame=frame,
            first=self.frames.first,
            last=self.frames.last,
        )

    def _check_switch_groups(self) -> None:
        require_distinct(
            (choice.name for choice in self.switch_groups),
            N_("Two switches have the name {value!r}; rename one of them."),
        )
        taken: dict[SwitchMember, str] = {}
        for choice in self.switch_groups:
            for member in choice.members:
                name = (
                    self.group(member).name if isinstance(member, str) else self.layer(member).name
                )
                require(
                    member not in taken,
                    N_("{layer!r} is in two switches, {other!r} and {name!r}; remove it from one."),
                    layer=name,
                    other=taken.get(member),
                    name=choice.name,
                )
                taken[member] = choice.name
                self._require_apart(choice, member)
                layer = self.find_layer(member) if isinstance(member, int) else None
                require(
                    layer is None or not layer.keys_of(VISIBILITY),
                    N_(
                        "The layer {layer!r} has visibility keys and is in the switch {name!r}, "
                        "but a switch alone decides visibility. Delete the visibility keys, or "
                        "remove the layer from the switch."
                    ),
                    layer=name,
                    name=choice.name,
                )

    def _require_apart(self, switch: SwitchGroup, member: SwitchMember) -> None:
        """Refuse a member inside another member of the same switch group."""
        around = member.rpartition("/")[0] if isinstance(member, str) else self.layer(member).group
        outer = next((each for each in ancestor_paths(around) if each in switch.members), None)
        require(
            outer is None,
            N_(
                "The switch {name!r} has the group {group!r}, and also {member!r} inside it; "
                "remove one of them."
            ),
            name=switch.name,
            group=outer,
            member=self.member_name(member),
        )

    def _refuse_circle(self, circle: Sequence[Layer], frame: float) -> NoReturn:
        """Refuse a circle of layers, each with the next as parent; the last equals the first."""
        links = " → ".join(repr(layer.name) for layer in circle)
        raise LissomError(_(PARENT_CIRCLE).format(name=circle[0].name, frame=frame, links=links))

    def _check_groups(self) -> None:
        known: set[str] = set()
        for group in self.groups:
            require(
                group.name not in known,
                N_("Two groups have the name {group!r}; rename one of them."),
                group=group.name,
            )
            require(
                known.issuperset(ancestor_paths(group.name)[:-1]),
                N_(
                    "The group {group!r} comes before its parent group in the list; list the "
                    "parent first."
                ),
                group=group.name,
            )
            known.add(group.name)
        for layer in self.layers:
            require(
                not layer.group or layer.group in known,
                N_("{layer!r} is in the group {group!r}, which does not exist."),
                layer=layer.name,
                group=layer.group,
            )

    def _check_deform_groups(self) -> None:
        for identity, members in self._members.items():
            group = self.layer(identity)
            require(
                not group.still and group.deform_group is None,
                N_("{group!r} bends {layer!r}, so it can be neither still nor a member itself."),
                group=group.name,
                layer=members[0].name,
            )
        for layer in self.layers:
            parents = {joint.parent for joint in layer.attachments} - {None}
            for member in (self.layer(each) for each in parents if each is not None):
                require(
                    member.deform_group is None,
                    N_("{layer!r} is attached to {member!r}; attach it to the deform group."),
                    layer=layer.name,
                    member=member.name,
                )

    def _check_loop(self, layer: Layer) -> None:
        """Refuse cycles, tracks and springs that cannot repeat in a loop."""
        period = self.frames.last - self.frames.first
        for cycle in layer.cycles if self.loop and len(layer.keys) > 1 else ():
            require(
                any(cycle.contains(key.frame) for key in layer.keys),
                N_(
                    "No key of {layer!r} in {cycle} could repeat in a loop; insert a key there "
                    "first."
                ),
                layer=layer.name,
                cycle=cycle.description,
            )
        for track in layer.tracks if self.loop else ():
            require(
                track.delay <= period,
                N_(
                    "A track of {layer!r} is delayed by {delay} frames, longer than the loop of "
                    "{period} frames. Shorten the delay first."
                ),
                layer=layer.name,
                delay=track.delay,
                period=period,
            )
        for spring in layer.springs if self.loop else ():
            require(
                spring.damping > 0 or not spring.enabled,
                N_(
                    "A spring of {layer!r} has no damping, so its swing never repeats in a "
                    "loop. Set a damping above 0."
                ),
                layer=layer.name,
            )


def _members_by_group(layers: Sequence[Layer]) -> Mapping[int, tuple[Layer, ...]]:
    found: dict[int, tuple[Layer, ...]] = {}
    for layer in layers:
        if layer.deform_group is not None:
            found[layer.deform_group] = (*found.get(layer.deform_group, ()), layer)
    return found


def _leads_back(parents: Mapping[int, int | None], identity: int) -> bool:
    """Return whether the chain of parents of a layer reaches a layer twice."""
    passed = {identity}
    above = parents.get(identity)
    while above is not None and above not in passed:
        passed.add(above)
        above = parents.get(above)
    return above is not None
