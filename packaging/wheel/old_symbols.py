"""Makes a library to link with that has only the symbols of a glibc of some age: exp, log and pow then bind to their
older versions.

    old_symbols.py LIBRARY OUT.so 2.28
"""

import re
import subprocess
import sys
import tempfile
from pathlib import Path

SYMBOL = re.compile(r"^[0-9a-f]{16} (.{7}) \.(\S+)\s+([0-9a-f]+)\s+\(?GLIBC_([0-9.]+)\)?\s+(\S+)$")


def number(version):
    return tuple(int(part) for part in version.split("."))


def symbols(library, newest):
    """The symbols of a library no newer than that version: name -> {version: bytes of a variable, or None of a
    function}."""
    listing = subprocess.run(["objdump", "-T", library], capture_output=True, text=True, check=True).stdout
    found = {}
    for flags, _, size, version, name in (match.groups() for match in map(SYMBOL.match, listing.splitlines()) if match):
        if number(version) <= number(newest):
            found.setdefault(name, {})[version] = int(size, 16) if flags.strip().endswith("O") else None
    return found


def source_of(found):
    """A definition for each symbol and version, the newest of them the default; and the version script."""
    lines, versions = [], set()
    for name, kinds in sorted(found.items()):
        default = max(kinds, key=number)
        for version, size in sorted(kinds.items()):
            own = f"old_{len(lines)}"
            versions.add(version)
            definition = f"void {own}(void) {{}}" if size is None else f"char {own}[{size}] = {{0}};"
            lines.append(
                f'{definition} __asm__(".symver {own},{name}@{"@" if version == default else ""}GLIBC_{version}");')
    script, before = "", ""
    for version in sorted(versions, key=number):
        script += f"GLIBC_{version} {{ {'' if before else 'local: old_*;'} }} {before};\n"
        before = f"GLIBC_{version}"
    return "\n".join(lines) + "\n", script


def main():
    library, out, newest = Path(sys.argv[1]), sys.argv[2], sys.argv[3]
    code, script = source_of(symbols(library, newest))
    with tempfile.TemporaryDirectory() as folder:
        source, versions = Path(folder, "old.c"), Path(folder, "versions")
        source.write_text(code)
        versions.write_text(script)
        subprocess.run(["gcc", "-shared", "-nostdlib", "-fPIC", "-O0", "-w", f"-Wl,-soname,{library.name}",
                        f"-Wl,--version-script={versions}", source, "-o", out], check=True)


if __name__ == "__main__":
    main()
