"""Entry of `kapitza view`, run as a file: a package that is missing is known here. Errors are one line, as the program's own are."""

import os
import sys

from kapitza.missing import refuse

try:
    from kapitza.explorer.command import WrongArgument, main
    from kapitza.result import BadFile
except ModuleNotFoundError as error:
    refuse("view", error)

try:
    main()
except (BadFile, WrongArgument) as error:
    print(f"kapitza: error: {error}", file=sys.stderr)
    sys.exit(2)
except OSError as error:  # the address could not be printed: a full disk, a closed pipe
    print(f"kapitza: error: view: {error.strerror or error}", file=sys.stderr)
    os.dup2(os.open(os.devnull, os.O_WRONLY), sys.stdout.fileno())  # the rest would fail again at the end
    sys.exit(1)
