"""``python -m studies.cli ...`` is ``hoop ...`` where the command is not installed."""

from . import main

if __name__ == "__main__":
    main()
