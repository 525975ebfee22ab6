"""What lies on the graphics card: contexts, programs, textures, buffers.

In: arrays of pixels and vertices.
Out: textures, vertex buffers and targets, released by their owners.
Imports: `app.motion`, `app.storage`, ModernGL.
"""

from app.render.gpu import gpu_mesh
from app.render.gpu.context import (
    AUTOMATIC,
    Backend,
    Context,
    GlError,
    create_context,
    finish,
    is_software,
    probe,
    window_context,
)
from app.render.gpu.gpu_mesh import GpuMesh, Pose, Singles, StreamedVertices, singles
from app.render.gpu.gpu_picture import GpuPicture
from app.render.gpu.programs import Programs, Stages, set_uniforms
from app.render.gpu.series_vertices import SeriesVertices
from app.render.gpu.target import Target

__all__ = [
    "AUTOMATIC",
    "Backend",
    "Context",
    "GlError",
    "GpuMesh",
    "GpuPicture",
    "Pose",
    "Programs",
    "SeriesVertices",
    "Singles",
    "Stages",
    "StreamedVertices",
    "Target",
    "create_context",
    "finish",
    "gpu_mesh",
    "is_software",
    "probe",
    "set_uniforms",
    "singles",
    "window_context",
]
