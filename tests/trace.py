"""Count the files of the program that a drag and a scrub pass through.

`python -m tests.trace` drags a handle of the giraffe and moves the playhead, without a window, and
prints the files whose functions are called, by phase. Panels are not part of it.
"""

import sys
import tempfile
import threading
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from pathlib import Path
from types import FrameType
from typing import Any

HERE = Path(__file__).parents[1]
sys.path.insert(0, str(HERE / "tests" / "support"))

from sessions import run_update_steps, session_of, settle  # noqa: E402 - of the support folder

from app.editor import Session  # noqa: E402
from app.editor.actions import playback  # noqa: E402
from app.editor.tools import tool_pointer  # noqa: E402
from app.editor.tools.tool import PointerHit  # noqa: E402
from app.storage import decode_picture, load_project  # noqa: E402
from app.storage.assets import sample_images  # noqa: E402

OWN, PANELS = str(HERE / "app"), str(HERE / "app" / "ui" / "panels")


@contextmanager
def called_files() -> Iterator[dict[str, int]]:
    """Yield the files of the program by the number of calls of their functions, as they come."""
    files: dict[str, int] = {}

    def note(frame: FrameType, event: str, _: Any) -> None:
        name = frame.f_code.co_filename
        if event == "call" and name.startswith(OWN) and not name.startswith(PANELS):
            files[name] = files.get(name, 0) + 1

    threading.setprofile(note)
    sys.setprofile(note)
    try:
        yield files
    finally:
        sys.setprofile(None)
        threading.setprofile(None)


def tell(title: str, session: Session, act: Callable[[], None]) -> None:
    """Print the files that an action and the next update of the window pass through."""
    with called_files() as files:
        act()
        run_update_steps(session)
    calls = sum(files.values())
    print(f"{title}: {len(files)} files, {calls} calls")
    for name in sorted(files, key=files.__getitem__, reverse=True):
        print(f"    {files[name]:6}  {Path(name).relative_to(HERE)}")


def main() -> None:
    """Drag and scrub."""
    document = load_project(sample_images() / "giraffe.lissom")
    layer = document.layers[0]
    with tempfile.TemporaryDirectory() as folder:
        picture = decode_picture(layer.picture.data, layer.name).rgba
        session = session_of(document, Path(folder), picture)
        shown = session.project.layer_runtime.shown
        handle, place = layer.handles[0].id, complex(shown.handle_positions[0])
        hit = PointerHit(place=place, handle=handle, on_shape=True, layer=layer.id)
        tell("press", session, lambda: tool_pointer.press_pointer(session, hit))

        def deliver() -> None:
            session.jobs.wait_until_idle()
            session.jobs.deliver()

        def move(by: complex) -> None:
            tool_pointer.move_pointer(session, place + by)

        tell("first move", session, lambda: move(5j))
        tell("its pose", session, deliver)
        tell("next move", session, lambda: move(10j))
        tell("its pose", session, deliver)
        tell("release", session, lambda: tool_pointer.release_pointer(session, place + 10j))
        settle(session)
        tell("scrub", session, lambda: playback.scrub(session, 12))


if __name__ == "__main__":
    main()
