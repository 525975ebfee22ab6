"""The window: the session, what is drawn with OpenGL, and the loop around them."""




