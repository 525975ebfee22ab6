"""The manual's pictures and clips of the window, and of which window they are."""

import hashlib
import json
from collections.abc import Sequence
from pathlib import Path

from app.editor.actions.project_files import saving
from tests.manual.film import Film
from tests.manual.films import FILMS
from tests.manual.stage import SIZE
from tests.manual.stills import STILLS
from tests.readme.shown import shown_now

DRAWN = STILLS | FILMS
DRAWN_OF = Path(__file__).with_name("drawn.json")


def window_digest() -> str:
    """Return what tells whether menus, tabs and tools are those of when a picture was taken."""
    return hashlib.sha256(json.dumps(shown_now()).encode()).hexdigest()[:12]


def draw(names: Sequence[str], folder: Path) -> None:
    """Take pictures and clips of the window into a folder, and note of which window they are."""
    if not names:
        return
    window = Film()
    digest = window_digest()
    for name in names:
        window.reset()
        window.resize(SIZE)
        DRAWN[name](window, folder / name)
        # What another drawing is open for is not to be asked.
        saving.set_project(window.session, None)
        drawn = json.loads(DRAWN_OF.read_text()) if DRAWN_OF.exists() else {}
        kept = {each: of for each, of in drawn.items() if each in DRAWN} | {name: digest}
        DRAWN_OF.write_text(json.dumps(kept, indent=2, sort_keys=True) + "\n")
        print(name, flush=True)
