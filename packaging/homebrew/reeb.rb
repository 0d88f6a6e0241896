class Reeb < Formula
  desc "Exact Reeb graphs of meshes of any size"
  license "BSD-3-Clause"
  version "0.1.0"
  url "file://#{Pathname(__dir__).join("../..").realpath}", using: :git

  depends_on "cli11" => :build
  depends_on "cmake" => :build
  depends_on "eigen" => :build
  depends_on "fast_float" => :build
  depends_on "nlohmann-json" => :build
  depends_on "pkgconf" => :build
  depends_on "spectra" => :build
  depends_on "boost"
  depends_on "fmt"
  depends_on "libpng"
  depends_on "lz4"
  depends_on "tbb"
  depends_on "xxhash"
  depends_on "zstd"
  uses_from_macos "expat"
  uses_from_macos "zlib"

  def install
    system "cmake", "-S", ".", "-B", "build", "-DREEB_WEB=OFF", "-DREEB_TESTS=OFF", "-DREEB_BENCH=OFF", *std_cmake_args
    system "cmake", "--build", "build"
    system "cmake", "--install", "build"
  end

  test do
    system bin/"reeb", "generate", "torus", "--triangles", "1k", "-o", "t.ply"
    assert_match "1 loop", shell_output("#{bin}/reeb t.ply 2>&1")
  end
end
