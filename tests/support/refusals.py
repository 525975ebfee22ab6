"""Commands that are refused in one line."""

import pytest

from app.cli.main import main


def refusal(capsys: pytest.CaptureFixture[str], *words: object) -> str:
    """Run a command that has to leave with status 2; return the line that says why."""
    with pytest.raises(SystemExit) as leaving:
        main([str(word) for word in words])
    assert leaving.value.code == 2
    (line,) = capsys.readouterr().err.splitlines()
    return line
