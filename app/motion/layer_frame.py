"""The displayed frame of a layer: its pose or in-between on a mesh."""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace
from functools import partial

import numpy as np

from app.document import (
    Attachment,
    Clip,
    Document,
    Layer,
    Pose,
    keyed_pose_at,
    segment_time_at,
    transform_at,
)
from app.motion.corrected_frames import CorrectedFrames
from app.motion.deform_mesh import DeformMesh, MeshPoints
from app.motion.inbetween_cache import InbetweenCache
from app.motion.inbetween_jobs import SingleFrame
from app.motion.inbetweens.secondary_correction import SecondaryCorrection
from app.motion.parenting.chain import PivotFrame, compose_chain, parent_links
from app.motion.parenting.parent_transforms import ParentTransforms
from app.motion.vertices import StreamedVertices, Vertices
from engine.arrays import Complexes
from engine.domain import MeshedDomain
from engine.geometry import IDENTITY_MOTION, RigidMotion


@dataclass(frozen=True, slots=True, kw_only=True, eq=False)
class LayerFrame:
    """A frame of a layer as drawn, and the data that it was made from."""

    clip: Clip
    frame: int
    pose: Pose | None  # the displayed pose; None for an in-between
    mesh: DeformMesh
    vertices: Vertices  # of the mesh
    handles: MeshPoints  # the layer's handles, located in the mesh
    # Displayed until the in-between is computed: one of its two keys, another of their in-betweens,
    # or the same frame of an earlier clip or of another domain.
    placeholder: Pose | SingleFrame | Clip | MeshedDomain | None = None
    correction: SecondaryCorrection | None = None  # of tracks and springs
    is_approximate: bool = False  # whether the correction is that of an earlier clip
    # Rigid motion from the layer to the scene. All other fields are in the layer's space.
    placement: RigidMotion = IDENTITY_MOTION

    @property
    def is_current(self) -> bool:
        """Whether the frame itself is displayed, and no placeholder."""
        return self.placeholder is None and not self.is_approximate

    @property
    def positions(self) -> Complexes:
        """Positions of the mesh's vertices, (v,)."""
        return self.vertices.positions

    @property
    def derivatives(self) -> tuple[Complexes, Complexes]:
        """f_z and f_z̄ at the vertices, each (v,)."""
        streamed = (
            self.vertices.derivatives if isinstance(self.vertices, StreamedVertices) else None
        )
        return self.mesh.derivatives(self.positions) if streamed is None else streamed

    def pivot_frame_at(self, place: complex) -> PivotFrame:
        """Return position and rotation of a point in the layer's space, as exact as the mesh."""
        rest = self.mesh.domain.mesh.vertices
        found = self.mesh.locate(np.array([place]), rest)
        positions = self.positions
        turn = found.rotations(rest, positions)[0]
        return PivotFrame(complex(found.positions_on(positions)[0]), complex(np.exp(1j * turn)))

    @property
    def handle_positions(self) -> Complexes:
        """Positions of the handles, (h,)."""
        return self.handles.positions_on(self.positions)

    @property
    def handle_rotations(self) -> list[float]:
        """Rotations of the shape at the handles, in radians."""
        turns = self.handles.rotations(self.mesh.domain.mesh.vertices, self.positions)
        return [float(turn) for turn in turns]


def evaluate_layer(
    clip: Clip,
    frame: int,
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
        handles=_locate(clip, mesh, earlier),
        placeholder=near,
        correction=correction,
        is_approximate=is_rough,
    )


def _is_earlier_state(earlier: LayerFrame, frame: int, store: InbetweenCache, clip: Clip) -> bool:
    """Return whether the last displayed frame is this frame before a change of the clip."""
    is_exact = earlier.placeholder is None or isinstance(earlier.placeholder, Clip)
    return is_exact and earlier.frame == frame and not store.has_failed(clip)


def _kept(earlier: LayerFrame, clip: Clip) -> LayerFrame:
    """Return the frame of an earlier clip as a placeholder, with the present handles."""
    if earlier.clip is clip:
        return earlier
    handles, was = _locate(clip, earlier.mesh, earlier), earlier.placeholder
    return replace(earlier, clip=clip, handles=handles, placeholder=was or earlier.clip)


def place_displayed_frames(
    document: Document,
    shown: Mapping[int, LayerFrame],
    joints: ParentTransforms | None,
    poses: Mapping[int, Pose],
    earlier: ParentTransforms | None = None,
) -> dict[int, LayerFrame]:
    """Return the displayed frames with the layers' placements in the scene.

    `shown` and `poses` have layer ids as keys; `poses` are displayed poses that are not in the
    document. Without the document's `joints`, placements have the accuracy of the meshes. So do
    children of a displayed pose with a correction, which the joints do not contain. Until joints
    exist, the transforms of an earlier document serve attachments with `keep_world_transform`.
    """
    placed, corrected = {}, {each for each in poses if shown[each].correction is not None}
    for identity, each in shown.items():
        layer = document.layer(identity)
        if not layer.attachments:
            placement = transform_at(document, layer, each.frame)
        elif joints is None or any(
            each.id in corrected for each in document.all_ancestors(identity)
        ):
            chain = parent_links(document, identity, each.frame)
            kept = partial(_earlier_transform, earlier, each.frame)
            placement = compose_chain(
                chain, lambda layer, place: shown[layer.id].pivot_frame_at(place), kept
            )
        else:
            placement = joints.placement(identity, each.frame, poses)
        same = placement == each.placement
        placed[identity] = each if same else replace(each, placement=placement)
    return placed


def _earlier_transform(
    earlier: ParentTransforms | None, frame: float, layer: Layer, joint: Attachment
) -> RigidMotion:
    """Return the transform that an attachment kept in an earlier document, else the identity."""
    known = {each.id: each for each in earlier.document.layers} if earlier else {}
    was = known.get(layer.id)
    if earlier is None or was is None or joint not in earlier.document.attachments_of(was):
        return IDENTITY_MOTION
    return earlier.kept_transform(was, joint, frame)


def _locate(clip: Clip, mesh: DeformMesh, earlier: LayerFrame | None) -> MeshPoints:
    if (
        earlier is not None
        and earlier.mesh is mesh
        and earlier.clip.layer.handles == clip.layer.handles
    ):
        return earlier.handles
    places = np.array([handle.position for handle in clip.layer.handles], dtype=np.complex128)
    return mesh.locate(places, mesh.domain.mesh.vertices)
