"""A mesh with a new pose in each frame, computed by the processor or by the graphics card."""

import moderngl

from app.motion import StreamedVertices, Vertices
from app.render.gpu.context import is_software
from app.render.gpu.mesh import GpuMesh, PosedMesh, PositionBuffer, to_float32_points
from app.render.gpu.picture import GpuPicture
from app.render.gpu.series_buffer import SeriesBuffer
from engine.geometry import IDENTITY_MOTION, Similarity
from engine.streaming import MOST_ROWS, Series


class DrawnMesh:
    """Owner of the poses of a mesh; the mesh must be released after it.

    `by_shader` means that the shader computes streamed vertices; see `shader_is_faster`.
    """

    def __init__(self, mesh: GpuMesh, *, by_shader: bool) -> None:
        self._mesh = mesh
        self._context = mesh.programs.context
        self._by_shader = by_shader
        self._written = PositionBuffer(self._context, mesh.count)
        self._pose = PosedMesh(mesh, self._written)
        self._series: SeriesBuffer | None = None
        self._series_pose: PosedMesh | None = None
        self._current: tuple[Vertices, PosedMesh] | None = None

    @property
    def picture(self) -> GpuPicture:
        return self._mesh.picture

    def pose(self, vertices: Vertices, *, placement: Similarity = IDENTITY_MOTION) -> PosedMesh:
        """Return the mesh posed and painted by these vertices; new vertices are uploaded."""
        if self._current is None or self._current[0] is not vertices:
            self._current = vertices, self._placed(vertices)
        posed = self._current[1]
        posed.place(*placement)
        return posed

    def release(self) -> None:
        self._pose.release()
        if self._series_pose is not None:
            self._series_pose.release()

    def _placed(self, vertices: Vertices) -> PosedMesh:
        posed = self._positioned(vertices)
        posed.paint_in_order(vertices.triangles)
        return posed

    def _positioned(self, vertices: Vertices) -> PosedMesh:
        if isinstance(vertices, StreamedVertices) and self._by_shader and _fits(vertices.series):
            if self._series is None or self._series_pose is None:
                self._series = SeriesBuffer(
                    self._context, self._mesh.count, MOST_ROWS, seam=self._mesh.seam
                )
                self._series_pose = PosedMesh(self._mesh, self._series)
            self._series.place(vertices.series, vertices.time)
            return self._series_pose
        seam, positions = self._mesh.seam, vertices.positions
        self._written.write(
            to_float32_points(positions if seam is None else seam.close_cuts(positions))
        )
        return self._pose


class MemberMesh:
    """Owner of the poses of a mesh with the vertices of another one, which are uploaded once.

    It must be released before the other one, the `leader`.
    """

    def __init__(self, mesh: GpuMesh, leader: DrawnMesh) -> None:
        self._mesh = mesh
        self._leader = leader
        self._poses: dict[PosedMesh, PosedMesh] = {}

    @property
    def picture(self) -> GpuPicture:
        return self._mesh.picture

    def pose(self, vertices: Vertices, *, placement: Similarity = IDENTITY_MOTION) -> PosedMesh:
        """Return the mesh posed by these vertices."""
        leading = self._leader.pose(vertices, placement=placement)
        if leading not in self._poses:
            self._poses[leading] = leading.sharing(self._mesh)
        posed = self._poses[leading]
        posed.place(*placement)
        return posed

    def release(self) -> None:
        for posed in self._poses.values():
            posed.release()


def shader_is_faster(context: moderngl.Context) -> bool:
    """Return whether the shader should compute streamed vertices, and not the processor.

    In software OpenGL the processor's matrix-vector product with an upload is faster: `python -m
    tests.bench streaming` measures both. A graphics card needs only the weights.
    """
    return not is_software(context)


def _fits(series: Series) -> bool:
    return all(len(piece.rows) <= MOST_ROWS for piece in series.pieces)
