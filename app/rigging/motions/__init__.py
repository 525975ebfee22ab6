"""Motion presets: cycles of joint motion, independent of the body.

In: the joints of a drawing by name, and a motion with its parameters.
Out: the position of each joint at each moment.
Imports: `engine`.
"""
