"""Questions, and the choice of a file.

In: the dialog that the session has open.
Out: the actions of its answers.
Imports: `app.ui.style`, `app.ui.shortcuts`.
"""

from app.ui.dialogs.dialogs import Dialogs as Dialogs
from app.ui.dialogs.native_dialog import find_system_dialogs as find_system_dialogs
