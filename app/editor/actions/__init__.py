"""Actions of the person: verbs that change the session, applied in one place.

In: a session, and the arguments of a verb.
Out: the changed session; long work goes to the worker.
Imports: `app.editor`, and the rooms that do the work.
"""
