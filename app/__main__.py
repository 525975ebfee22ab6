"""`python -m app` is `lissom`."""

from app.cli.main import main

raise SystemExit(main())
