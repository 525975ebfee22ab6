"""Events of the system: their order, stuck modifiers, and dropped files.

In: the events of GLFW and Dear ImGui.
Out: input that Dear ImGui handles as the person meant it.
Imports: nothing of `app`.
"""
