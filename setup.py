"""Builds the extension module with CMake (pyproject.toml says the rest)."""

import os
import re
import shlex
import shutil
import subprocess
import sys
from pathlib import Path

from setuptools import Extension, setup
from setuptools.command.build_ext import build_ext


class CMakeBuild(build_ext):
    def build_extension(self, extension):
        source = Path(__file__).resolve().parent
        target = Path(self.get_ext_fullpath(extension.name)).resolve()
        build = Path(self.build_temp).resolve()
        build.mkdir(parents=True, exist_ok=True)
        options = [
            *(["-GNinja"] if shutil.which("ninja") else []),
            "-DCMAKE_BUILD_TYPE=Release",
            "-DREEB_PYTHON=ON",
            "-DREEB_JOIN_SOURCES=ON",
            f"-DPython3_EXECUTABLE={sys.executable}",
            *(f"-DREEB_{part}=OFF" for part in ("WEB", "TESTS", "BENCH", "INSTALL")),
            *shlex.split(os.environ.get("CMAKE_ARGS", "")),
        ]
        subprocess.run(["cmake", "-S", source, "-B", build, *options], check=True)
        jobs = os.environ.get("CMAKE_BUILD_PARALLEL_LEVEL", str(os.cpu_count() or 1))
        subprocess.run(["cmake", "--build", build, "--target", "reeb_python", "-j", jobs], check=True)
        built = next((build / "python" / "reeb").glob("_reeb*.so"))
        target.parent.mkdir(parents=True, exist_ok=True)
        self.copy_file(str(built), str(target))


version = re.search(r"project\(reeb VERSION ([\d.]+)", (Path(__file__).parent / "CMakeLists.txt").read_text())
setup(
    version=version[1],
    ext_modules=[Extension("reeb._reeb", sources=[])],
    cmdclass={"build_ext": CMakeBuild},
)
