"""Lines and discs of constant size on the screen, drawn as instances."""

from collections.abc import Mapping, Sequence
from typing import Final

import moderngl
import numpy as np

from app.render.gpu.programs import Programs, ShaderFiles, set_uniforms
from app.render.scene import Disc, Line
from app.render.view import View
from engine.arrays import Singles

_LINE: Final = ShaderFiles(vertex=("line.vert",), fragment=("line.frag",))
_LINE_LAYOUT: Final = "2f 2f 2f 2f 4f 1f 1f 1f /i"
_LINE_FIELDS: Final = ("before", "start", "end", "after", "ink", "width", "dash", "travelled")
_DISC: Final = ShaderFiles(vertex=("disc.vert",), fragment=("disc.frag",))
_DISC_LAYOUT: Final = "2f 1f 1f 1f 4f 4f /i"
_DISC_FIELDS: Final = ("centre", "radius", "rim_width", "softness", "fill", "rim")


class Overlay:
    """Owner of the buffers of lines and discs."""

    def __init__(self, programs: Programs) -> None:
        self._lines = _Instances(programs, _LINE, _LINE_LAYOUT, _LINE_FIELDS)
        self._discs = _Instances(programs, _DISC, _DISC_LAYOUT, _DISC_FIELDS)

    def draw(self, view: View, lines: Sequence[Line], discs: Sequence[Disc]) -> None:
        """Draw the lines and, over them, the discs."""
        uniforms = {**view.uniforms, "frame_size": view.size}
        if lines:
            self._lines.draw(np.concatenate([_segments(line, view) for line in lines]), uniforms)
        if discs:
            self._discs.draw(np.array([_disc(disc) for disc in discs], np.float32), uniforms)

    def release(self) -> None:
        self._lines.release()
        self._discs.release()


class _Instances:
    """Rectangles of one program, one instance per row of floats; the buffer grows as needed."""

    def __init__(
        self, programs: Programs, files: ShaderFiles, layout: str, fields: tuple[str, ...]
    ) -> None:
        self._context = programs.context
        self._program = programs.get(files)
        self._layout = layout
        self._fields = fields
        self._buffer = self._context.buffer(reserve=1 << 14, dynamic=True)
        self._binding = self._bind()

    def _bind(self) -> moderngl.VertexArray:
        content = [(self._buffer, self._layout, *self._fields)]
        return self._context.vertex_array(self._program, content)

    def draw(self, rows: Singles, uniforms: Mapping[str, object]) -> None:
        if rows.nbytes > self._buffer.size:
            self.release()
            self._buffer = self._context.buffer(reserve=2 * rows.nbytes, dynamic=True)
            self._binding = self._bind()
        self._buffer.write(rows.tobytes())
        set_uniforms(self._program, uniforms)
        self._binding.render(moderngl.TRIANGLE_STRIP, vertices=4, instances=len(rows))

    def release(self) -> None:
        self._binding.release()
        self._buffer.release()


def _segments(line: Line, view: View) -> Singles:
    """Return one row (s, 15) for each segment of a line."""
    points = np.append(line.points, line.points[0]) if line.closed else np.asarray(line.points)
    start, end = points[:-1], points[1:]
    first, last = (start[-1], end[0]) if line.closed else (start[0], end[-1])
    before, after = np.append(first, start[:-1]), np.append(end[1:], last)
    travelled = np.cumsum(np.abs(end - start)) * view.scale
    rows = np.empty((len(start), 15), np.float32)
    for column, place in enumerate((before, start, end, after)):
        rows[:, 2 * column], rows[:, 2 * column + 1] = place.real, place.imag
    rows[:, 8:12] = line.colour
    rows[:, 12], rows[:, 13] = line.width, line.dash
    rows[:, 14] = np.append(0.0, travelled[:-1])
    return rows


def _disc(disc: Disc) -> list[float]:
    numbers = [disc.centre.real, disc.centre.imag, disc.radius, disc.rim_width, disc.softness]
    return [*numbers, *disc.fill, *disc.rim]
