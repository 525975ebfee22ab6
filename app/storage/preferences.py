"""The person's preferences for all projects, and the folders for settings and unsaved work."""

import json
import os
import re
from collections.abc import Mapping
from contextlib import suppress
from dataclasses import asdict, dataclass, field, replace
from pathlib import Path
from typing import Any, Literal

from app.document import LINEAR, Easing
from app.errors import LissomError
from app.export_formats import expand_colour
from app.storage.files.atomic import write_atomically
from app.storage.files.reading import read_file
from app.texts import _, list_languages, source_text

ThemeName = Literal["dark", "light"]
SMALLEST_SCALE, LARGEST_SCALE = 0.75, 3.0
MOST_RECENT = 10
MOST_GHOSTS, LARGEST_GHOST_STEP, LONGEST_PATH_REACH = 6, 24, 240
CHECKER = "checker"
LARGEST_DOCK = 500  # em
LARGEST = 1024 * 1024  # bytes
_COLOUR = re.compile("#[0-9a-f]{6}")


@dataclass(frozen=True, slots=True, kw_only=True)
class Preferences:
    """The person's preferences for all projects.

    Parameters
    ----------
    scale : float
        Of the whole interface.
    auto_key : bool
        Whether posing makes and changes keys.
    backdrop : str
        Behind the drawing: "checker" or "#rrggbb".
    easing : Easing
        Of new keys.
    ghosts_before, ghosts_after, ghost_step : int
        Numbers of onion skin ghosts, and the frames between two of them.
    path_reach : int
        Motion paths show this many frames before and after the playhead; 0 stands for the whole
        preview range.
    panel_width, timeline_height : float, optional
        Sizes in em that the person set by dragging an edge; None follows the window.
    recent : tuple of Path
        Recently opened or saved files, the newest first.
    folder : Path, optional
        Last folder of a file dialog.
    exported : Path, optional
        Last export folder.
    keys : mapping of str to str
        Key chords that the person chose, by labels of actions: "Ctrl+B", or "" for none. The file
        has the English labels.
    language : str
        Code of the language, such as "de"; empty for the system's. It is read when Lissom starts.
    memory : int, optional
        Megabytes for the decoded pictures of a file; None for a share of the machine's memory.
    """

    theme: ThemeName = "dark"
    scale: float = 1.0
    auto_key: bool = True
    easing: Easing = LINEAR
    backdrop: str = CHECKER
    ghosts_before: int = 2
    ghosts_after: int = 2
    ghost_step: int = 4
    ghosts_in_front: bool = False
    path_reach: int = 0
    panel_width: float | None = None
    timeline_height: float | None = None
    recent: tuple[Path, ...] = ()
    folder: Path | None = None
    exported: Path | None = None
    keys: Mapping[str, str] = field(default_factory=dict)
    language: str = ""
    memory: int | None = None

    @property
    def written(self) -> frozenset[Path]:
        """Folders of recent saves and exports."""
        chosen = (self.folder, self.exported, *(path.parent for path in self.recent))
        return frozenset(folder for folder in chosen if folder is not None)

    def with_recent(self, path: Path) -> "Preferences":
        others = (other for other in self.recent if other != path)
        return replace(self, recent=(path, *others)[:MOST_RECENT], folder=path.parent)

    def without_recent(self, path: Path) -> "Preferences":
        return replace(self, recent=tuple(other for other in self.recent if other != path))


def make_settings_folder(folder: Path) -> None:
    """Make the folder for settings and unsaved work, private to the person."""
    try:
        folder.mkdir(mode=0o700, parents=True, exist_ok=True)
        with suppress(OSError):  # it may belong to another person
            folder.chmod(0o700)
    except OSError as error:
        raise LissomError(
            _("the folder {folder} cannot be made: {reason}").format(
                folder=folder, reason=error.strerror or error
            )
        ) from error
    if not os.access(folder, os.W_OK | os.X_OK):
        raise LissomError(
            _("you have no permission to write to the folder {folder}").format(folder=folder)
        )


def load_preferences(folder: Path) -> Preferences:
    """Read the preferences. Missing or invalid entries get their defaults."""
    try:
        content = json.loads(read_file(folder / "preferences.json", largest=LARGEST))
    except (LissomError, ValueError, RecursionError):
        return Preferences()
    return _understood(content) if isinstance(content, dict) else Preferences()


def save_preferences(folder: Path, preferences: Preferences) -> None:
    """Write the preferences. If this fails, the old preferences stay."""
    # JSON has no paths; this converts paths and lists of paths.
    keys = {source_text(label): chords for label, chords in preferences.keys.items()}
    content = {**asdict(preferences), "easing": preferences.easing.to_json(), "keys": keys}
    text = json.dumps(content, indent=1, default=str).encode()
    make_settings_folder(folder)
    write_atomically(folder / "preferences.json", lambda file: file.write(text), is_private=True)


def _understood(content: dict[str, Any]) -> Preferences:
    def number(name: str, low: float, high: float) -> Any:
        value = content.get(name)
        if isinstance(value, (int, float)) and not isinstance(value, bool) and low <= value <= high:
            return value
        return getattr(Preferences(), name)

    recent = content.get("recent")
    paths = recent if isinstance(recent, list) else []
    folder, exported = (
        Path(value) if isinstance(value := content.get(name), str) else None
        for name in ("folder", "exported")
    )
    backdrop = expand_colour(str(content.get("backdrop"))).lower()
    chosen = content.get("keys")
    keys = chosen.items() if isinstance(chosen, dict) else ()
    return Preferences(
        theme="light" if content.get("theme") == "light" else "dark",
        scale=float(number("scale", SMALLEST_SCALE, LARGEST_SCALE)),
        auto_key=content.get("auto_key") is not False,
        easing=_easing(content.get("easing")),
        backdrop=backdrop if _COLOUR.fullmatch(backdrop) else CHECKER,
        ghosts_before=int(number("ghosts_before", 0, MOST_GHOSTS)),
        ghosts_after=int(number("ghosts_after", 0, MOST_GHOSTS)),
        ghost_step=int(number("ghost_step", 1, LARGEST_GHOST_STEP)),
        ghosts_in_front=content.get("ghosts_in_front") is True,
        path_reach=int(number("path_reach", 0, LONGEST_PATH_REACH)),
        panel_width=number("panel_width", 1, LARGEST_DOCK),
        timeline_height=number("timeline_height", 1, LARGEST_DOCK),
        keys={_(label): chords for label, chords in keys if isinstance(chords, str)},
        language=language if (language := str(content.get("language"))) in list_languages() else "",
        recent=tuple(Path(path) for path in paths if isinstance(path, str))[:MOST_RECENT],
        folder=folder,
        exported=exported,
        memory=memory if (memory := number("memory", 1, 10**9)) is None else int(memory),
    )


def _easing(content: object) -> Easing:
    try:
        return Easing.parse(content)
    except (LissomError, OverflowError):
        return LINEAR
