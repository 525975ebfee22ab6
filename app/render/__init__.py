"""Drawing with OpenGL: the only place that sees moderngl, for the window and without one."""
