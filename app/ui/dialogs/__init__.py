"""Questions and file dialogs.

In: the open dialog of the session.
Out: the actions of its answers.
Imports: `app.ui.style`, `app.ui.shortcuts`.
"""

from app.ui.dialogs.dialogs import Dialogs as Dialogs
from app.ui.dialogs.native_dialog import find_system_dialogs as find_system_dialogs
