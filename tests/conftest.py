import hypothesis

# Runs are repeatable, and no test depends on the machine's speed.
hypothesis.settings.register_profile("lissom", deadline=None, derandomize=True, database=None)
hypothesis.settings.load_profile("lissom")
