"""How a failed job is told."""

import traceback

from app.editor.session import Session
from app.errors import EXPECTED_ERRORS


def report(session: Session, what: str, error: Exception) -> None:
    """Show what failed, and why; a surprise comes with details to copy."""
    if isinstance(error, EXPECTED_ERRORS):
        session.tell(f"{what}: {error}", tone="error")
    else:
        details = "".join(traceback.format_exception(error))
        session.tell(f"{what}.", tone="error", details=details)
