from spack.package import *


class Reeb(CMakePackage):
    """Exact Reeb graphs of meshes of any size."""

    license("BSD-3-Clause")

    version("0.1.0")

    depends_on("cxx", type="build")
    depends_on("cmake@3.25:", type="build")
    depends_on("pkgconfig", type="build")
    depends_on("boost+iostreams")
    depends_on("cli11", type="build")
    depends_on("eigen", type="build")
    depends_on("expat")
    depends_on("fast-float", type="build")
    depends_on("fmt")
    depends_on("intel-oneapi-tbb")
    depends_on("libpng")
    depends_on("lz4")
    depends_on("nlohmann-json", type="build")
    depends_on("spectra", type="build")
    depends_on("xxhash")
    depends_on("zlib-api")
    depends_on("zstd")

    def cmake_args(self):
        return [self.define(f"REEB_{part}", False) for part in ("WEB", "TESTS", "BENCH")]
