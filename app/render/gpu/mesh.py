"""The mesh of a drawing in vertex buffers, and its poses."""

from collections.abc import Mapping
from dataclasses import replace

import moderngl
import numpy as np

from app.errors import LissomError
from app.render.gpu.picture import GpuPicture
from app.render.gpu.programs import Programs, ShaderFiles, set_uniforms
from app.texts import _
from engine.arrays import Complexes, Integers, Singles, readonly
from engine.domain import ClosedCuts
from engine.domain.meshing.mesh import border_edges

Attribute = tuple[moderngl.Buffer, str, str]
"""A buffer, its format, and the attribute of the shader that it feeds."""


def to_float32_points(points: Complexes) -> Singles:
    """Return points (v,) as float32 (v, 2) for the upload."""
    return points.astype(np.complex64).view(np.float32).reshape(-1, 2)


class VertexSource:
    """Owner of the buffer of vertices; base of both kinds of sources.

    Parameters
    ----------
    shader : str
        The file in shaders/ that defines `vec2 vertex_position()`.
    attribute : Attribute
        The shader's input, one entry per vertex.
    constants : tuple of (name, value)
        Constants of the compiled shader.
    """

    def __init__(
        self, shader: str, attribute: Attribute, constants: tuple[tuple[str, int], ...] = ()
    ) -> None:
        self.shader = shader
        self.attribute = attribute
        self.constants = constants
        self._buffer = attribute[0]

    @property
    def uniforms(self) -> Mapping[str, object]:
        """The shader's uniforms in this frame."""
        return {}

    def release(self) -> None:
        self._buffer.release()


class PositionBuffer(VertexSource):
    """Owner of the positions of `count` vertices, written anew for every frame."""

    def __init__(self, context: moderngl.Context, count: int) -> None:
        buffer = context.buffer(reserve=8 * count, dynamic=True)
        super().__init__("positions.glsl", (buffer, "2f", "position"))
        self._shape = (count, 2)

    def write(self, positions: Singles) -> None:
        """Upload the positions, float32 (v, 2), of a frame.

        Raises `LissomError` if the shape does not fit the mesh or a position is not finite. Such a
        frame would be empty without an error.
        """
        if positions.shape != self._shape:
            text = _("a frame needs {needed} positions, not {shape}")
            raise LissomError(text.format(needed=self._shape, shape=positions.shape))
        # Any infinite or undefined entry makes the sum so; far cheaper than testing each entry.
        if not np.isfinite(positions.sum()):
            raise LissomError(_("the frame cannot be drawn: some of its vertices are not finite"))
        self._buffer.write(np.ascontiguousarray(positions, dtype=np.float32).data)


class GpuMesh:
    """Owner of the data shared by all poses of a drawing: texture coordinates and border.

    Parameters
    ----------
    picture : GpuPicture
        Texture of the triangles; released by its owner, after the mesh.
    rest : complex128, shape (v,)
        Undeformed vertices in pixels of the picture, y up from its lower left corner.
    triangles : int32, shape (m, 3)
        In the default painting order of a pose.
    seam : ClosedCuts, optional
        How cuts are closed.
    """

    def __init__(
        self,
        programs: Programs,
        picture: GpuPicture,
        *,
        rest: Complexes,
        triangles: Integers,
        seam: ClosedCuts | None = None,
    ) -> None:
        self.programs = programs
        self.picture = picture
        self.seam = seam
        self.first = complex(rest[0])  # the first vertex, which tells pictures' corners apart
        if seam is not None:
            rest = seam.find_painted(rest)
        self.count = len(rest)
        context = programs.context
        width, height = picture.size
        uv = np.column_stack([rest.real / width, rest.imag / height])
        self.uv = context.buffer(uv.astype(np.float32).tobytes())
        self.triangles = readonly(triangles)
        self._border: moderngl.Buffer | None = None

    @property
    def border(self) -> moderngl.Buffer:
        """The edges of the border, two vertices each, the mesh on their left."""
        if self._border is None:
            edges = border_edges(self.triangles)
            self._border = self.programs.context.buffer(edges.astype(np.uint32).tobytes())
        return self._border

    def release(self) -> None:
        self.uv.release()
        if self._border is not None:
            self._border.release()


class PaintingOrder:
    """Owner of the triangles of a pose, in the order in which they are painted."""

    def __init__(self, mesh: GpuMesh) -> None:
        self._seam = mesh.seam
        self.triangles = mesh.triangles
        painted = self._painted(mesh.triangles)
        self.count = painted.size  # indices that are drawn
        self.buffer = mesh.programs.context.buffer(_indices(painted))

    def write(self, triangles: Integers) -> None:
        painted = self._painted(triangles)
        self.buffer.write(_indices(painted))
        self.triangles, self.count = triangles, painted.size

    def _painted(self, triangles: Integers) -> Integers:
        return triangles if self._seam is None else self._seam.order_under(triangles)


class PosedMesh:
    """A mesh with a vertex source, ready to draw; owner of the source and of its draw order.

    The mesh must be released after its poses. The source must have the mesh's number of vertices.
    A pose with a `shared_order` owns neither, and must be released before their owner.
    """

    def __init__(
        self, mesh: GpuMesh, source: VertexSource, *, shared_order: PaintingOrder | None = None
    ) -> None:
        self.picture = mesh.picture
        self.first = mesh.first
        self._placement = (1.0, 0.0, 0.0, 0.0)
        self._mesh = mesh
        self.source = source
        self._is_owner = shared_order is None
        self.order = shared_order or PaintingOrder(mesh)
        self._heat: moderngl.Buffer | None = None
        self._bindings: dict[ShaderFiles, moderngl.VertexArray] = {}

    def sharing(self, mesh: GpuMesh) -> "PosedMesh":
        """Return the same pose of another picture, on a mesh with the same vertices."""
        return PosedMesh(mesh, self.source, shared_order=self.order)

    def has_vertices_of(self, other: "PosedMesh") -> bool:
        """Return whether both poses share their vertices and their draw order."""
        return self.source is other.source and self.order is other.order

    def window_in(self, other: "PosedMesh") -> tuple[float, float, float, float]:
        """Return the factors and offsets from another pose's texture coordinates to this one's.

        Both share their vertices.
        """
        (width, height), (x, y) = self.picture.size, other.picture.size
        by = self.first - other.first
        return x / width, y / height, by.real / width, by.imag / height

    def write_heat(self, values: Singles) -> None:
        """Upload the quantity (v,) of the heat map."""
        if self._mesh.seam is not None:
            values = self._mesh.seam.repeat_values(values)
        if values.shape != (self._mesh.count,):
            text = _("a heat map needs {needed} values, not {shape}")
            raise LissomError(text.format(needed=self._mesh.count, shape=values.shape))
        if self._heat is None:
            self._heat = self._mesh.programs.context.buffer(reserve=values.nbytes, dynamic=True)
        self._heat.write(np.ascontiguousarray(values, dtype=np.float32).data)

    def paint_in_order(self, triangles: Integers) -> None:
        """Paint these triangles (k, 3) in this order: the last overlapping triangle is visible.

        There may be at most as many as the mesh has.
        """
        if triangles is self.order.triangles:
            return
        most = len(self._mesh.triangles)
        if len(triangles) > most:
            text = _("the mesh can have at most {most} visible triangles, not {count}")
            raise LissomError(text.format(most=most, count=len(triangles)))
        self.order.write(triangles)

    def place(self, factor: complex, shift: complex) -> None:
        """Draw every vertex z at factor · z + shift."""
        self._placement = (factor.real, factor.imag, shift.real, shift.imag)

    def draw(self, files: ShaderFiles, uniforms: Mapping[str, object]) -> None:
        """Draw the triangles with a mesh program: its files, and the source's shader."""
        binding = self._bound(files, self.order.buffer, uniforms)
        binding.render(moderngl.TRIANGLES, vertices=self.order.count)

    def draw_border(self, files: ShaderFiles, uniforms: Mapping[str, object]) -> None:
        """Draw the edges of the border with a program of their own."""
        self._bound(files, self._mesh.border, uniforms).render(moderngl.LINES)

    def _bound(
        self, files: ShaderFiles, indices: moderngl.Buffer, uniforms: Mapping[str, object]
    ) -> moderngl.VertexArray:
        source = self.source
        if files not in self._bindings:
            vertex = (*files.vertex, source.shader)
            linked = replace(files, vertex=vertex, constants=(*files.constants, *source.constants))
            self._bindings[files] = self._bind(self._mesh.programs.get(linked), indices)
        bound = self._bindings[files]
        own = {"placement": self._placement, **source.uniforms}
        set_uniforms(bound.program, {**uniforms, **own})
        return bound

    def _bind(self, program: moderngl.Program, indices: moderngl.Buffer) -> moderngl.VertexArray:
        if "heat" in program and self._heat is None:
            raise ValueError("a heat map is to be drawn of a pose that was given no values")
        available = [self.source.attribute, (self._mesh.uv, "2f", "uv")]
        if self._heat is not None:
            available.append((self._heat, "1f", "heat"))
        # A compiler drops unused attributes of a program.
        content = [attribute for attribute in available if attribute[2] in program]
        return self._mesh.programs.context.vertex_array(
            program, content, index_buffer=indices, index_element_size=4
        )

    def release(self) -> None:
        """Release the bindings and the buffers, also the source's if it is its own."""
        for binding in self._bindings.values():
            binding.release()
        self._bindings.clear()
        if self._heat is not None:
            self._heat.release()
        if self._is_owner:
            self.order.buffer.release()
            self.source.release()


def _indices(triangles: Integers) -> bytes:
    return np.asarray(triangles, dtype=np.uint32).tobytes()
