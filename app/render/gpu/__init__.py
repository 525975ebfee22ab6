"""What lies on the graphics card: contexts, programs, textures, buffers.

In: arrays of pixels and vertices.
Out: textures, vertex buffers and targets, released by their owners.
Imports: `app.motion`, `app.storage`, ModernGL.
"""

from app.render.gpu.context import (
    AUTOMATIC,
    Backend,
    Context,
    GlError,
    create_context,
    finish_drawing,
    is_software,
    largest_size,
    probe,
    window_context,
)
from app.render.gpu.mesh import GpuMesh, PosedMesh, PositionBuffer, border_edges, singles
from app.render.gpu.picture import GpuPicture
from app.render.gpu.programs import Programs, ShaderFiles, set_uniforms
from app.render.gpu.series_buffer import SeriesBuffer
from app.render.gpu.target import RenderTarget

__all__ = [
    "AUTOMATIC",
    "Backend",
    "Context",
    "GlError",
    "GpuMesh",
    "GpuPicture",
    "PosedMesh",
    "PositionBuffer",
    "Programs",
    "RenderTarget",
    "SeriesBuffer",
    "ShaderFiles",
    "border_edges",
    "create_context",
    "finish_drawing",
    "is_software",
    "largest_size",
    "probe",
    "set_uniforms",
    "singles",
    "window_context",
]
