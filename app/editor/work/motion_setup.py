"""The draft of a motion preset that is not applied yet: joints and settings."""

from collections.abc import Mapping
from dataclasses import dataclass, field, replace
from typing import Self

from app.document import AppliedMotion, Document, Layer, clip_of
from app.motion import InbetweenCache, LayerFrame, SceneFrame, evaluate_layer
from app.rigging import MOTIONS, BodyKind, Motion, Parameters, find_kind, other_side
from app.solving import MotionSolve
from app.texts import _
from engine.domain import MeshedDomain

JointPlaces = Mapping[str, complex]  # of joints by their names, at rest
MOST_UNDONE = 100


@dataclass(frozen=True, slots=True, kw_only=True, eq=False)
class MotionSetup:
    """The draft of a motion preset for a layer."""

    layer: int  # its id
    domain: MeshedDomain  # of the layer at that time; joints are places in it
    kind: str
    motion: str
    joints: JointPlaces
    suggested: JointPlaces  # joints that were found for the body kind
    # Ends of near limbs that are a guess: the other limb of the pair may be the near one.
    unsure: tuple[str, ...] = ()
    # The last joints of other body kinds.
    others: Mapping[str, JointPlaces] = field(default_factory=dict)
    parameters: Parameters = field(default_factory=Parameters)
    rounds: int = 1
    facing: int | None = None  # None uses the direction that the drawing seems to face
    first: int = 0  # the frame at which the motion begins
    applied_motion: AppliedMotion | None = None  # the motion that it replaces
    replaces_edits: bool = False  # whether keys edited by hand are replaced as well
    selected_joint: str | None = None  # the joint that was touched last
    past: tuple[JointPlaces, ...] = ()  # joints before each change, for undo

    @property
    def body_kind(self) -> BodyKind:
        return find_kind(self.kind)

    @property
    def preset(self) -> Motion:
        return MOTIONS[self.motion]

    @property
    def missing_joints(self) -> tuple[str, ...]:
        """Joints that the motion needs and the draft lacks."""
        needed = self.preset.template_for(self.kind).needed
        if self.parameters.mirrored:
            needed = tuple(map(other_side, needed))
        return tuple(name for name in needed if name not in self.joints)

    def with_joints(self, joints: JointPlaces, chosen: str | None = None) -> Self:
        """Return the draft with other joints, in the kind's order; undo restores the old joints."""
        ordered = {name: joints[name] for name in self.body_kind.parents if name in joints}
        past = (*self.past, self.joints)[-MOST_UNDONE:]
        return replace(self, joints=ordered, past=past, selected_joint=chosen)

    def with_answer(self, end: str) -> Self:
        """Return the draft with a near limb that is no longer a guess."""
        return replace(self, unsure=tuple(each for each in self.unsure if each != end))

    def without(self, name: str) -> Self:
        return self.with_joints({each: at for each, at in self.joints.items() if each != name})

    @property
    def undone(self) -> Self:
        """The draft with the joints before the last change."""
        return replace(self, joints=self.past[-1], past=self.past[:-1], selected_joint=None)


@dataclass(frozen=True, slots=True, kw_only=True, eq=False)
class MotionJob:
    """A pending motion of a layer, and its draft.

    Attributes
    ----------
    before : Layer
        The layer must still be this one when the motion is ready.
    base : Document
        The document without the motion that is replaced.
    frames_before : mapping
        The shown frames by layer id, which a cancelled motion leaves.
    solve : MotionSolve, optional
        Progress; None before the first step.
    preview : InbetweenCache, optional
        With the mesh of the layer as it is solved, on which solved poses are shown.
    """

    setup: MotionSetup
    before: Layer
    base: Document
    frames_before: Mapping[int, LayerFrame]
    solve: MotionSolve | None = None
    preview: InbetweenCache | None = None

    def show_pose(self, displayed: SceneFrame) -> SceneFrame:
        """Return a displayed frame with the pose that was solved last, and nothing else changed."""
        solve, preview, layer = self.solve, self.preview, self.before.id
        if solve is None or preview is None or not solve.poses or layer not in displayed.layers:
            return displayed
        clip = clip_of(solve.document, layer)
        posed = evaluate_layer(clip, displayed.frame, solve.poses[-1], [preview], None)
        layers = dict(displayed.layers)
        for identity, frame in displayed.layers.items():
            own = displayed.document.layer(identity)
            if displayed.document.deform_layer(own).id == layer:
                # The document has neither the pose nor the handles and bones of the motion.
                layers[identity] = replace(
                    posed, clip=frame.clip, pose=None, placement=frame.placement
                )
        return replace(displayed, layers=layers)

    @property
    def progress(self) -> float:
        """The finished part of its steps, 0 to 1."""
        return 0.0 if self.solve is None else self.solve.progress

    @property
    def step_label(self) -> str:
        """Description of the next step."""
        return _("Preparing the motion") if self.solve is None else self.solve.status_text
