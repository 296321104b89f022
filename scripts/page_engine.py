"""Compiles the library to WebAssembly: build-page/engine.wasm, and engine-plain.wasm for processors that do not fuse.

Fortran: LLVM IR by flang for x86-64, whose sizes, alignments and calls are those of wasm64; then the target is changed
in its text. C: clang. Both become wasm64, whose memory Binaryen lowers to 32 bits, which every browser has. Sources of
the C library, of Fortran's runtime and of libyaml are Debian's.
"""

import concurrent.futures
import hashlib
import json
import os
import re
import shlex
import subprocess
import tarfile
from pathlib import Path

ROOT = Path(__file__).resolve().parents[1]
BUILD = ROOT / "build-page"
OWN = ROOT / "web" / "page"
POWERS = "atlas;deep;ends;library;live;release;saddles;tools"
LAYOUT = "e-m:e-p:64:64-p10:8:8-p20:8:8-i64:64-n32:64-S128-ni:1:10:20"  # of wasm64, as clang 19 says it
WASM = ["--target=wasm64-unknown-wasi", "-O2", "-msimd128", "-mbulk-memory", "-mnontrapping-fptoint",
        "-ffunction-sections", "-fdata-sections", "-Wno-everything"]
SYSTEM = ["-D_GNU_SOURCE", "-D_WASI_EMULATED_SIGNAL", "-D_WASI_EMULATED_PROCESS_CLOCKS", "-D_WASI_EMULATED_MMAN"]
SOURCES = {"wasi-libc": "0.0~git20220510.9886d3d-2", "llvm-toolchain-19": "1:19.1.7-3~deb12u1", "libyaml": "0.2.5-1"}
TAKEN = re.compile(r"[^/]+/(flang/(runtime|include|lib/Decimal)|libc-|dlmalloc|src|include)")  # of their archives
MUSL = "internal stdio string stdlib math ctype multibyte locale fenv complex search env exit prng errno".split()
MUSL_TIME = "strftime gmtime_r __secs_to_tm __tm_to_secs __year_to_secs __month_to_secs time".split()
RUNTIME = """allocatable array-constructor assign character complex-powi copy derived derived-api descriptor dot-product
    matmul memory misc-intrinsic numeric pointer product reduction stat sum support temporary-stack
    terminator tools transformational type-code type-info ISO_Fortran_binding inquiry ragged internal-unit io-error
    iostat utf""".split()
HEADERS = ["hdf5/serial", "gsl", "fftw3.h", "zlib.h", "zconf.h", "yaml.h", "json-c", "gmp.h", "flint", "mpfr.h",
           *(f"{name}.h" for name in ("arb", "arf", "mag", "fmpr", "fmpz_extras", "acb"))]  # prototypes alone
LOWERED = """simd relaxed-simd bulk-memory bulk-memory-opt nontrapping-float-to-int memory64 sign-ext mutable-globals
    multivalue reference-types call-indirect-overlong""".split()
# Fortran that is right everywhere, but for which flang calls its runtime number by number.
PORTABLE = {
    "s = transfer(ieor(transfer(s, 0_ik), ishft(transfer(shifted, 0_ik), SIGN_SHIFT)), s)":
        "shifted = shifted - ROUND_TO_INTEGER\n"
        "    q = shifted - 2*((0.5_rk*shifted + ROUND_TO_INTEGER) - ROUND_TO_INTEGER) ! 0, or 1 or -1 if it is odd\n"
        "    s = s - 2*(q*q)*s",
    "merge(transfer(shifted, 0_ik) - NO_TURNS, 0_ik, abs(turn) < MOST_TURNS)":
        "int(merge(turn, 0.0_rk, abs(turn) < MOST_TURNS), ik)"}
YAML = '#define YAML_VERSION_MAJOR 0\n#define YAML_VERSION_MINOR 2\n#define YAML_VERSION_PATCH 5\n' \
       '#define YAML_VERSION_STRING "0.2.5"\n'


def run(*words):
    """Runs a command at low priority; what it prints."""
    done = subprocess.run(["nice", *map(str, words)], capture_output=True, text=True)
    if done.returncode:
        raise SystemExit(f"page: {shlex.join(map(str, words))[-400:]}\n{done.stderr[:3000]}")
    return done.stdout


def fetch():
    """Folders of the sources, by name."""
    folder = BUILD / "sources"
    (folder / "lists" / "partial").mkdir(parents=True, exist_ok=True)
    (folder / "sources.list").write_text("deb-src http://deb.debian.org/debian bookworm main\n")
    settings = ["-o", f"Dir::Etc::SourceList={folder}/sources.list", "-o", "Dir::Etc::SourceParts=/dev/null",
                "-o", f"Dir::State::Lists={folder}/lists"]
    for name, version in SOURCES.items():
        archive = f"{name}_{version.split(':')[-1].rsplit('-', 1)[0]}.orig.tar"
        if (folder / name).is_dir():
            continue
        if not list(folder.glob(f"{archive}.*")):
            run("apt-get", *settings, "update")
            words = ["apt-get", *settings, "source", "--download-only", f"{name}={version}"]
            subprocess.run(words, cwd=folder, check=True)
        with tarfile.open(next(folder.glob(f"{archive}.*"))) as opened:
            for member in opened:
                if TAKEN.match(member.name):
                    opened.extract(member, folder / name, filter="data")
    return {name: next(path for path in (folder / name).iterdir()) for name in SOURCES}


def headers():
    """Headers of the C library, and of libraries whose functions a tab lacks."""
    system, others = BUILD / "system", BUILD / "others"
    if not system.is_dir():
        run("cp", "-r", "/usr/include/wasm32-wasi", system)
        api = system / "wasi" / "api.h"
        text = re.sub(r"^#error.*wasm32.*$|^_Static_assert\(.*$", "", api.read_text(), flags=re.MULTILINE)
        api.write_text(text)
    others.mkdir(exist_ok=True)
    for name in HEADERS:
        places = [path / name for path in (Path("/usr/include"), Path("/usr/include/x86_64-linux-gnu"))]
        place = next((path for path in places if path.exists()), None)
        if place and not (others / name.split("/")[0]).exists():
            (others / name.split("/")[0]).symlink_to(place.parent if "/" in name else place)
    return ["-nostdlibinc", "-isystem", OWN / "include", "-isystem", system, "-isystem", others,
            "-isystem", others / "hdf5" / "serial"]


def in_order(files):
    """Fortran files after those whose modules they use."""
    text = {file: file.read_text() for file in files}
    module = re.compile(r"^\s*(?:sub)?module\s+(?!procedure|subroutine|function)(\w+)\s*$", re.M | re.I)
    used = re.compile(r"^\s*(?:use(?:\s*::|\s*,\s*intrinsic\s*::)?\s+|submodule\s*\()(\w+)", re.M | re.I)
    home = {name.lower(): file for file in files for name in module.findall(text[file])}
    order = []

    def visit(file):
        for name in used.findall(text[file]):
            other = home.get(name.lower(), file)
            if other != file and other not in order:
                visit(other)
        if file not in order:
            order.append(file)

    for file in sorted(files):
        visit(file)
    return order


def quad(match):
    """A constant of 80 bits as one of 128."""
    number = int(match.group(1), 16)
    bits = (number >> 64) << 112 | (number & ((1 << 63) - 1)) << 49
    return f"0xL{bits & ((1 << 64) - 1):016X}{bits >> 64:016X}"


def retargeted(text):
    """LLVM IR for x86-64 as IR for wasm64."""
    text = re.sub(r'target datalayout = ".*"', f'target datalayout = "{LAYOUT}"', text)
    text = re.sub(r'target triple = ".*"', 'target triple = "wasm64-unknown-wasi"', text)
    text = re.sub(r'"(?:target-cpu|target-features|tune-cpu)"="[^"]*"', '"page"="1"', text)
    text = re.sub(r"0xK([0-9A-F]{20})", quad, text)
    text = re.sub(r"(?:fptrunc x86_fp80 (%\w+) to fp128|fpext x86_fp80 (%\w+) to fp128|"
                  r"fptrunc fp128 (%\w+) to x86_fp80)",
                  lambda found: f"freeze fp128 {next(filter(None, found.groups()))}", text)
    text = text.replace("x86_fp80", "fp128").replace(".f80", ".f128")
    return text.replace("@llvm.lround.i32.f64", "@page_lround").replace("@cabs(", "@page_cabs(")


def portable():
    """A folder with those Fortran files that PORTABLE changes."""
    for path in [*(ROOT / "src").rglob("*.f90"), *(ROOT / "src").rglob("*.inc")]:
        text = path.read_text()
        for old, new in PORTABLE.items():
            text = text.replace(old, new)
        if text != path.read_text():
            place = BUILD / "fortran" / path.relative_to(ROOT / "src")
            place.parent.mkdir(parents=True, exist_ok=True)
            place.write_text(text)
    return BUILD / "fortran"


class Objects:
    """Compiles what has changed; `made` is called with everything when all is there."""

    def __init__(self):
        self.pool = concurrent.futures.ThreadPoolExecutor(os.cpu_count())
        self.waiting = []

    def add(self, name, source, *words, salt="", needed=True):
        """The object of a source, compiled if it, its command or `salt` is new; one that is not `needed` may fail."""
        place = BUILD / "objects" / f"{name}.o"
        place.parent.mkdir(parents=True, exist_ok=True)
        command = ["clang-19", *WASM, *map(str, words), "-c", source, "-o", place]
        key = hashlib.sha256((shlex.join(map(str, command)) + salt).encode() + Path(source).read_bytes()).hexdigest()
        kept = place.with_suffix(".key")
        if not (kept.is_file() and kept.read_text() == key):
            def work():
                try:
                    run(*command)
                except SystemExit:
                    if needed:
                        raise
                kept.write_text(key)
            self.waiting.append(self.pool.submit(work))
        return place

    def end(self):
        concurrent.futures.wait(self.waiting)
        wrong = [str(one.exception()) for one in self.waiting if one.exception()]
        if wrong:
            raise SystemExit("\n".join(wrong))
        self.waiting = []


def digest(*patterns):
    """Of all files that sources include, or whose modules they use."""
    files = sorted(path for folder, pattern in patterns for path in (ROOT / folder).rglob(pattern))
    return hashlib.sha256(b"".join(path.read_bytes() for path in files)).hexdigest()


def commands():
    """Source of the library: what its compiler is called with, as cmake has it."""
    folder = BUILD / "native"
    if not (folder / "build.ninja").is_file():
        run("cmake", "-S", ROOT, "-B", folder, "-G", "Ninja", f"-DKAPITZA_POWERS={POWERS}", "-DBUILD_TESTING=OFF")
    run("ninja", "-C", folder, "kapitza_version")
    rows = json.loads(run("ninja", "-C", folder, "-t", "compdb"))
    found = {}
    for row in rows:
        path = Path(row["file"])
        other = "kapitza_parallel.dir" in row["output"] or path.name == "main.c"
        if path.is_absolute() and path.suffix in (".c", ".f90") and not other:
            found[path] = shlex.split(row["command"])
    return found


def compile_library(objects, system):
    """Objects of the library, and those of the plain build, which are others."""
    listed, own = commands(), BUILD / "ir"
    for name in ("modules", "ir"):
        (BUILD / name).mkdir(parents=True, exist_ok=True)
    made, plain = [], []
    changed_files = portable()
    changed = digest(("src", "*.f90"), ("src", "*.inc"), ("scripts", "page_engine.py"))
    fresh = own / "key"
    stale = not fresh.is_file() or fresh.read_text() != changed
    for file in in_order({path for path in listed if path.suffix == ".f90"}):
        name = str(file.relative_to(ROOT / "src"))[:-4].replace("/", "_")
        text = own / f"{name}.ll"
        if stale:
            folders = [f"-I{changed_files}/kernel", *(word for word in listed[file] if word.startswith("-I"))]
            source = changed_files / file.relative_to(ROOT / "src")
            source = source if source.is_file() else file
            run("flang-new-19", "--target=x86_64-linux-gnu", "-O1", "-ffp-contract=fast", "-cpp", "-S", "-emit-llvm",
                "-module-dir", BUILD / "modules", f"-I{BUILD}/modules", *folders, source, "-o", text)
            text.write_text(retargeted(text.read_text()))
        made.append(objects.add(f"fortran/{name}", text, "-Wno-override-module", "-x", "ir"))
    fresh.write_text(changed)
    salt = digest(("src", "*.h"), ("src", "*.inc"), ("include", "*.h"), ("web/page/include", "*.h"))
    quads = ["-D__float128=long double", "-D__SIZEOF_FLOAT128__=16"]
    for file, words in listed.items():
        if file.suffix != ".c" or "enclosure" in file.parts or file.name in ("signals.c", "file_lock.c"):
            continue
        kept = [word for word in words if re.match(r"-[IDU](?!.*modules)|-O|-std|-ffp-contract", word)]
        name = str(file.relative_to(ROOT / "src"))[:-2].replace("/", "_")
        flags = [*system, *SYSTEM, *quads, *kept]
        fuses = "-DKAPITZA_FUSED=1" in kept or "pairs_arithmetic.h" in file.read_text()
        made.append(objects.add(f"c/{name}", file, *flags, *["-mrelaxed-simd"] * fuses, salt=salt))
        plain.append(objects.add(f"plain/{name}", file, *flags, salt=salt) if fuses else made[-1])
    flags = [*system, *SYSTEM, f"-I{ROOT}/include", "-std=gnu11"]
    made.append(objects.add("c/system", OWN / "system.c", *flags, "-mrelaxed-simd", salt=salt))
    plain.append(objects.add("plain/system", OWN / "system.c", *flags, salt=salt))
    return made, [path for path in made if path.parent.name == "fortran"] + plain


def compile_system(objects, folders, system):
    """Objects of the C library, of Fortran's runtime and of libyaml."""
    wasi, flang, yaml = folders["wasi-libc"], folders["llvm-toolchain-19"] / "flang", folders["libyaml"]
    top = wasi / "libc-top-half"
    musl = top / "musl"
    words = ["-std=gnu17", "-fno-trapping-math", "-DBULK_MEMORY_THRESHOLD=32", "-D_GNU_SOURCE", "-nostdlibinc",
             *(f"-I{path}" for path in (musl / "arch/wasm32", musl / "arch/generic", musl / "src/include",
                                        musl / "src/internal", top / "headers/private",
                                        wasi / "libc-bottom-half/cloudlibc/src",
                                        wasi / "libc-bottom-half/cloudlibc/src/include",
                                        wasi / "libc-bottom-half/headers/private")), "-isystem", BUILD / "system"]
    files = [path for folder in MUSL for path in (musl / "src" / folder).glob("*.c")]
    files += [*(top / "sources").rglob("*.c"), *(musl / "src/time" / f"{name}.c" for name in MUSL_TIME),
              wasi / "libc-bottom-half/sources/errno.c"]
    left_out = {"__stdio_write", "__stdout_write", "getenv", "abort", "_Exit"}
    narrow = {path: [] if path.stem in ("fma", "qsort", "errno") else ["-D__wasm32__=1"] for path in files}
    made = [objects.add(f"musl/{path.parent.name}_{path.stem}", path, *words, "-Da_cas_p=a_cas_p", *narrow[path],
                        needed=False) for path in files if path.stem not in left_out]
    made.append(objects.add("musl/dlmalloc", wasi / "dlmalloc/src/dlmalloc.c", *words, f"-I{wasi}/dlmalloc/include"))
    (BUILD / "generated").mkdir(exist_ok=True)
    (BUILD / "generated" / "config.h").write_text(YAML)
    places = ("/usr/lib/llvm-19/include", "/usr/include")
    cxx = next(path for place in places if (path := Path(place) / "wasm32-wasi" / "c++" / "v1").is_dir())
    words = ["-std=c++17", "-fno-exceptions", "-fno-rtti", "-nostdinc++", "-nostdlibinc", "-isystem", cxx,
             "-isystem", BUILD / "system", "-DFLANG_LITTLE_ENDIAN=1", *SYSTEM, f"-I{BUILD}/generated",
             f"-I{flang}/runtime", f"-I{flang}/include", "-I/usr/lib/llvm-19/include"]
    made += [objects.add(f"runtime/{name}", flang / "runtime" / f"{name}.cpp", *words) for name in RUNTIME]
    made.append(objects.add("runtime/reductions", OWN / "reductions.cpp", *words))
    words = ["-std=gnu17", *system, "-D_GNU_SOURCE", "-DHAVE_CONFIG_H", f"-I{BUILD}/generated", f"-I{yaml}/include"]
    return made + [objects.add(f"yaml/{path.stem}", path, *words) for path in (yaml / "src").glob("*.c")]


def exported():
    """Functions of the library's header."""
    text = (ROOT / "include" / "kapitza.h").read_text()
    return re.findall(r"^[\w *]*?(kapitza_\w+)\((?!\*)", text, re.M)


def link(name, objects):
    """Links, and lowers the memory to 32 bits."""
    wide, done = BUILD / f"{name}64.wasm", BUILD / f"{name}.wasm"
    runtime = Path("/usr/lib/llvm-19/lib/clang/19/lib/wasi/libclang_rt.builtins-wasm64.a")
    names = [f"--export-if-defined={one}" for one in exported()]
    run("wasm-ld-19", "-mwasm64", "--no-entry", "--gc-sections", "--allow-undefined", "-z", "stack-size=4194304",
        "--stack-first", "--export-memory", "--wrap=malloc", "--wrap=calloc", "--wrap=realloc", "--wrap=free", *names,
        *(path for path in objects if path.is_file()), runtime, "-o", wide)
    opt = BUILD / "node_modules" / "binaryen" / "bin" / "wasm-opt"
    run("node", opt, *(f"--enable-{word}" for word in LOWERED), "--memory64-lowering", "--table64-lowering",
        "--strip-debug", "--strip-producers", wide, "-o", done)
    return done


def build():
    """Both engines."""
    folders, system, objects = fetch(), headers(), Objects()
    shared = compile_system(objects, folders, system)
    relaxed, plain = compile_library(objects, system)
    objects.end()
    return [link("engine", relaxed + shared), link("engine-plain", plain + shared)]


if __name__ == "__main__":
    build()
