"""Entry of `kapitza view`, run as a file: a package that is missing is known here. Errors are one line, as the program's own are."""

import os
import sys

try:
    from kapitza.explorer.command import WrongArgument, main
    from kapitza.result import BadFile
except ModuleNotFoundError as error:
    print(f"kapitza: error: view: {sys.executable} lacks the package {error.name}; set KAPITZA_PYTHON to a Python that has those "
          "of scripts/requirements.txt (scripts/setup makes one: .venv/bin/python)", file=sys.stderr)
    sys.exit(1)

try:
    main()
except (BadFile, WrongArgument) as error:
    print(f"kapitza: error: {error}", file=sys.stderr)
    sys.exit(2)
except OSError as error:  # the address could not be printed: a full disk, a closed pipe
    print(f"kapitza: error: view: {error.strerror or error}", file=sys.stderr)
    os.dup2(os.open(os.devnull, os.O_WRONLY), sys.stdout.fileno())  # what is left would fail again at the end
    sys.exit(1)
