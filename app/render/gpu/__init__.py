"""Objects on the graphics card: contexts, programs, textures, buffers.

In: arrays of pixels and vertices.
Out: textures, vertex buffers and targets, released by their owners.
Imports: `app.motion`, `app.storage`, ModernGL.
"""

from app.render.gpu.context import (
    AUTOMATIC as AUTOMATIC,
    Backend as Backend,
    Context as Context,
    GlError as GlError,
    create_context as create_context,
    describe_graphics as describe_graphics,
    finish_drawing as finish_drawing,
    is_software as is_software,
    largest_size as largest_size,
    probe_backend as probe_backend,
    window_context as window_context,
)
from app.render.gpu.mesh import (
    GpuMesh as GpuMesh,
    PosedMesh as PosedMesh,
    PositionBuffer as PositionBuffer,
    border_edges as border_edges,
    to_float32_points as to_float32_points,
)
from app.render.gpu.picture import GpuPicture as GpuPicture
from app.render.gpu.programs import (
    Programs as Programs,
    ShaderFiles as ShaderFiles,
    set_uniforms as set_uniforms,
)
from app.render.gpu.series_buffer import SeriesBuffer as SeriesBuffer
from app.render.gpu.target import RenderTarget as RenderTarget
