"""What the pointer does in the viewport: one table of tools, and the verbs that give it to them.

In: presses and moves of the pointer in the drawing's plane.
Out: a session that the tool in hand has changed, and that forgets it where it is cancelled.
Imports: `app.editor.actions`.
"""

from app.editor.tools import move_tool as move_tool, tool_pointer as tool_pointer
from app.editor.tools.edit_tools import find_joint_near as find_joint_near
from app.editor.tools.numeric_entry import ERASE as ERASE
from app.editor.tools.table import TOOLS as TOOLS, tools_of as tools_of
from app.editor.tools.tool import PointerHit as PointerHit
