"""Makes the binary wheel: the Python package's own wheel, the launcher as bin/kapitza, one build of the program for each instruction set
in libexec, and the licences of the libraries inside.

    assemble.py PURE.whl LAUNCHER SHARE LICENCES OUT ARCH=PROGRAM...
"""

import re
import shutil
import subprocess
import sys
import tempfile
import zipfile
from pathlib import Path

TAG = "py3-none-linux_x86_64"  # auditwheel finds the policy that holds
MPI = "mpich>=5,<6; sys_platform == 'linux'"
NOTICE = """This wheel contains programs that are linked with the GNU Scientific Library, FFTW and the other libraries named here, so the
wheel as a whole is under the GNU General Public License, version 3 or later. The sources of kapitza itself are under the MIT licence.
The sources of the libraries are Debian's: the source packages with these names, versions and SHA-256 (lines `source`), and those of the
packages whose static libraries were taken (lines `static`).

"""


def rewrite_metadata(text, licences):
    """Licence, licence files and the MPI that the wheel needs."""
    text = re.sub(r"^License-Expression: .*$", "License-Expression: GPL-3.0-or-later", text, count=1, flags=re.M)
    files = "".join(f"License-File: {name}\n" for name in licences)
    text = re.sub(r"^(License-File: .*\n)", lambda found: found[1] + files, text, count=1, flags=re.M)
    return re.sub(r"^Requires-Dist: ", f"Requires-Dist: {MPI}\nRequires-Dist: ", text, count=1, flags=re.M)


def add_licences(info, licences):
    """Copies them beside the project's own; their names."""
    folder = info / "licenses"
    for path in sorted(licences.iterdir()):
        shutil.copy(path, folder / path.name)
    notice = folder / "SOURCES.txt"
    notice.write_text(NOTICE + notice.read_text())
    return [path.name for path in sorted(licences.iterdir())]


def add_programs(data, launcher, builds):
    for folder in ("scripts", "data/libexec"):
        (data / folder).mkdir(parents=True)
    shutil.copy(launcher, data / "scripts" / "kapitza")
    for arch, path in builds.items():
        place = data / "data" / "libexec" / f"kapitza-{arch}"
        subprocess.run(["strip", "-o", place, path], check=True)
        place.chmod(0o755)


def main():
    pure, launcher, share, licences, out, *words = sys.argv[1:]
    with tempfile.TemporaryDirectory() as folder:
        zipfile.ZipFile(pure).extractall(folder)
        info = next(Path(folder).glob("*.dist-info"))
        data = info.with_suffix(".data")
        add_programs(data, launcher, dict(word.split("=", 1) for word in words))
        shutil.copytree(share, data / "data" / "share", ignore=shutil.ignore_patterns("figures"))
        names = add_licences(info, Path(licences))
        metadata = info / "METADATA"
        metadata.write_text(rewrite_metadata(metadata.read_text(), names))
        (info / "WHEEL").write_text(f"Wheel-Version: 1.0\nGenerator: scripts/wheel\nRoot-Is-Purelib: false\nTag: {TAG}\n")
        subprocess.run([sys.executable, "-m", "wheel", "pack", folder, "-d", out], check=True)


if __name__ == "__main__":
    main()
