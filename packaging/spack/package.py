"""Recipe of kapitza for Spack 1.0 or newer. Copied as packages/kapitza/package.py into a Spack repository, it builds
this folder's sources:

spack dev-build --source-path FOLDER kapitza@0.5.0
"""

from spack.package import conflicts, depends_on, license, version
from spack_repo.builtin.build_systems.cmake import CMakePackage, generator


class Kapitza(CMakePackage):
    """Basins of attraction of the pendulum with a shaken pivot, on any number of MPI ranks."""

    license("MIT")
    version("0.5.0")

    depends_on("c", type="build")
    depends_on("fortran", type="build")
    depends_on("cmake@3.24:", type="build")
    depends_on("ninja", type="build")
    depends_on("pkgconfig", type="build")
    depends_on("mpi")
    depends_on("hdf5+hl")
    depends_on("gsl")
    depends_on("fftw@3 precision=double")
    depends_on("flint@3:")
    depends_on("json-c")
    depends_on("libyaml")
    depends_on("zlib-api")

    generator("ninja")
    # Labels depend on how products are rounded: the build refuses other compilers.
    conflicts("%oneapi")
    conflicts("%nvhpc")

    def cmake_args(self):
        # The target's generic instruction set, by gcc's name: x86_64_v3 is x86-64-v3.
        target = self.spec.target.generic.name.replace("_", "-")
        return [self.define("BUILD_TESTING", False),
                self.define("KAPITZA_ARCH", target if target.startswith("x86-64") else "armv8-a")]
