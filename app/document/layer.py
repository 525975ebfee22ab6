"""A layer: its picture, domain, handles and keys."""

import hashlib
import re
from bisect import bisect_right
from collections.abc import Iterable, Mapping
from dataclasses import dataclass, field, replace
from types import MappingProxyType
from typing import Any, TypeVar

import numpy as np

from app.cut_out import CutOut
from app.document.channels.cycles import Cycle, require_no_overlap, require_repeatable_cycle
from app.document.channels.key import Key
from app.document.channels.kind import ChannelKeys, ChannelKind, require_order
from app.document.channels.kinds import DRAW_ORDER, FOOTAGE_TIME, LAYER_KINDS, PARENT, POSE
from app.document.channels.sliders import Slider
from app.document.channels.springs import Spring
from app.document.channels.tracks import Track
from app.document.checks import (
    NOTHING,
    Unknown,
    require,
    require_distinct,
    require_id,
    require_point,
    require_size,
)
from app.document.keyframe import Handle, Keyframe, LibraryPose, Pose, Target
from app.document.layers.attachments import Attachment
from app.document.layers.drawing_files import LayerOrigin
from app.document.layers.footage import Footage
from app.document.layers.groups import BLENDS, BlendMode
from app.document.rig.applied_motion import AppliedMotion, UnreadMotion, require_motions
from app.document.rig.chains import Bone, require_chains
from app.document.rig.mirror_names import SIDES, mirrored_handles_by_name
from app.document.settings import NATURAL, VARIANTS, Meshing
from app.errors import LissomError
from app.texts import N_, _
from engine.arrays import Booleans, Complexes, Floats, readonly
from engine.deform import MOST_HANDLES
from engine.domain import MeshedDomain
from engine.geometry import ON_OUTLINE, contains, diameter
from engine.maps import Bounds, Certificate, HarmonicMap, require_stiffness
from engine.variant import Variant

Posed = TypeVar("Posed", Keyframe, LibraryPose)
V = TypeVar("V")
# Limits at joints of bones: an elbow about as thick as long folds by 130°. A bend θ over a length ℓ
# of a limb of width W needs ln(σ_a / σ_b) ≥ θ W / ℓ.
FOLDING_ANGLE = 130.0
FOLDING_JOINTS = Bounds(k=0.85, sigma_a=4.0, sigma_b=0.15)
MOST_IK_PARENTS = 100
NO_CHANNELS: ChannelKeys = MappingProxyType({})
NO_KEY = N_("There is no key at frame {frame}.")
NO_HANDLE = N_("There is no handle with the id {identity}.")
DUPLICATE_BONES = N_("Two bones connect handles {value!r}; keep one of them.")
POSE_COUNT = N_("The layer has {count} poses, but {given} were given.")


@dataclass(frozen=True, slots=True, kw_only=True, eq=False)
class PictureFile:
    """The picture file as it was opened, byte for byte."""

    data: bytes = field(repr=False)  # of the picture file
    suffix: str  # ending of the file name, such as ".png"
    size: tuple[int, int]  # width and height in pixels, after the rotation in the EXIF data
    sha256: str = field(init=False)

    def __post_init__(self) -> None:
        require(len(self.data) > 0, N_("The picture is empty; give a picture with a drawing."))
        require(
            re.fullmatch(r"\.[a-z0-9]{1,8}", self.suffix) is not None,
            N_("The file name of a picture must have an ending such as '.png', not {suffix!r}."),
            suffix=self.suffix,
        )
        require_size(self.size, _("The picture"))
        object.__setattr__(self, "sha256", hashlib.sha256(self.data).hexdigest())


@dataclass(frozen=True, slots=True, weakref_slot=True, kw_only=True, eq=False)
class Layer:
    """A picture that is deformed, with its own data; timeline and export belong to the document."""

    id: int = 0  # never used again in the same document
    picture: PictureFile
    domain: MeshedDomain
    meshing: Meshing  # settings that the domain was built with
    cut_out: CutOut = CutOut()  # separates the subject from the rest of the picture
    is_stale: bool = False  # whether the domain was built from an earlier cut-out
    handles: tuple[Handle, ...] = ()
    next_handle: int = 0  # id of the next handle
    keys: tuple[Keyframe, ...]  # in the order of their frames, at least one
    # Point of the picture whose position and rotation are interpolated directly. None lets the
    # engine choose the point.
    anchor: complex | None = None
    # Whether auto-pin applies: a handle with equal targets in two keys stays there in between.
    has_auto_pins: bool = True
    tracks: tuple[Track, ...] = ()  # at most one per handle
    springs: tuple[Spring, ...] = ()  # at most one per handle
    cycles: tuple[Cycle, ...] = ()  # in the order of their frames
    # float64 (p,): Painted stiffness at the vertices of the domain's loops. None is 1 everywhere.
    stiffness: Floats | None = field(default=None, hash=False)
    bones: tuple[Bone, ...] = ()
    # Motion presets that made keys, in the order of their frames. Later edits of the keys are not
    # recorded here.
    motions: tuple[AppliedMotion, ...] = ()
    unread_motions: tuple[UnreadMotion, ...] = ()  # in the order of their positions
    variant: Variant = Variant.METRIC  # accepts the name of a variant
    bounds: Bounds = NATURAL.bounds  # limits of new poses
    library: tuple[LibraryPose, ...] = ()  # saved poses
    sliders: tuple[Slider, ...] = ()  # of poses of the library
    # Vertical axis for flipped poses, in pixels from the picture's left edge. None takes the mean
    # of the paired handles, or the middle of the shape.
    mirror: float | None = None
    name: str = "layer"  # unique in the document
    # Lower left corner of the picture on the canvas. The domain, the handles and all other points
    # are in pixels of the canvas, y up.
    corner: complex = 0j
    # Whether the picture is never deformed, such as a background. The domain is then the whole
    # picture, whatever the cut-out.
    still: bool = False
    # Pictures that the layer shows in time, in place of its picture; the picture is the first of
    # them. Such a layer is still.
    footage: Footage | None = None
    reference: bool = False  # a guide in the window; exports omit it
    locked: bool = False  # whether clicks on the drawing pass through
    hidden: bool = False  # at all frames
    opacity: float = 1.0  # in [0, 1]; used without opacity keys
    # Keys of the kinds in `LAYER_KINDS`, in the order of their frames. A channel without keys is
    # not listed.
    channels: ChannelKeys = field(default_factory=lambda: NO_CHANNELS)
    unread_channels: tuple[object, ...] = ()  # JSON of a later version's kinds
    blend: BlendMode = "normal"
    # Whether the layer is visible only where the layer or group below it in its group is opaque.
    clipped: bool = False
    group: str = ""  # path of the innermost group around the layer; "" outside all groups
    # Keys of the parent, each valid from its frame on. An attached layer has an anchor.
    attachments: tuple[Attachment, ...] = ()
    origin: LayerOrigin | None = None  # in a file that can be reloaded
    # Id of the layer under which its picture was extended by a pixel.
    closed_seam: int | None = None
    # How many parents bend as bones when the layer is dragged or has an IK target. None counts the
    # parents up to one that has several children.
    ik_parents: int | None = None
    # Side to which these bones bend, as of `solve_chain`; 0 keeps the side of their transforms.
    pole_side: int = 0
    # Id of the deform group that bends this member: a layer that is not drawn itself.
    deform_group: int | None = None
    # The layer before it became a member; None for a layer that was a still picture.
    before_bending: "Layer | None" = field(default=None, repr=False, hash=False)
    unknown: Unknown = field(default_factory=lambda: NOTHING, repr=False, hash=False)

    def __post_init__(self) -> None:
        require_id(self.id, _("A layer"))
        require(
            self.ik_parents is None or 0 <= self.ik_parents <= MOST_IK_PARENTS,
            N_("The number of IK parents must be from 0 to {largest}, not {ik_parents}."),
            largest=MOST_IK_PARENTS,
            ik_parents=self.ik_parents,
        )
        require(
            self.pole_side in {-1, 0, 1},
            N_("A pole side must be -1, 0 or 1, not {pole_side}."),
            pole_side=self.pole_side,
        )
        require(bool(self.name.strip()), N_("A layer needs a name."))
        require_point(self.corner, _("The corner of {layer!r}").format(layer=self.name))
        require(
            0 <= self.opacity <= 1,
            N_("Opacity must be from 0 to 1, not {opacity:g}."),
            opacity=self.opacity,
        )
        require(
            self.blend in BLENDS,
            N_("The blend of {name!r} must be one of {blends}, not {blend!r}."),
            name=self.name,
            blends=", ".join(BLENDS),
            blend=self.blend,
        )
        kept = {name: tuple(keys) for name, keys in self.channels.items() if keys}
        object.__setattr__(self, "channels", MappingProxyType(kept))
        handles, sliders = {each.id for each in self.handles}, {each.name for each in self.sliders}
        for (name, part), keys in self.channels.items():
            kind = LAYER_KINDS[name]
            kind.require(keys, self.name)
            require(
                not kind.of_sliders or part in sliders,
                N_("{layer!r} has keys of the slider {part!r}, which does not exist."),
                layer=self.name,
                part=part,
            )
            require(
                kind.of_sliders or part is None or part in handles,
                N_("{channel} of {layer!r} belongs to the handle {part}, which does not exist."),
                channel=kind.label,
                layer=self.name,
                part=part,
            )
        require(
            not self.attachments or self.anchor is not None,
            N_("{name!r} is attached but has no anchor; set an anchor."),
            name=self.name,
        )
        require_order(self.attachments, PARENT.label, self.name)
        require(
            all(key.value.beside != self.id for key in self.keys_of(DRAW_ORDER)),
            N_("{name!r} cannot be in front of itself or behind itself."),
            name=self.name,
        )
        require(
            not self.still or (len(self.keys) == 1 and not self.handles),
            N_(
                "{name!r} is a still picture, so it cannot have handles or a second key. Make it "
                "posable first."
            ),
            name=self.name,
        )
        self._check_membership()
        require(
            self.footage is None or (self.still and self.footage.size == self.picture.size),
            N_("{name!r} shows footage, so it must be still and have the footage's size."),
            name=self.name,
        )
        mask = self.cut_out.mask
        require(
            mask is None or mask.size == self.picture.size,
            N_("The mask and the picture have different sizes; give a mask of the picture's size."),
        )
        self._check_handles()
        self._check_keys()
        self._check_library()
        self._check_secondary_motion()
        self._check_stiffness()
        if self.mirror is not None:
            require_point(complex(self.mirror), _("The axis of mirroring"))
        require(
            self.variant in VARIANTS,
            N_("The variant must be one of {variants}, not {variant!r}."),
            variants=", ".join(VARIANTS),
            variant=str(self.variant),
        )
        # Files store the name of the variant.
        object.__setattr__(self, "variant", Variant(self.variant))

    def keys_of(self, kind: ChannelKind[V], part: int | str | None = None) -> tuple[Key[V], ...]:
        """Return the keys of a kind in `LAYER_KINDS`."""
        return self.channels.get((kind.name, part), ())

    def with_keys_of(
        self, kind: ChannelKind[V], keys: Iterable[Key[V]], part: int | str | None = None
    ) -> "Layer":
        """Return the layer with other keys of a channel, the same object without a change."""
        given = tuple(keys)
        if given == self.keys_of(kind, part):
            return self
        return replace(self, channels={**self.channels, (kind.name, part): given})

    def without_footage(self) -> "Layer":
        """Return the layer as a still picture, without the keys of its footage's time."""
        return replace(self.with_keys_of(FOOTAGE_TIME, ()), footage=None)

    @property
    def key_frames(self) -> frozenset[int]:
        return frozenset(key.frame for key in self.keys)

    @property
    def keyed_range(self) -> tuple[int, int]:
        """The first and the last frame of all keys and cycles."""
        frames = [key.frame for key in self.keys]
        frames += [key.frame for track in self.tracks for key in track.keys]
        for (name, _part), keys in self.channels.items():
            frames += [key.frame for key in keys if not LAYER_KINDS[name].is_held]
        for cycle in self.cycles:
            frames += [cycle.first, cycle.last if cycle.until is None else cycle.until]
        return min(frames), max(frames)

    def cycle_at(self, frame: float) -> Cycle | None:
        """Return the cycle around a frame, its repeats included."""
        # A cycle may end at the first frame of the next cycle.
        count = bisect_right(self.cycles, frame, key=lambda cycle: cycle.first)
        near = self.cycles[max(count - 2, 0) : count]
        return next((cycle for cycle in near if cycle.covers(frame)), None)

    def source_of(self, frame: int) -> int:
        """Return the keyed frame that this frame shows; an earlier one in repeats of a cycle."""
        cycle = self.cycle_at(frame)
        return (
            frame if cycle is None or frame in self.key_frames else int(cycle.source_frame(frame))
        )

    @property
    def pivot(self) -> complex:
        """Centre of the layer's rotation: its anchor, or the centre of the shape's bounding box."""
        if self.anchor is not None:
            return self.anchor
        x, y = self.domain.outline.real, self.domain.outline.imag
        return complex(x.min() + x.max(), y.min() + y.max()) / 2

    @property
    def poses(self) -> tuple[Pose, ...]:
        """Poses of the keys, then of the library."""
        return (*(key.pose for key in self.keys), *(kept.pose for kept in self.library))

    @property
    def axis(self) -> float:
        """The vertical mirror axis for flipped poses, in pixels."""
        if self.mirror is not None:
            return self.mirror
        paired = mirrored_handles_by_name(self.handles, SIDES)
        places = [self.handle(identity).position.real for identity in paired]
        if not places:
            places = [float(self.domain.outline.real.min()), float(self.domain.outline.real.max())]
        return sum(places) / len(places)

    def with_poses(self, poses: Iterable[Pose], **changes: Any) -> "Layer":
        """Return the layer with other `poses`, in the same order, and with other changes."""
        given = tuple(poses)
        if len(given) != len(self.poses):
            raise LissomError(_(POSE_COUNT).format(count=len(self.poses), given=len(given)))
        left = iter(given)
        keys = tuple(_with_pose(key, next(left)) for key in self.keys)
        library = tuple(_with_pose(kept, next(left)) for kept in self.library)
        return replace(self, keys=keys, library=library, **changes)

    def covers(self, points: Complexes, *, tolerance: float = 0.0) -> Booleans:
        """Return for each point whether it lies on the shape or within `tolerance` pixels."""
        outline, *holes = self.domain.loops
        return contains(outline, points, holes=holes, tolerance=tolerance)

    def library_pose(self, name: str) -> LibraryPose:
        for kept in self.library:
            if kept.name == name:
                return kept
        raise LissomError(_("There is no pose {name!r} in the library.").format(name=name))

    def slider(self, name: str) -> Slider:
        for slider in self.sliders:
            if slider.name == name:
                return slider
        raise LissomError(_("There is no slider {name!r}.").format(name=name))

    def handle(self, identity: int) -> Handle:
        for handle in self.handles:
            if handle.id == identity:
                return handle
        raise LissomError(_(NO_HANDLE).format(identity=identity))

    def grouped_handles(self, identity: int) -> frozenset[int]:
        """Return the ids of all handles in the handle's group, its own included."""
        groups = {handle.id: handle.group for handle in self.handles}
        own = groups.get(identity)
        return frozenset({identity, *(i for i, group in groups.items() if own and group == own)})

    def track_of(self, identity: int) -> Track | None:
        return next((track for track in self.tracks if identity in track.handles), None)

    def spring_of(self, identity: int) -> Spring | None:
        return next((spring for spring in self.springs if spring.handle == identity), None)

    @property
    def has_parent(self) -> bool:
        """Whether the layer has a parent at some frame."""
        return any(joint.parent is not None for joint in self.attachments)

    def attachment_key_at(self, frame: int) -> Attachment | None:
        """Return the attachment in effect at a frame; None before the first."""
        at = self.joint_frame(frame)
        return next((joint for joint in reversed(self.attachments) if joint.frame <= at), None)

    def joint_frame(self, frame: int) -> int:
        """Return the frame whose attachment holds at this frame; in repeats, an earlier frame."""
        for cycle in self.cycles:
            in_repeats = cycle.last <= frame and cycle.covers(frame) and frame != cycle.until
            if in_repeats and all(
                not cycle.covers(joint.frame) or joint.frame <= cycle.last
                for joint in self.attachments
            ):
                return int(cycle.source_frame(frame))
        return frame

    @property
    def sprung_handles(self) -> frozenset[int]:
        """The ids of the handles that springs move; poses do not hold them.

        A track of the handle, or a joint at its position, overrides the spring.
        """
        joint = self.anchor if self.has_parent else None
        held = {handle.id for handle in self.handles if handle.position == joint}
        held |= {i for track in self.tracks if track.enabled for i in track.handles}
        return frozenset(each.handle for each in self.springs if each.enabled) - held

    @property
    def bone_joints(self) -> frozenset[int]:
        """The ids of the handles at which bones start: roots and joints.

        A pose holds the bones there, and not the drawing. The target is the place of the joint.
        """
        return frozenset(bone.ends[0] for bone in self.bones if bone.is_limb)

    def is_locked(self, identity: int) -> bool:
        return any(handle.locked for handle in self.handles if handle.id == identity)

    def key(self, frame: int) -> Keyframe:
        for key in self.keys:
            if key.frame == frame:
                return key
        raise LissomError(_(NO_KEY).format(frame=frame))

    def nearest_key(self, frame: int) -> Keyframe:
        """Return the key nearest to a frame; the earlier one of two."""
        return min(self.keys, key=lambda key: abs(key.frame - frame))

    def map_of(self, pose: Pose) -> HarmonicMap:
        return HarmonicMap(
            cage=self.domain.cage,
            phi=pose.phi,
            psi=pose.psi,
            holes=self.domain.holes,
            logs=pose.logs,
        )

    @property
    def widest_bounds(self) -> Bounds:
        """The limits anywhere in the layer: joints of bones have looser ones."""
        return self.bounds.joined(FOLDING_JOINTS) if self.bone_joints else self.bounds

    def is_proven(self, pose: Pose) -> bool:
        """Return whether the pose is proven to satisfy the current limits."""
        proven = pose.certificate
        # The solver proves a pose for the limits at that time, which the person may have changed
        # since.
        return proven.is_certified and self.widest_bounds.allow(
            k=proven.k, sigma_a=proven.sigma_a, sigma_b=proven.sigma_b
        )

    def target_errors(self, pose: Pose) -> Mapping[int, float]:
        """Return the distance in pixels of each handle, by its id, from its target.

        A displayed pose may be older than the newest handles, which are left out.
        """
        reached = self.map_of(pose)(np.array([handle.position for handle in self.handles], complex))
        return {
            handle.id: abs(pose.targets[handle.id].position - complex(place))
            for handle, place in zip(self.handles, reached, strict=True)
            if handle.id in pose.targets
        }

    def with_cycles_of(self, group: "Layer") -> "Layer":
        """Return a member whose channels repeat with the cycles of its deform group."""
        if self.cycles == group.cycles:
            return self
        key = replace(self.keys[0], frame=group.keys[0].frame)
        return replace(self, cycles=group.cycles, keys=(key,))

    def _check_membership(self) -> None:
        """Refuse a member of a deform group with a motion of its own."""
        if self.deform_group is None:
            require(
                self.before_bending is None,
                N_("{name!r} is no member of a deform group, so it has no earlier mesh."),
                name=self.name,
            )
            return
        require(
            self.still
            and not self.attachments
            and not any(LAYER_KINDS[name].moves_layer for name, _part in self.channels),
            N_(
                "{name!r} is a member of a deform group, which moves it. Attach or move the group, "
                "or part it first."
            ),
            name=self.name,
        )
        require(
            self.before_bending is None or self.before_bending.deform_group is None,
            N_("{name!r} was a member of a deform group before it became one."),
            name=self.name,
        )

    def _check_handles(self) -> None:
        handles = self.handles
        require(
            len(handles) <= MOST_HANDLES,
            N_("{name!r} has {count:,} handles; a drawing can have at most {largest:,}."),
            name=self.name,
            count=len(handles),
            largest=MOST_HANDLES,
        )
        require_id(self.next_handle, _("The next handle"))
        require_distinct(
            (handle.id for handle in handles), N_("Two handles have the id {value!r}.")
        )
        require_distinct(
            (handle.name for handle in handles),
            N_("Two handles have the name {value!r}; rename one of them."),
        )
        named = dict[complex, str]()
        for handle in handles:
            other = named.setdefault(handle.position, handle.name)
            require(
                other == handle.name,
                N_("The handles {first!r} and {second!r} are at one place; move or delete one."),
                first=other,
                second=handle.name,
            )
        require(
            all(handle.id < self.next_handle for handle in self.handles),
            N_("The next handle's id, {next_handle}, already belongs to a handle."),
            next_handle=self.next_handle,
        )
        places = {
            _("The handle {name!r}").format(name=handle.name): handle.position
            for handle in self.handles
        }
        if self.anchor is not None:
            require_point(self.anchor, _("The anchor"))
            places[_("The anchor")] = self.anchor
        self.require_on_shape(places)

    def require_on_shape(self, places: Mapping[str, complex]) -> None:
        """Raise a `LissomError` for the first of these named points outside the shape."""
        points = np.array(list(places.values()), dtype=np.complex128)
        inside = self.covers(points, tolerance=ON_OUTLINE * diameter(self.domain.outline))
        for (what, place), is_inside in zip(places.items(), inside, strict=True):
            require(
                bool(is_inside),
                N_(
                    "{what} at ({x:.0f}, {y:.0f}) lies outside the shape; move it onto "
                    "the shape or remove it."
                ),
                what=what,
                x=place.real,
                y=place.imag,
            )

    def _check_keys(self) -> None:
        require(len(self.keys) > 0, N_("An animation needs at least one key."))
        require_order(self.keys, POSE.label, self.name)
        for key in self.keys:
            self._check_pose(key.pose, _("The key at frame {frame}").format(frame=key.frame))
        frames = [key.frame for key in self.keys]
        require_no_overlap(self.cycles)
        for cycle in self.cycles:
            require_repeatable_cycle(cycle, frames)

    def _check_library(self) -> None:
        require_distinct(
            (kept.name for kept in self.library),
            N_("Two poses have the name {value!r}; rename one of them."),
        )
        for kept in self.library:
            self._check_pose(kept.pose, _("The pose {name!r}").format(name=kept.name))
        require_distinct(
            (each.name for each in self.sliders),
            N_("Two sliders have the name {value!r}; rename one of them."),
        )
        names = {kept.name for kept in self.library} | {None}
        for slider in self.sliders:
            for each in slider.poses:
                require(
                    each.pose in names,
                    N_("The slider {slider!r} has the pose {pose!r}, which is not in the library."),
                    slider=slider.name,
                    pose=each.pose,
                )

    def _check_secondary_motion(self) -> None:
        known = {handle.id for handle in self.handles}
        tracked = [identity for track in self.tracks for identity in track.handles]
        following = [spring.handle for spring in self.springs]
        for identity in {*tracked, *following} - known:
            raise LissomError(_(NO_HANDLE).format(identity=identity))
        require_distinct(tracked, N_("The handle {value!r} has two tracks; keep one of them."))
        require_distinct(following, N_("The handle {value!r} has two springs; keep one of them."))
        for root in {spring.root for spring in self.springs} - {None}:
            require(
                root in known,
                N_("A spring has the root handle {root}, which does not exist."),
                root=root,
            )
        require_motions(self.motions, known)

    def _check_stiffness(self) -> None:
        if self.stiffness is not None:
            count = sum(map(len, self.domain.loops))
            object.__setattr__(
                self, "stiffness", readonly(require_stiffness(self.stiffness, count))
            )
        require(
            len(self.bones) <= MOST_HANDLES,
            N_("A drawing can have at most {largest:,} bones, not {count:,}."),
            largest=MOST_HANDLES,
            count=len(self.bones),
        )
        known = {handle.id: handle.name for handle in self.handles}
        for bone in self.bones:
            for end in bone.ends:
                require(
                    end in known,
                    N_("A bone ends at handle {end}, which does not exist."),
                    end=end,
                )
        require_distinct((tuple(sorted(bone.ends)) for bone in self.bones), DUPLICATE_BONES)
        require_chains(self.bones, known)

    def _check_pose(self, pose: Pose, what: str) -> None:
        require(
            pose.targets.keys() == {handle.id for handle in self.handles},
            N_("{what} must have one target for each handle."),
            what=what,
        )
        count = sum(map(len, self.domain.cages))
        require(
            len(pose.phi) == len(pose.psi) == count,
            N_(
                "{what} has coefficients for a cage of {given} vertices, but the layer's cage "
                "has {count}."
            ),
            what=what,
            given=len(pose.phi),
            count=count,
        )
        require(
            len(pose.logs) == len(self.domain.holes),
            N_("{what} has {given} holes, but the layer has {count}."),
            what=what,
            given=len(pose.logs),
            count=len(self.domain.holes),
        )


def _with_pose(each: Posed, pose: Pose) -> Posed:
    return each if each.pose is pose else replace(each, pose=pose)


def rest_pose(domain: MeshedDomain, handles: Iterable[Handle]) -> Pose:
    """Return the undeformed pose; the target of each handle is its position."""
    rest = HarmonicMap.identity(domain.cage, domain.holes)
    targets = {each.id: Target(position=each.position) for each in handles}
    undistorted = Certificate(k=0.0, sigma_a=1.0, sigma_b=1.0, winding=0, is_certified=True)
    return Pose.of(rest, targets, undistorted)


def new_layer(
    picture: PictureFile, domain: MeshedDomain, meshing: Meshing, cut_out: CutOut = CutOut()
) -> Layer:
    """Return the layer of a newly opened picture, with one undeformed key at frame 0."""
    pose = rest_pose(domain, ())
    return Layer(
        picture=picture,
        domain=domain,
        meshing=meshing,
        cut_out=cut_out,
        keys=(Keyframe(frame=0, pose=pose),),
    )
