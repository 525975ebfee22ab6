"""The motion of a layer on a mesh: single frames, prepared in-betweens, and time series.

In: a clip (a layer on its document's timeline) and a frame.
Out: positions of the vertices, and their bounding boxes.
Imports: `app.document`, `app.rigging`, `engine`.
"""

from app.motion.caches.corrected_frames import (
    CorrectedFrames as CorrectedFrames,
    CorrectionUpdate as CorrectionUpdate,
    reuse_corrections as reuse_corrections,
)
from app.motion.caches.inbetween_cache import (
    InbetweenCache as InbetweenCache,
    InbetweenPart as InbetweenPart,
)
from app.motion.caches.inbetween_jobs import (
    AnyInbetweens as AnyInbetweens,
    CachedSegment as CachedSegment,
    CacheUpdate as CacheUpdate,
    SeriesBuild as SeriesBuild,
)
from app.motion.caches.segment_memory import MemoryBudget as MemoryBudget
from app.motion.evaluator import (
    Evaluator as Evaluator,
    SceneFrame as SceneFrame,
)
from app.motion.extents.extent import (
    BoundingBox as BoundingBox,
    bounding_box as bounding_box,
    extent_key as extent_key,
    measure_extent as measure_extent,
)
from app.motion.inbetweens.animation import Animation as Animation
from app.motion.inbetweens.frame_corrector import (
    BaseMotionFrame as BaseMotionFrame,
    needs_correction as needs_correction,
)
from app.motion.inbetweens.pose_sampler import PoseSampler as PoseSampler
from app.motion.inbetweens.slider_stage import apply_correction as apply_correction
from app.motion.inbetweens.spring_offsets import ParentMotion as ParentMotion
from app.motion.layer_frame import (
    LayerFrame as LayerFrame,
    evaluate_layer as evaluate_layer,
)
from app.motion.layer_stages import LayerStages as LayerStages
from app.motion.meshes.deform_mesh import DeformMesh as DeformMesh, MeshPoints as MeshPoints
from app.motion.meshes.triangle_order import TriangleOrder as TriangleOrder
from app.motion.meshes.vertices import (
    StreamedVertices as StreamedVertices,
    VertexArray as VertexArray,
    Vertices as Vertices,
)
from app.motion.parenting.attach import (
    anchor_or_default as anchor_or_default,
    attach_as_drawn as attach_as_drawn,
    attach_in_place as attach_in_place,
    reparent_in_place as reparent_in_place,
)
from app.motion.parenting.chain import require_anchor as require_anchor
from app.motion.parenting.layer_pull import LayerPull as LayerPull
from app.motion.parenting.parent_transforms import (
    ParentTransforms as ParentTransforms,
    find_parent_motion as find_parent_motion,
    layer_animation as layer_animation,
)
from app.motion.parenting.parenting_key import parenting_key as parenting_key
from app.motion.rival_methods.boundary_keyframes import (
    discrete_harmonic as discrete_harmonic,
    harmonic_coordinate_maps as harmonic_coordinate_maps,
)
from app.motion.rival_methods.mesh_keyframes import (
    MeshFrame as MeshFrame,
    MeshInbetweens as MeshInbetweens,
)
from app.motion.rival_methods.preparation import (
    PreparedBaseline as PreparedBaseline,
    prepare_baseline as prepare_baseline,
)
from app.motion.rival_methods.triangulated_domain import TriangulatedDomain as TriangulatedDomain
from app.motion.tracing.motion_paths import MotionPaths as MotionPaths, trace_paths as trace_paths
