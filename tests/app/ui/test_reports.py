"""What breaks can be reported: the report names nothing of the person's, and goes nowhere."""

import getpass
from pathlib import Path

import pytest

from app.editor import error_reports
from app.editor.actions import dialog_actions, viewing
from app.editor.actions.project_files import recovery
from app.editor.parts.dialogs import FileDialog, ProblemReport, RecoveryDialog
from app.reports import format_trace
from app.storage.autosave import Autosave, load_report, write_report
from app.ui.timeline import timeline

ANN = Path("/home/ann-marie")
SECRET = ANN / "My secret" / "cat picture.png"


def caught(error):
    """Return an exception as it is when it was raised."""
    with pytest.raises(type(error)) as caught:
        raise error
    return caught.value


@pytest.mark.parametrize(
    ("error", "ending"),
    [
        (FileNotFoundError(2, "No such file", str(SECRET)), "[Errno 2] No such file: '…'"),
        (ValueError(f"{SECRET} is torn"), "ValueError: … is torn"),
        (ValueError("cat picture.png: at 3/4 and and/or"), "ValueError: …: at 3/4 and and/or"),
        (ValueError("other.LISSOM is torn"), "ValueError: ….LISSOM is torn"),
        (ValueError(r"C:\Users\Ann\dog.txt, \\nas\dog"), "ValueError: …, …"),
        (ValueError(f"{Path.home()}/a and ~/b"), "ValueError: … and …"),
        (KeyError("ann-marie"), "KeyError: '…'"),
    ],
)
def test_a_trace_names_nothing_of_the_persons(error, ending, monkeypatch):
    monkeypatch.setattr(getpass, "getuser", lambda: ANN.name)
    text = format_trace(caught(error), [SECRET])
    assert text.splitlines()[-1].endswith(ending)
    assert 'File "test_reports.py"' in text or 'File "tests/' in text
    assert str(Path(__file__).parents[3]) not in text


@pytest.fixture
def broken(window, bar, monkeypatch):
    """A bug in a panel that is reported once."""

    def fail(*_):
        raise ZeroDivisionError(f"a bug with {SECRET}")

    window.session.settings.preferences = type(window.session.settings.preferences)(
        recent=(SECRET,)
    )
    with monkeypatch.context() as patch:
        patch.setattr(timeline, "draw_transport_bar", fail)
        window.frames(2)
    yield bar
    window.session.notices.toasts = []


@pytest.mark.usefixtures("broken")
def test_a_bug_offers_a_report_that_is_shown_changed_and_saved(window, tmp_path, capfd):
    session = window.session
    window.act(viewing.toggle_overlay, "outline")
    window.run(lambda robot: robot.item_click("//##toast0/Report…"))
    window.frames(2)
    report = session.dialogs.current
    assert isinstance(report, ProblemReport)
    assert "viewing.toggle" in report.text
    assert "ZeroDivisionError: a bug with …" in report.text
    assert session.diagnostics.graphics in report.text
    for name in (str(window.folder), str(Path.home()), "cat picture", "ann-marie"):
        assert name not in report.text
    window.act(error_reports.edit_report_text, report, f"It fell over.\n{report.text}")
    window.run(lambda robot: robot.item_click("//###dialog/Save as…"))
    window.frames(2)
    assert isinstance(session.dialogs.current, FileDialog)
    window.act(dialog_actions.choose_file, session.dialogs.current, tmp_path / "it.txt")
    assert session.dialogs.current is None
    text = (tmp_path / "it.txt").read_text(encoding="utf-8")
    assert text == f"It fell over.\n{report.text}"
    capfd.readouterr()


def test_after_a_crash_the_unsaved_work_comes_first_and_the_report_is_behind_it(window, bar):
    session = window.session
    write_report(window.folder, "It was this.")
    Autosave(window.folder).write(bar.document, bar.file.origin)
    for lock in window.folder.glob("unsaved-*.lock"):
        lock.unlink()
    session.project = None
    recovery.ask_recovery(session)
    error_reports.offer_kept_report(session)
    window.frames(3)
    dialog = session.dialogs.current
    assert isinstance(dialog, RecoveryDialog)
    assert session.notices.toasts == [], "one thing at a time"
    window.run(lambda robot: robot.item_click("//###dialog/Report a problem…"))
    window.frames(2)
    assert session.dialogs.current.text == "It was this."
    window.run(lambda robot: robot.item_click("//###dialog/Close"))
    window.frames(2)
    assert session.dialogs.current is dialog
    window.run(lambda robot: robot.item_click("//###dialog/Later"))
    window.frames(2)
    assert session.dialogs.current is None
    error_reports.offer_kept_report(session)
    assert "report is saved" in session.notices.toasts[0].text
    session.notices.toasts = []
    error_reports.offer_kept_report(session)
    assert session.notices.toasts == [], "a message appeared"
    window.run(lambda robot: robot.menu_click("//##MainMenuBar/Help/Report a problem…"))
    window.frames(2)
    window.run(lambda robot: robot.item_click("//###dialog/Discard"))
    assert load_report(window.folder) == ""
    window.run(lambda robot: robot.menu_click("//##MainMenuBar/Help/Report a problem…"))
    window.frames(2)
    assert "Nothing failed" in session.dialogs.current.text
    window.run(lambda robot: robot.key_press(window.Key.escape))
    assert session.dialogs.current is None
