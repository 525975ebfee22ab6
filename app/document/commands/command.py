"""Commands: changes of a document as values, with the words that undo and redo show.

A command is defined as a pure function of a document and arguments; called with the arguments
alone it gives a `Command` that waits for its document:

    history.do(set_fps(12.0))

Most commands change one layer. They are defined as pure functions of a layer, and are told by its
id which one they are for:

    history.do(rename_handle(layer.id, 3, "nose"))

A command raises a `LissomError` where it is not possible, and returns the very same document where
it changes nothing.
"""

import functools
from collections.abc import Callable, Collection, Iterable
from dataclasses import dataclass
from typing import Concatenate, ParamSpec

from app.document.layer import Layer
from app.document.model import Document

Arguments = ParamSpec("Arguments")


def with_number(name: str, taken: Collection[str], number: int) -> str:
    """Return a name with the first number, from one on, with which it is not taken."""
    while f"{name} {number}" in taken:
        number += 1
    return f"{name} {number}"


@dataclass(frozen=True, slots=True)
class Command:
    """A pure function from document to document, and what it does in words."""

    label: str
    change: Callable[[Document], Document]

    def __call__(self, document: Document) -> Document:
        """Return the changed document."""
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
    """Return the command that runs others one after the other, as one step."""
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

    The animation grows where keys of the layer would lie beyond its ends.
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
