"""The document that is edited, saved and rendered: values, commands, history, project file."""
