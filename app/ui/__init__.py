"""The window: panels are functions that read the session and return actions."""
