"""The displayed frame of a layer: its pose or in-between on a mesh."""

from collections.abc import Sequence
from dataclasses import dataclass, fields, replace

import numpy as np

from app.document import Clip, PlacedLimbs, Pose, find_limbs, keyed_pose_at, segment_time_at
from app.motion.caches.corrected_frames import CorrectedFrames
from app.motion.caches.inbetween_cache import InbetweenCache
from app.motion.caches.inbetween_jobs import SingleFrame
from app.motion.inbetweens.secondary_correction import SecondaryCorrection
from app.motion.meshes.deform_mesh import DeformMesh, MeshPoints
from app.motion.meshes.vertices import StreamedVertices, Vertices
from app.motion.parenting.chain import PivotFrame
from engine.arrays import Complexes
from engine.domain import MeshedDomain
from engine.geometry import IDENTITY_MOTION, Similarity


@dataclass(frozen=True, slots=True, kw_only=True, eq=False)
class LayerFrame:
    """A frame of a layer as drawn, and the data that it was made from."""

    clip: Clip
    frame: float
    pose: Pose | None  # the displayed pose; None for an in-between
    mesh: DeformMesh
    vertices: Vertices  # of the mesh
    # Displayed until the in-between is computed: one of its two keys, another of their in-betweens,
    # or the same frame of an earlier clip or of another domain.
    placeholder: Pose | SingleFrame | Clip | MeshedDomain | None = None
    correction: SecondaryCorrection | None = None  # of tracks and springs
    is_approximate: bool = False  # whether the correction is that of an earlier clip
    # Rigid motion from the layer to the scene. All other fields are in the layer's space.
    placement: Similarity = IDENTITY_MOTION

    @property
    def is_current(self) -> bool:
        """Whether the frame itself is displayed, and no placeholder."""
        return self.placeholder is None and not self.is_approximate

    @property
    def nbytes(self) -> int:
        """Bytes of the positions."""
        return self.positions.nbytes

    @property
    def positions(self) -> Complexes:
        """Positions of the mesh's vertices, (v,)."""
        return self.vertices.positions

    @property
    def scene_positions(self) -> Complexes:
        """Positions of the mesh's vertices in the scene, (v,)."""
        return self.placement.apply(self.positions)

    @property
    def handles(self) -> MeshPoints:
        """The layer's handles, located in the mesh."""
        return self.mesh.locate_handles(self.clip.layer)

    @property
    def derivatives(self) -> tuple[Complexes, Complexes]:
        """f_z and f_z̄ at the vertices, each (v,)."""
        streamed = (
            self.vertices.derivatives if isinstance(self.vertices, StreamedVertices) else None
        )
        return self.mesh.derivatives(self.positions) if streamed is None else streamed

    @property
    def track_errors(self) -> dict[int, float]:
        """Distances in pixels of handles from the targets of their tracks, by id.

        A correction of an earlier clip may have handles that were deleted since.
        """
        found = {} if self.correction is None else self.correction.target_errors
        own = {handle.id for handle in self.clip.layer.handles}
        return {handle: miss for handle, miss in found.items() if handle in own}

    def pivot_frame_at(self, place: complex) -> PivotFrame:
        """Return position and rotation of a point in the layer's space, as exact as the mesh."""
        rest = self.mesh.domain.mesh.vertices
        found = self.mesh.locate_at_rest([place])
        positions = self.positions
        turn = found.rotations(rest, positions)[0]
        return PivotFrame(complex(found.positions_on(positions)[0]), complex(np.exp(1j * turn)))

    @property
    def placed_limbs(self) -> PlacedLimbs | None:
        """Where the bones of the layer carry their handles."""
        limbs = find_limbs(self.clip.layer)
        if limbs is None:
            return None
        return limbs.locate(self.mesh.locate_limbs(limbs).positions_on(self.positions))

    @property
    def handle_positions(self) -> Complexes:
        """Positions of the handles, (h,). Joints and rigid ends are on their bones."""
        found, placed = self.handles.positions_on(self.positions), self.placed_limbs
        if placed is not None:
            for number, handle in enumerate(self.clip.layer.handles):
                found[number] = placed.places.get(handle.id, found[number])
        return found

    @property
    def handle_rotations(self) -> list[float]:
        """Rotations of the shape at the handles, in radians; of rigid ends, those of their part."""
        turns = self.handles.rotations(self.mesh.domain.mesh.vertices, self.positions)
        placed = self.placed_limbs
        angles = {} if placed is None else placed.angles
        handles = zip(self.clip.layer.handles, turns, strict=True)
        return [angles.get(handle.id, float(turn)) for handle, turn in handles]


def evaluate_layer(
    clip: Clip,
    frame: float,
    pose: Pose | None,
    stores: Sequence[InbetweenCache],
    earlier: LayerFrame | None,
    corrected: CorrectedFrames | None = None,
) -> LayerFrame:
    """Return the best available frame; the earlier object itself without a change.

    Until an in-between is computed, the same frame before the last change replaces it, or else the
    nearest in time of its two keys and of their known in-betweens. Any replacement is exact for its
    own time. After a change of the domain, the last frame stays until there is a mesh.

    A given `pose` is displayed in place of the layer's own, with the clip's corrections. `stores`
    has at least one cache, the preferred first.
    """
    domain, moment = clip.layer.domain, segment_time_at(clip, frame)
    correction, is_rough = None, False
    if corrected is not None and corrected.clip.layer.domain is not domain:
        corrected = None
    if corrected is not None and pose is not None:
        correction = corrected.at(corrected.clip, frame)
    elif corrected is not None:
        correction, is_rough = corrected.at(clip, frame), not corrected.is_exact(clip, frame)
    is_key = pose is None
    pose = pose or keyed_pose_at(clip, moment)
    fitting = [store for store in stores if store.mesh.source is domain]
    # A correction needs a sampler, also at a key.
    needs_nothing = pose is not None and (correction is None or not is_key)
    exact = [store for store in fitting if needs_nothing or store.is_exact(clip, frame)]
    if not exact and earlier is not None and (not fitting or earlier.mesh.source is not domain):
        old = earlier.mesh.source
        return earlier if earlier.placeholder is old else replace(earlier, placeholder=old)
    if not fitting:
        raise ValueError("none of the stores is of the layer's domain")
    store = (*exact, fitting[-1])[0]
    mesh, near = store.mesh, None if exact else pose or store.nearest_pose(clip, moment)
    if near is not None and earlier is not None and _is_earlier_state(earlier, frame, store, clip):
        return _kept(earlier, clip)
    triangles = mesh.order.triangles(clip, frame)
    if (
        earlier is not None
        and (earlier.clip, earlier.mesh, earlier.pose) == (clip, mesh, pose)
        and (earlier.frame == frame or pose is not None)
        and (earlier.correction, earlier.is_approximate) == (correction, is_rough)
        and earlier.placeholder is near
        and earlier.vertices.triangles is triangles
    ):
        return earlier if earlier.frame == frame else replace(earlier, frame=frame)
    # A rough correction displaces the pose as it displaced the earlier one.
    is_exactly_corrected = is_key and correction is not None and not is_rough
    instead = near or (None if is_exactly_corrected else pose)
    vertices = store.vertices(clip, frame, instead, None if near else correction)
    if vertices is None:
        raise ValueError("what is exact has vertices")
    return LayerFrame(
        clip=clip,
        frame=frame,
        pose=pose,
        mesh=mesh,
        vertices=vertices,
        placeholder=near,
        correction=correction,
        is_approximate=is_rough,
    )


def member_frame(group: LayerFrame, clip: Clip, earlier: LayerFrame | None = None) -> LayerFrame:
    """Return the frame of a deform group's member: the same vertices for another picture.

    Its own layer has neither the pose nor the handles. Without a change it is the `earlier` object.
    """
    made = replace(group, clip=clip, pose=None, correction=None)
    if earlier is not None and all(
        getattr(earlier, each.name) is (now := getattr(made, each.name))
        or (each.name in {"clip", "frame", "placement"} and getattr(earlier, each.name) == now)
        for each in fields(made)
    ):
        return earlier
    return made


def _is_earlier_state(earlier: LayerFrame, frame: float, store: InbetweenCache, clip: Clip) -> bool:
    """Return whether the last displayed frame is this frame before a change of the clip."""
    is_exact = earlier.placeholder is None or isinstance(earlier.placeholder, Clip)
    return is_exact and earlier.frame == frame and not store.has_failed(clip)


def _kept(earlier: LayerFrame, clip: Clip) -> LayerFrame:
    """Return the frame of an earlier clip as a placeholder."""
    if earlier.clip is clip:
        return earlier
    return replace(earlier, clip=clip, placeholder=earlier.placeholder or earlier.clip)
