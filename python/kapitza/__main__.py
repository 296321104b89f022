"""Entry of `kapitza plot`, `info` and `fit`, run as a file or by python -m kapitza."""

import importlib
import sys

from kapitza.missing import refuse

COMMANDS = {"plot": "kapitza.command", "info": "kapitza.representation", "fit": "kapitza.track"}

if __name__ == "__main__":
    name, *sys.argv[1:] = sys.argv[1:] or [""]
    if name not in COMMANDS:
        print(f"kapitza: error: {name!r} is no command of the package; it must be {', '.join(COMMANDS)}",
              file=sys.stderr)
        sys.exit(2)
    try:
        module = importlib.import_module(COMMANDS[name])
    except ModuleNotFoundError as error:
        refuse(name, error)
    module.main()
