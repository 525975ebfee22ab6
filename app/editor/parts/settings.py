"""Settings: the person's preferences, and the folder of preferences and unsaved work."""

from dataclasses import dataclass, field, replace
from pathlib import Path
from typing import Any

from app.document import Meshing
from app.editor.work.revised import Revised
from app.folders import home_folder
from app.storage import Autosave, Preferences


@dataclass(slots=True, kw_only=True, eq=False)
class SessionSettings(Revised):
    """Settings that outlive a project."""

    folder: Path  # folder of settings and unsaved work
    preferences: Preferences = field(default_factory=Preferences)
    saved_preferences: Preferences = field(init=False)  # as on the disk
    autosave: Autosave = field(init=False)
    default_meshing: Meshing | None = None  # of new pictures; None follows their size
    # Whether values are prepared before they are shown: in-betweens, corrections, series for
    # smooth playback, measured distortion and the extent of the motion. Most tests turn this off.
    prepares_ahead: bool = True

    def __post_init__(self) -> None:
        self.saved_preferences = self.preferences
        self.autosave = Autosave(self.folder)

    @property
    def usual_folder(self) -> Path:
        """The person's last folder."""
        folder = self.preferences.folder
        return folder if folder is not None and folder.is_dir() else home_folder()

    def prefer(self, **values: Any) -> None:
        """Change some preferences."""
        self.preferences = replace(self.preferences, **values)

    def add_recent(self, path: Path) -> None:
        """Note that a file was opened or saved."""
        self.preferences = self.preferences.with_recent(path)

    def remove_recent(self, path: Path) -> None:
        self.preferences = self.preferences.without_recent(path)

    def note_saved(self) -> None:
        """Note that the preferences are written to the disk."""
        self.saved_preferences = self.preferences
