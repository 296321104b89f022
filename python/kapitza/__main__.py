"""Entry of the commands that are Python, run as a file or by python -m kapitza."""

import importlib
import sys

from kapitza.missing import refuse

COMMANDS = {"plot": "kapitza.command", "info": "kapitza.representation", "fit": "kapitza.track",
            "where": "kapitza.where_command",
            "needs": "kapitza.shaker", "view": "kapitza.explorer.command"}

if __name__ == "__main__":  # processes of the explorer import this too
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
