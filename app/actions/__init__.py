"""What a person can do: verbs that change the session, applied in one place."""
