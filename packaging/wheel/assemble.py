"""Makes the binary wheel: the Python package's own wheel, the launcher as bin/kapitza, one build of the program for
each instruction set in libexec, and the licences of the libraries inside.

    assemble.py PURE.whl LAUNCHER SHARE LICENCES OUT ARCH=PROGRAM...
"""

import json
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


# Licences of what stands in sources.txt, by the beginning of its name.
LICENCES = {"libgsl": "GPL-3.0-or-later", "libfftw3": "GPL-2.0-or-later",
            "libgmp": "LGPL-3.0-or-later OR GPL-2.0-or-later",
            "libmpfr": "LGPL-3.0-or-later", "libjson-c": "MIT", "libyaml": "MIT", "zlib1g": "Zlib",
            "flint": "LGPL-3.0-or-later",
            "hdf5": "BSD-3-Clause", "libc6": "LGPL-2.1-or-later",
            "libgfortran": "GPL-3.0-or-later WITH GCC-exception-3.1",
            "libgcc-s1": "GPL-3.0-or-later WITH GCC-exception-3.1",
            "libgcc-12-dev": "GPL-3.0-or-later WITH GCC-exception-3.1 AND LGPL-2.1-or-later",  # with libquadmath
            "libcrypt": "LGPL-2.1-or-later", "linux-libc": "GPL-2.0-only WITH Linux-syscall-note"}


def component(kind, package, digest):
    """A row of sources.txt as a component of CycloneDX; what is only linked against (kind `binary`) is excluded from
    the wheel."""
    name, version = package.split("=", 1)
    address = f"pkg:deb/debian/{name}@{version.replace(':', '%3A').replace('+', '%2B')}"
    licence = next(words for start, words in LICENCES.items() if name.startswith(start))
    return {"type": "library", "name": name, "version": version, "scope": "excluded" if kind == "binary"
            else "required", "purl": f"{address}?arch={'source' if kind == 'source' else 'amd64'}",
            "hashes": [{"alg": "SHA-256", "content": digest}], "licenses": [{"expression": licence}]}


def bill_of_materials(sources, version):
    """CycloneDX 1.6: what the wheel contains beside kapitza, from the text of sources.txt."""
    rows = [line.split()[:3] for line in sources.splitlines() if line and not line.startswith("#")]
    own = {"type": "application", "name": "kapitza", "version": version, "licenses": [{"expression": "MIT"}]}
    bill = {"bomFormat": "CycloneDX", "specVersion": "1.6", "version": 1, "metadata": {"component": own},
            "components": [component(*row) for row in rows]}
    return json.dumps(bill, indent=1) + "\n"


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
        (info / "sboms").mkdir()
        version = re.match(r"kapitza-([^-]+)\.dist-info", info.name)[1]
        sources = Path(__file__).with_name("sources.txt").read_text()
        (info / "sboms" / "kapitza.cdx.json").write_text(bill_of_materials(sources, version))
        metadata = info / "METADATA"
        metadata.write_text(rewrite_metadata(metadata.read_text(), names))
        (info / "WHEEL").write_text(
            f"Wheel-Version: 1.0\nGenerator: scripts/wheel\nRoot-Is-Purelib: false\nTag: {TAG}\n")
        subprocess.run([sys.executable, "-m", "wheel", "pack", folder, "-d", out], check=True)


if __name__ == "__main__":
    main()
