"""Commands: changes of a document as values, with labels for undo and redo.

A command is written as a pure function of a document and arguments. A call with the arguments alone
returns a `Command` that can be applied to a document:

    history.do(set_fps(12.0))

Most commands change one layer. They are written as pure functions of a layer, and the call takes
the layer's id first:

    history.do(rename_handle(layer.id, 3, "nose"))

An impossible command raises a `LissomError`. A command without effect returns the same document.
"""

import functools
from collections.abc import Callable, Collection, Iterable
from dataclasses import dataclass
from typing import Concatenate, ParamSpec

from app.document.layer import Layer
from app.document.model import Document

Arguments = ParamSpec("Arguments")


def with_number(name: str, taken: Collection[str], number: int) -> str:
    """Return the name with the first free number, from `number` on."""
    while f"{name} {number}" in taken:
        number += 1
    return f"{name} {number}"


@dataclass(frozen=True, slots=True)
class Command:
    """A pure function from document to document, with its label."""

    label: str
    change: Callable[[Document], Document]

    def __call__(self, document: Document) -> Document:
        return self.change(document)


def command(
    label: str,
) -> Callable[[Callable[Concatenate[Document, Arguments], Document]], Callable[Arguments, Command]]:
    """Turn a function `(document, *arguments) → document` into one `(*arguments) → Command`."""

    def make(
        change: Callable[Concatenate[Document, Arguments], Document],
    ) -> Callable[Arguments, Command]:
        @functools.wraps(change)
        def bind(*args: Arguments.args, **kwargs: Arguments.kwargs) -> Command:
            return Command(label, lambda document: change(document, *args, **kwargs))

        return bind

    return make


def combine_commands(label: str, commands: Iterable[Command]) -> Command:
    """Return a command that runs the others in order, as one undo step."""
    given = tuple(commands)

    def change(document: Document) -> Document:
        for each in given:
            document = each(document)
        return document

    return Command(label, change)


def layer_command(
    label: str,
) -> Callable[
    [Callable[Concatenate[Layer, Arguments], Layer]],
    Callable[Concatenate[int, Arguments], Command],
]:
    """Turn a function `(layer, *arguments) → layer` into one `(layer_id, *arguments) → Command`.

    The document's frames are extended to all keys of the layer.
    """

    def make(
        change: Callable[Concatenate[Layer, Arguments], Layer],
    ) -> Callable[Concatenate[int, Arguments], Command]:
        @command(label)
        @functools.wraps(change)
        def bind(
            document: Document, layer: int, /, *args: Arguments.args, **kwargs: Arguments.kwargs
        ) -> Document:
            return document.with_layer(change(document.layer(layer), *args, **kwargs))

        return bind

    return make
