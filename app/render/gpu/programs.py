"""The GLSL programs, joined from the files in shaders/ and compiled at first use."""

from collections.abc import Mapping
from dataclasses import dataclass
from typing import Final

import moderngl

from app.storage import shader_source

HEADER: Final = "#version 330 core\n"


@dataclass(frozen=True, slots=True, kw_only=True)
class ShaderFiles:
    """The files of a program; those of one stage are joined in order."""

    vertex: tuple[str, ...]
    fragment: tuple[str, ...]
    geometry: str = ""  # empty without a geometry stage
    constants: tuple[tuple[str, int | str], ...] = ()  # of the vertex and the fragment stage


class Programs:
    """Owner of the compiled programs of a context."""

    def __init__(self, context: moderngl.Context) -> None:
        self.context = context
        self._compiled: dict[ShaderFiles, moderngl.Program] = {}
        self._screens: dict[ShaderFiles, moderngl.VertexArray] = {}

    def get(self, files: ShaderFiles) -> moderngl.Program:
        """Return a program, compiled at the first request."""
        if files not in self._compiled:
            self._compiled[files] = self.context.program(
                vertex_shader=_join(*files.vertex, constants=files.constants),
                fragment_shader=_join(*files.fragment, constants=files.constants),
                geometry_shader=_join(files.geometry) if files.geometry else None,
            )
        return self._compiled[files]

    def draw_screen(self, files: ShaderFiles, uniforms: Mapping[str, object]) -> None:
        """Draw the triangle of screen.vert, which covers the whole frame."""
        program = self.get(files)
        if files not in self._screens:
            self._screens[files] = self.context.vertex_array(program, [])
        set_uniforms(program, uniforms)
        self._screens[files].render(moderngl.TRIANGLES, vertices=3)

    def release(self) -> None:
        for screen in self._screens.values():
            screen.release()
        for program in self._compiled.values():
            program.release()
        self._screens.clear()
        self._compiled.clear()


def set_uniforms(program: moderngl.Program, values: Mapping[str, object]) -> None:
    for name, value in values.items():
        program[name] = value


def _join(*names: str, constants: tuple[tuple[str, int | str], ...] = ()) -> str:
    definitions = "".join(f"#define {name} {value}\n" for name, value in constants)
    # The numbers give a compiler's message the file, counted from 0, and its line.
    texts = (f"#line 1 {number}\n{shader_source(name)}" for number, name in enumerate(names))
    return HEADER + definitions + "\n".join(texts)
