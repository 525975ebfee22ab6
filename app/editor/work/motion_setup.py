"""A ready motion that a person is about to give: its joints, and how it is to be."""

from collections.abc import Mapping
from dataclasses import dataclass, field, replace
from typing import Self

from app.document import AppliedMotion, Document, Layer
from app.solving import MotionSolve
from engine.domain import MeshedDomain
from engine.geometry.motions import (
    MOTIONS,
    BodyKind,
    Motion,
    Parameters,
    find_kind,
    other_side,
)

JointPlaces = Mapping[str, complex]  # of joints by their names, at rest
MOST_UNDONE = 100


@dataclass(frozen=True, slots=True, kw_only=True, eq=False)
class MotionSetup:
    """What is to be given to a layer, before it is solved."""

    layer: int  # its id
    domain: MeshedDomain  # of the layer then: joints are places in it
    kind: str
    motion: str
    joints: JointPlaces
    suggested: JointPlaces  # where those of the kind were found
    # Joints of other kinds as they were left.
    others: Mapping[str, JointPlaces] = field(default_factory=dict)
    parameters: Parameters = field(default_factory=Parameters)
    rounds: int = 1
    facing: int | None = None  # None as it seems to look
    bones: bool = False
    first: int = 0  # the frame from which on it is given
    applied_motion: AppliedMotion | None = None  # what it takes the place of
    replaces_edits: bool = False  # also where that was edited by hand
    selected_joint: str | None = None  # the joint that was touched last
    past: tuple[JointPlaces, ...] = ()  # joints as they were before each change, to be undone

    @property
    def body_kind(self) -> BodyKind:
        """The kind itself."""
        return find_kind(self.kind)

    @property
    def preset(self) -> Motion:
        """The motion itself."""
        return MOTIONS[self.motion]

    @property
    def missing_joints(self) -> tuple[str, ...]:
        """The joints that the motion needs and that are not there."""
        needed = self.preset.template_for(self.kind).needed
        if self.parameters.mirrored:
            needed = tuple(map(other_side, needed))
        return tuple(name for name in needed if name not in self.joints)

    def with_joints(self, joints: JointPlaces, chosen: str | None = None) -> Self:
        """Return it with other joints, in the kind's order; that can be undone."""
        ordered = {name: joints[name] for name in self.body_kind.parents if name in joints}
        past = (*self.past, self.joints)[-MOST_UNDONE:]
        return replace(self, joints=ordered, past=past, selected_joint=chosen)

    def without(self, name: str) -> Self:
        """Return it without a joint."""
        return self.with_joints({each: at for each, at in self.joints.items() if each != name})

    @property
    def undone(self) -> Self:
        """It with the joints as they were before the last change."""
        return replace(self, joints=self.past[-1], past=self.past[:-1], selected_joint=None)


@dataclass(frozen=True, slots=True, kw_only=True, eq=False)
class MotionJob:
    """A motion on its way to a layer, and the draft by which it was asked for.

    Parameters
    ----------
    draft : MotionSetup
    before : Layer
        As it has to be when the motion comes.
    base : Document
        What it is given to: without the motion that it takes the place of.
    giving : MotionSolve, optional
        How far it is; None before the first step.
    """

    setup: MotionSetup
    before: Layer
    base: Document
    solve: MotionSolve | None = None

    @property
    def progress(self) -> float:
        """The part of its steps that is done, 0 to 1."""
        return 0.0 if self.solve is None else self.solve.progress

    @property
    def step_label(self) -> str:
        """What the next step does, in words."""
        return "Reading the joints" if self.solve is None else self.solve.status_text
