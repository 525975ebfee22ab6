"""Tools of the pointer in the viewport: their table, and the verbs that pass events to them.

In: presses and moves of the pointer in the scene.
Out: a session that the active tool has changed.
Imports: `app.editor.actions`.
"""

from app.editor.tools import move_tool as move_tool, tool_pointer as tool_pointer
from app.editor.tools.edit_tools import find_joint_near as find_joint_near
from app.editor.tools.numeric_entry import ERASE as ERASE
from app.editor.tools.table import TOOLS as TOOLS, tools_of as tools_of
from app.editor.tools.tool import PointerHit as PointerHit
