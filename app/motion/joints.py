"""Where figures that hang on others are, at any time (Section 7, "a user curve for the anchor")."""

from collections.abc import Callable, Iterable, Mapping, Sequence
from functools import partial
from itertools import product
from typing import NamedTuple

import numpy as np

from app.document import Attachment, Document, Figure, Pose, clip_of
from app.errors import LissomError
from app.motion.inbetweens import Animation, Carried, PoseSampler
from app.motion.tracing import TrackedPoints
from engine.arrays import Complexes
from engine.errors import EngineError
from engine.geometry import HERE, RigidMotion, box_diagonal, contains, deepest_point

# Newton steps towards the point of a parent that is at a place; each squares the error.
MOST_STEPS = 20
CLOSE = 1e-12  # of the figure's size
MOST_STARTS = 2_000  # triangles among which the nearest one is where the search begins
# Frames of figures that the worker works out before it looks for more urgent work, about a
# millisecond each, and those that it looks at.
BATCH, MOST_LOOKED_AT = 60, 5_000


class Hinge(NamedTuple):
    """Where a point of a figure by itself is, and by what the figure turns there."""

    place: complex
    turn: complex  # of modulus 1


def along(chain: Sequence[Figure], hinge: Callable[[Figure, complex], Hinge]) -> RigidMotion:
    """Return where a figure is that hangs on a chain of others.

    Parameters
    ----------
    chain : sequence of Figure
        The figure, the one that it hangs on, and so on.
    hinge : callable
        Returns how a point of a figure is moved and turned, the figure by itself.
    """
    placement = HERE
    for child, parent in zip(chain[-2::-1], chain[:0:-1], strict=True):
        joint = _require_attachment(child)
        at, held = hinge(parent, joint.at), hinge(child, _require_anchor(child))
        factor = 1.0 + 0j
        if joint.turns:
            factor = placement.factor * at.turn * np.exp(-1j * joint.rest)
        place = placement.factor * at.place + placement.shift
        placement = RigidMotion(complex(factor), complex(place - factor * held.place))
    return placement


class Joints:
    """The joints of a document, at any time.

    A figure hangs by its anchor: it is turned around it and moved, and nothing else, so that it is
    exactly as distorted as by itself and the joint never opens.

    Parameters
    ----------
    siblings : mapping of int to PoseSampler
        By the ids of figures; what they know of outlines is used again.
    earlier : Joints, optional
        Of an earlier document; what is still true of it is used again.

    Attributes
    ----------
    document : Document
    points : dict of int to list of complex
        Of each figure, those by which it hangs, or others hang on it.
    tracked : dict of int to TrackedPoints
        The same over time.
    is_whole : bool
        Whether all frames have been gone through.

    Raises
    ------
    EngineError
        If a joint or an anchor lies outside its figure.
    """

    def __init__(
        self,
        document: Document,
        siblings: Mapping[int, PoseSampler] | None = None,
        earlier: "Joints | None" = None,
    ) -> None:
        self.document = document
        self.points = _points(document)
        self.is_whole = False
        known = {} if earlier is None else earlier.tracked
        siblings = siblings or {}
        self.tracked: dict[int, TrackedPoints] = {
            figure: TrackedPoints(
                clip_of(document, figure),
                np.array(points),
                siblings.get(figure),
                known.get(figure),
                partial(self.carried, figure),
            )
            for figure, points in self.points.items()
            if points
        }
        self._siblings = siblings
        self._placements: dict[tuple[int, float], RigidMotion] = {}
        frames = range(document.frames.first, document.frames.last + 1)
        self._ahead = product(frames, self.tracked.values())

    @property
    def worked_out(self) -> int:
        """How many frames of figures had to be worked out, because nothing was known of them."""
        return sum(each.worked_out for each in self.tracked.values())

    def placement(
        self, figure: int, frame: float, poses: Mapping[int, Pose] | None = None
    ) -> RigidMotion:
        """Return where a figure, by its id, is at a frame.

        Parameters
        ----------
        figure : int
        frame : float
        poses : mapping of int to Pose, optional
            Shown instead of what the figures with these ids have at the frame.
        """
        chain = self.document.carriers(figure)
        if len(chain) == 1:
            return HERE
        if poses:
            return self._work_out(chain, frame, poses)
        if (figure, frame) not in self._placements:
            self._placements[figure, frame] = self._work_out(chain, frame, {})
        return self._placements[figure, frame]

    def carried(self, figure: int, frame: float) -> RigidMotion:
        """Return where a figure hangs, but for what is corrected of itself.

        That leaves its anchor in place and does not turn it.
        """
        chain = self.document.carriers(figure)

        def hinge(each: Figure, place: complex) -> Hinge:
            if each.id != figure:
                return self._joint(each, place, frame, {})
            index = self.points[figure].index(place)
            found = self.tracked[figure].base_at(frame)
            return _joint(found.positions[index], found.fz[index])

        return along(chain, hinge)

    def advance(self) -> "Joints":
        """Go through some frames, so that asking for them takes no time."""
        end = self.worked_out + BATCH
        for looked_at, (frame, tracked) in enumerate(self._ahead, 1):
            tracked.at(frame)
            if self.worked_out >= end or looked_at == MOST_LOOKED_AT:
                return self
        self.is_whole = True
        return self

    def _work_out(
        self, chain: tuple[Figure, ...], frame: float, poses: Mapping[int, Pose]
    ) -> RigidMotion:
        return along(chain, lambda figure, place: self._joint(figure, place, frame, poses))

    def hang(
        self, child: int, parent: int, frame: float, *, place: complex | None = None, turns: bool
    ) -> tuple[complex, Attachment]:
        """Return the anchor and the joint by which a figure hangs so that nothing moves now.

        Parameters
        ----------
        child, parent : int
            Ids of figures.
        frame : float
            Where nothing moves.
        place : complex, optional
            Of the joint, in the scene; by default that of the child's anchor, or, where the parent
            is not there, the middle of where the two overlap.
        turns : bool
            Whether the child turns with the parent.

        Returns
        -------
        anchor : complex
            Of the child.
        joint : Attachment

        Raises
        ------
        LissomError
            If one of the two is not at that place.
        """
        document = self.document
        own = document.figure(child)
        here, there = self.placement(child, frame), self.placement(parent, frame)
        if place is None:
            anchor = self._common_point(own, document.figure(parent), frame)
            place = complex(here.on(np.array([self._at(own, anchor, frame).place]))[0])
        else:
            anchor = self._source(own, here.back(place), frame)
        at = self._source(document.figure(parent), there.back(place), frame)
        turn = np.angle(there.factor * self._at(document.figure(parent), at, frame).turn)
        # With the parent's turn as it is now, the child is turned as it is now.
        rest = float(turn - np.angle(here.factor)) if turns else 0.0
        return anchor, Attachment(to=parent, at=at, turns=turns, rest=rest)

    def _joint(
        self, figure: Figure, place: complex, frame: float, poses: Mapping[int, Pose]
    ) -> Hinge:
        if figure.id in poses:
            return _hinge_of(figure, poses[figure.id], place)
        index = self.points[figure.id].index(place)
        moved = self.tracked[figure.id].at(frame)
        return _joint(moved.positions[index], moved.fz[index])

    def _animation_at(self, figure: Figure, points: Complexes) -> Animation:
        carried = partial(self.carried, figure.id)
        return animation_at(self.document, figure.id, points, self._siblings, carried)

    def _at(self, figure: Figure, place: complex, frame: float) -> Hinge:
        moved = self._animation_at(figure, np.array([place])).frame(frame)
        return _joint(moved.positions[0], moved.fz[0])

    def _common_point(self, child: Figure, parent: Figure, frame: float) -> complex:
        """Return the child's anchor if it is in the parent, else a point of it that is in both."""
        mesh = child.domain.mesh
        middles = mesh.vertices[mesh.triangles].mean(axis=1)
        middles = middles[:: max(1, len(middles) // MOST_STARTS)]
        anchor = (
            deepest_point(child.domain.outline, child.domain.loops[1:])
            if child.anchor is None
            else child.anchor
        )
        points = np.array([anchor, *middles])
        here, there = (self.placement(each.id, frame) for each in (child, parent))
        places = here.on(self._animation_at(child, points).frame(frame).positions)
        border = there.on(self._animation_at(parent, parent.domain.outline).frame(frame).positions)
        common = contains(border, places)
        if common[0] or not common.any():
            return anchor
        middle = places[common].mean()
        nearest = np.argmin(np.where(common, np.abs(places - middle), np.inf))
        return complex(points[nearest])

    def _source(self, figure: Figure, place: complex, frame: float) -> complex:
        """Return the point of a figure at rest that is at a place, in the figure's own terms."""
        mesh = figure.domain.mesh
        middles = mesh.vertices[mesh.triangles].mean(axis=1)
        middles = middles[:: max(1, len(middles) // MOST_STARTS)]
        moved = self._animation_at(figure, middles).frame(frame)
        source = complex(middles[np.argmin(np.abs(moved.positions - place))])
        size = box_diagonal(figure.domain.outline)
        for _ in range(MOST_STEPS):
            try:
                at = self._animation_at(figure, np.array([source])).frame(frame)
            except EngineError:
                break  # outside
            away = place - complex(at.positions[0])
            if abs(away) <= CLOSE * size:
                return source
            fz, fzbar = complex(at.fz[0]), complex(at.fzbar[0])
            area = abs(fz) ** 2 - abs(fzbar) ** 2
            source += (fz.conjugate() * away - fzbar * away.conjugate()) / area
        raise LissomError(
            f"There is nothing of {figure.name!r} at ({place.real:.0f}, {place.imag:.0f}); a joint "
            "must be on both layers: let them overlap, or put the anchor there."
        )


def carried_in(
    document: Document, figure: int, siblings: Mapping[int, PoseSampler] | None = None
) -> Carried | None:
    """Return what tells where a figure of a document hangs; None where it hangs on nothing."""
    if document.figure(figure).attachment is None:
        return None
    return partial(Joints(document, siblings).carried, figure)


def animation_at(
    document: Document,
    identity: int,
    points: Complexes,
    siblings: Mapping[int, PoseSampler],
    carried: Carried | None,
) -> Animation:
    """Return the motion of some points (m,) of a figure of a document, which may be carried."""
    figure = document.figure(identity)
    sampler = PoseSampler(
        figure.domain, anchor=figure.anchor, points=points, sibling=siblings.get(identity)
    )
    return Animation(clip_of(document, identity), sampler=sampler, carried=carried)


class HungAnimation:
    """The motion of a figure by itself, brought to where the joints of its scene have it."""

    def __init__(self, animation: Animation, joints: Joints) -> None:
        self._animation = animation
        animation.carried = partial(joints.carried, animation.clip.figure.id)
        self._joints = joints

    def positions(self, frame: float) -> Complexes:
        """Return where the points (m,) are at a frame, which may lie between two numbers."""
        placement = self._joints.placement(self._animation.clip.figure.id, frame)
        return placement.on(self._animation.positions(frame))


def joints_source(document: Document) -> tuple[object, ...]:
    """Return all of a document that its joints depend on; empty where nothing hangs."""
    hung = [figure for figure in document.figures if figure.attachment is not None]
    carriers = [
        clip_of(document, each.id) for child in hung for each in document.carriers(child.id)
    ]
    return tuple(carriers)


def hung_animations(
    animations: Iterable[Animation], document: Document
) -> dict[int, HungAnimation]:
    """Return the animations of a document's figures where its scene has them, by their ids."""
    own = {animation.clip.figure.id: animation for animation in animations}
    joints = Joints(document, {identity: each.sampler for identity, each in own.items()})
    return {identity: HungAnimation(each, joints) for identity, each in own.items()}


def _points(document: Document) -> dict[int, list[complex]]:
    """Return the points of each figure by which it hangs, or others hang on it."""
    points: dict[int, list[complex]] = {figure.id: [] for figure in document.figures}
    for figure in document.figures:
        if figure.attachment is not None:
            points[figure.id].append(_require_anchor(figure))
            points[figure.attachment.to].append(figure.attachment.at)
    return points


def _hinge_of(figure: Figure, pose: Pose, place: complex) -> Hinge:
    f, at = figure.map_of(pose), np.array([place])
    return _joint(f(at)[0], f.derivatives(at)[0][0])


def _joint(position: complex, fz: complex) -> Hinge:
    return Hinge(complex(position), complex(fz / abs(fz)))


def _require_anchor(figure: Figure) -> complex:
    if figure.anchor is None:
        raise ValueError("a figure that is attached has an anchor")
    return figure.anchor


def _require_attachment(figure: Figure) -> Attachment:
    if figure.attachment is None:
        raise ValueError("only the last carrier hangs on nothing")
    return figure.attachment
