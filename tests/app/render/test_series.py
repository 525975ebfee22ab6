"""Vertices placed by a shader, against those placed on the processor."""

import numpy as np
import pytest
from drawings import Easel, grid_mesh, soft_blob
from messages import says
from numpy.testing import assert_allclose, assert_array_equal

from app.errors import LissomError
from app.motion.meshes.vertices import StreamedVertices, VertexArray
from app.render.drawn_mesh import DrawnMesh, shader_is_faster
from app.render.gpu.mesh import GpuMesh, PosedMesh
from app.render.gpu.programs import set_uniforms
from app.render.gpu.series_buffer import SERIES_PIECE, SeriesBuffer, max_series_rows
from app.render.gpu.target import RenderTarget
from app.render.scene import Backdrop, Ghost, Heat, Scene, Wireframe
from app.render.view import View
from app.storage.assets import shader_source
from engine.arrays import Complexes
from engine.domain import ClosedCuts
from engine.streaming import MOST_ROWS, Series, SeriesPiece

WIDTH, HEIGHT = 120, 90
SIZE = abs(complex(WIDTH, HEIGHT))
VIEW = View(centre=60 + 45j, scale=1.25, size=(180, 140))


def bending(rest: Complexes, rows: int = 7) -> Series:
    """Pieces of a motion from `rest`, with as many rows each."""
    rng = np.random.default_rng(3)
    pieces = []
    for index, start in enumerate((0.0, 0.5)):
        ends = [rest * np.exp(0.4j * time) for time in (start, start + 0.5)]
        count = rows - 2 + index
        waves = [8 * np.exp(1j * (rest.real / 20 + k)) * rest.imag / HEIGHT for k in range(count)]
        functions = rng.normal(size=(5, rows + index)) / rows
        functions[:, [0, -1]] = 0.5 * np.array([[1, 1], [-1, 1], [0, 0], [0, 0], [0, 0]])
        values = np.array([ends[0], *waves, ends[1]]).astype(np.complex64).view(np.float32)
        pieces.append(
            SeriesPiece(
                start=start,
                end=start + 0.5,
                functions=functions,
                rows=values,
            )
        )
    return Series(pieces=tuple(pieces), error=0.0)


def blob_mesh(easel: Easel) -> tuple[GpuMesh, Complexes]:
    rest, triangles = grid_mesh(WIDTH, HEIGHT, 10)
    return easel.mesh(soft_blob(WIDTH, HEIGHT), rest, triangles), rest


def series_pose(easel: Easel, mesh: GpuMesh, series: Series, time: float) -> PosedMesh:
    source = SeriesBuffer(easel.gl, mesh.count, max(len(p.rows) for p in series.pieces))
    source.place(series, time)
    return easel.pose_of(mesh, source)


def streamed_pose(easel: Easel, mesh: GpuMesh, series: Series, time: float) -> PosedMesh:
    return easel.pose(mesh, series.values(time).astype(float).view(complex))


def some_seam(mesh: GpuMesh) -> ClosedCuts:
    """A seam of every seventh triangle's first corner."""
    moved, first = np.unique(mesh.triangles[::7, 0], return_index=True)
    return ClosedCuts(
        vertices=moved.astype(np.intp),
        corners=mesh.triangles[::7][first],
        weights=np.tile([1.5, -0.2, -0.3], (len(moved), 1)),
    )


@pytest.mark.parametrize(("rows", "is_parted"), [(2, False), (7, True), (7, False), (12, False)])
def test_the_shader_places_vertices_as_the_processor_does(easel, rows, is_parted):
    mesh, rest = blob_mesh(easel)
    seam = some_seam(mesh) if is_parted else None
    series = bending(rest, rows)
    source = SeriesBuffer(easel.gl, len(rest), rows + 1, seam=seam)
    ((name, value),) = source.constants
    program = easel.gl.program(
        vertex_shader=f"#version 330 core\n#define {name} {value}\n{shader_source(source.shader)}"
        "out vec2 place; void main() { place = vertex_position(); gl_Position = vec4(0); }",
        varyings=["place"],
    )
    binding = easel.gl.vertex_array(program, [source.attribute])
    feedback = easel.gl.buffer(reserve=8 * len(rest))
    target = RenderTarget(easel.renderer.programs, (4, 4))  # feedback fails without one
    target.framebuffer.use()
    for time in (0.0, 0.13, 0.5, 0.81, 1.0, 0.2):
        source.place(series, time)
        set_uniforms(program, source.uniforms)
        binding.transform(feedback, vertices=len(rest))
        placed = np.frombuffer(feedback.read(), np.float32)
        wanted = series.values(time).reshape(-1, 2)
        wanted = wanted if seam is None else seam.close_cuts(wanted)
        assert_allclose(placed, wanted.ravel(), rtol=0, atol=1e-6 * SIZE)
        if seam is None and time in (0.0, 1.0):
            assert_array_equal(placed, series.pieces[-int(time)].rows[-int(time)])
    for owned in (binding, feedback, target, program, source):
        owned.release()


@pytest.mark.parametrize("time", [0.0, 0.3, 0.9])
def test_both_ways_give_the_same_picture(easel, time):
    mesh, rest = blob_mesh(easel)
    series, ghostly = bending(rest), bending(rest + 20, rows=4)
    frames = []
    for make in (series_pose, streamed_pose):
        pose, ghost = make(easel, mesh, series, time), make(easel, mesh, ghostly, 0.4)
        pose.write_heat((rest.real / WIDTH).astype(np.float32))
        for heat in (None, Heat(low=0.0, high=1.0)):
            scene = Scene(
                background=Backdrop(colour=(1.0, 1.0, 1.0, 1.0)),
                meshes=(pose,),
                heat=heat,
                wireframe=Wireframe(colour=(0.0, 0.1, 0.3, 0.8)),
                ghosts=(Ghost(meshes=(ghost,), tint=(0.9, 0.3, 0.1), opacity=0.5),),
            )
            frames.append(easel.frame(VIEW, scene).astype(int))
    by_shader, by_processor = frames[:2], frames[2:]
    assert (by_shader[0] < 200).any()
    for one, other in zip(by_shader, by_processor, strict=True):
        difference = np.abs(one - other).max(axis=2)
        # Rounding may hand a pixel on an edge to the other side.
        assert (difference > 2).mean() < 2e-3


def test_a_frame_after_another_series_is_its_own(easel):
    mesh, rest = blob_mesh(easel)
    first, second = bending(rest), bending(rest * 0.7, rows=4)
    source = SeriesBuffer(easel.gl, mesh.count, 8)
    pose = easel.pose_of(mesh, source)
    for series, time in ((first, 0.9), (second, 0.2), (first, 0.1)):
        source.place(series, time)
        frame = easel.frame(VIEW, Scene(meshes=(pose,))).astype(int)
        expected = easel.frame(VIEW, Scene(meshes=(streamed_pose(easel, mesh, series, time),)))
        assert (np.abs(frame - expected).max(axis=2) > 2).mean() < 2e-3


def test_what_does_not_fit_is_refused(easel):
    _, rest = blob_mesh(easel)
    with pytest.raises(LissomError, match="rows of a series, not 99"):
        SeriesBuffer(easel.gl, len(rest), 99)
    assert max_series_rows(easel.gl) >= MOST_ROWS
    source = SeriesBuffer(easel.gl, len(rest), 4)
    with pytest.raises(LissomError, match=says(SERIES_PIECE, rows=7)):
        source.place(bending(rest), 0.1)
    with pytest.raises(LissomError, match=says(SERIES_PIECE)):
        source.place(bending(rest[1:], rows=4), 0.1)
    source.release()


@pytest.mark.parametrize("by_shader", [False, True])
def test_a_mesh_shows_what_it_was_given_last(easel, by_shader):
    mesh, rest = blob_mesh(easel)
    series, long = bending(rest), bending(rest * 0.8, rows=MOST_ROWS + 3)
    drawn = DrawnMesh(mesh, by_shader=by_shader)
    order, back = mesh.triangles, mesh.triangles[::-1].copy()
    folded = 2 * np.abs(rest.real - WIDTH / 2) + 1j * rest.imag
    for vertices in (
        VertexArray(positions=folded, triangles=order),
        VertexArray(positions=folded, triangles=back),
        VertexArray(positions=rest, triangles=order),
        StreamedVertices(series, None, 0.3, order),
        StreamedVertices(series, None, 0.9, order),
        VertexArray(positions=0.5 * rest, triangles=order),
        StreamedVertices(long, None, 0.2, order),
        StreamedVertices(series, None, 0.1, order),
    ):
        pose = drawn.pose(vertices)
        assert drawn.pose(vertices) is pose
        frame = easel.frame(VIEW, Scene(meshes=(pose,))).astype(int)
        wanted = easel.pose(mesh, vertices.positions)
        wanted.paint_in_order(vertices.triangles)
        expected = easel.frame(VIEW, Scene(meshes=(wanted,)))
        assert (np.abs(frame - expected).max(axis=2) > 2).mean() < 2e-3
    drawn.release()


def test_only_a_graphics_card_places_vertices_by_itself(gl):
    assert not shader_is_faster(gl)  # both backends draw on the processor here
