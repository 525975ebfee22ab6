"""One panel a module: `draw(session, look)` reads the session and returns the person's actions."""
