"""The list of layers: its rows, and soloed layers."""

from dataclasses import dataclass, field
from typing import NamedTuple

from app.document import Document, TreeRow, layer_tree
from app.editor.work.derived import Derived
from app.editor.work.revised import Revised

UNFOLD = 0.6  # seconds for which a drag rests on a folded row until the row opens
PAUSE = 0.25  # seconds without a frame on the row after which the rest begins anew


class RowRest(NamedTuple):
    """The rest of a drag on a folded row: its beginning, and its last frame, in seconds."""

    row: str
    since: float
    last: float


@dataclass(slots=True, kw_only=True, eq=False)
class LayerListState(Revised):
    """The view of the list of layers."""

    solo: frozenset[int] = frozenset()  # ids of soloed layers
    toggled_rows: frozenset[str] = frozenset()  # layer tree rows opened or closed by hand
    bending_suggestions: tuple[tuple[int, ...], ...] = ()  # layers that may bend as one
    dismissed_suggestions: frozenset[str] = frozenset()  # groups without a switch suggestion
    # Formerly active layers whose rows stay until the pointer is over the drawing again.
    lingering: frozenset[int] = frozenset()
    last_listed_layer: int | None = None  # the layer to which the list was scrolled
    row_rest: RowRest | None = None
    named_layer: int | None = None  # layer whose name is edited
    pointed_layer: int | None = None  # layer whose row is under the pointer
    is_import_log_open: bool = False
    # Rows by document, toggled rows, and ids whose rows stay.
    tree_rows: Derived[tuple[Document, frozenset[str], frozenset[int]], tuple[TreeRow, ...]] = (
        field(default_factory=lambda: Derived(()))
    )

    def rows(self, document: Document, active: int) -> tuple[TreeRow, ...]:
        """Return the rows, the front layer on top."""
        source = document, self.toggled_rows, self.lingering | {active}
        if not self.tree_rows.follows(source):
            self.tree_rows.set(source, layer_tree(*source))
        return self.tree_rows.value

    def toggle_solo(self, layers: frozenset[int]) -> None:
        """Solo only these layers, or none if these are soloed."""
        self.solo = frozenset() if self.solo == layers else layers

    def toggle_row(self, row: str) -> None:
        """Open or close a row of the layer tree."""
        self.toggled_rows ^= {row}
        self.drop_lingering()

    def rest_on_row(self, row: str, now: float) -> bool:
        """Note a frame of a drag on a folded row; return whether the rest was long enough."""
        rest = self.row_rest
        goes_on = rest is not None and rest.row == row and now - rest.last < PAUSE
        since = rest.since if rest is not None and goes_on else now
        self.row_rest = RowRest(row, since, now)
        return now - since >= UNFOLD

    def linger(self, layer: int) -> None:
        """Let the row of a layer stay that is not active any more."""
        self.lingering |= {layer}

    def drop_lingering(self) -> None:
        """List only the layers of open rows, and the active layer."""
        self.lingering = frozenset()

    def dismiss_suggestion(self, group: str) -> None:
        """Stop suggesting a switch for a group."""
        self.dismissed_suggestions |= {group}

    def suggest_bending(self, layers: tuple[tuple[int, ...], ...]) -> None:
        """Suggest sets of layers that may bend as one."""
        self.bending_suggestions = layers

    def dismiss_bending(self, layers: tuple[int, ...]) -> None:
        """Stop suggesting that these layers bend as one."""
        self.bending_suggestions = tuple(
            each for each in self.bending_suggestions if each != layers
        )

    def note_listed(self, layer: int) -> None:
        """Note that the list has scrolled to a layer."""
        self.last_listed_layer = layer

    def edit_name(self, layer: int | None) -> None:
        """Edit a layer's name in the list; None ends the editing."""
        self.named_layer = layer

    def point_at(self, layer: int | None) -> None:
        """Note the layer whose row is under the pointer in this frame."""
        # It is no change for which anything is updated: it comes and goes in every frame.
        object.__setattr__(self, "pointed_layer", layer)

    def show_import_log(self, *, shown: bool) -> None:
        self.is_import_log_open = shown

    def keep_existing(self, document: Document) -> None:
        """Forget soloed layers that a document does not have."""
        self.solo &= {layer.id for layer in document.layers}
