// Texts of functions, and the values that they stand for.
#include "io/functions/function_source.h"

#include <cmath>
#include <limits>

#include "io/file/file_windows.h"
#include "tests/io/formats/mesh_files.h"

namespace reeb::io::testing {
namespace {

constexpr double kInfinity = std::numeric_limits<double>::infinity();

MeshBatch two_vertices(std::uint64_t first = 0) {
  MeshBatch batch;
  batch.first_vertex = VertexId(first);
  batch.vertex_count = 2;
  batch.coordinates = {{1, 2}, {3, 4}, {-0.0, 6}};
  batch.properties = {{7, kInfinity}};
  return batch;
}

FunctionSource source(const std::string& text) {
  return FunctionSource(parse_function(text), MeshInfo{}, std::vector<std::string>{"q"}, "mesh");
}

std::vector<double> values_of(FunctionSource function, std::uint64_t first = 0) {
  std::vector<double> values(2);
  function.evaluate(two_vertices(first), values);
  return values;
}

template <class Action>
Error error_of(Action action) {
  try {
    action();
  } catch (const Error& error) {
    return error;
  }
  ADD_FAILURE() << "no error";
  return Error(ErrorKind::kUsage, "", "");
}

TEST(FunctionText, IsParsedOrRefused) {
  for (const char* good : {"x", "y", "z", "c0", "c12", "index", "random:18446744073709551615", "property:a b", "value",
                           "value:3", "file:/a:b", "distance:0", "distance:18446744073709551615", "distance:1,-2e3,.5"})
    EXPECT_EQ(parse_function(good).text, good);
  for (const char* bad : {"",
                          "w",
                          "c",
                          "c-1",
                          "cx",
                          "random",
                          "random:",
                          "random:-1",
                          "random:1x",
                          "property:",
                          "file:",
                          "file",
                          "z ",
                          "value:",
                          "value:x",
                          "distance",
                          "distance:",
                          "distance:1,2",
                          "distance:1,2,3,4",
                          "distance:-1",
                          "distance:1,2,inf"}) {
    const Error error = error_of([&] { parse_function(bad); });
    EXPECT_EQ(error.kind(), ErrorKind::kUsage) << bad;
    EXPECT_FALSE(error.hint().empty());
  }
  EXPECT_EQ(file_name_part(parse_function("file:a/b.f64")), "file-a-b.f64");
  EXPECT_EQ(file_name_part(parse_function("distance:0,1,2")), "distance-0,1,2");
  const std::vector<FunctionSpec> specs = {parse_function("property:b"), parse_function("z"),
                                           parse_function("property:a"), parse_function("property:b")};
  EXPECT_EQ(needed_properties(specs), (std::vector<std::string>{"b", "a"}));
}

std::string npy(const std::string& type, const std::string& shape, const std::string& data) {
  std::string header = "{'descr': '" + type + "', 'fortran_order': False, 'shape': " + shape + ", }";
  return "\x93NUMPY" + std::string("\1\0", 2) + scalar_bytes(static_cast<std::uint16_t>(header.size())) + header + data;
}

TEST(FunctionValues, OfEveryKind) {
  EXPECT_EQ(values_of(source("x")), (std::vector<double>{1, 2}));
  EXPECT_FALSE(std::signbit(values_of(source("z"))[0]));
  EXPECT_EQ(values_of(source("c1")), (std::vector<double>{3, 4}));
  EXPECT_EQ(values_of(source("index"), 40), (std::vector<double>{40, 41}));
  EXPECT_EQ(values_of(source("file:" + write_file("v.txt", "1e3 # a\n\n-0\r\n"))), (std::vector<double>{1000, 0}));
  const std::string raw = write_file("v.f64", scalar_bytes(2.5) + scalar_bytes(-1.0));
  EXPECT_EQ(values_of(source("file:" + raw)), (std::vector<double>{2.5, -1}));
  for (const std::string& zero : {write_file("zero.f64", scalar_bytes(-0.0) + scalar_bytes(1.0)),
                                  write_file("zero.npy", npy("<f8", "(2,)", scalar_bytes(-0.0) + scalar_bytes(1.0))),
                                  write_file("zero.txt", "-0\n1\n")})
    EXPECT_FALSE(std::signbit(values_of(source("file:" + zero))[0])) << zero;
  // The output of splitmix64 for the seed 0 is well known, and mix(0) is its first number.
  EXPECT_EQ(random_value(0, 0 - 0xe220a8397b1dcdafu), static_cast<double>(0xe220a8397b1dcdafu >> 11) * 0x1p-53);
}

// Their squares underflow and overflow; 3, 4 and 5 are the sides of a right triangle.
TEST(FunctionValues, DistancesOfAnySize) {
  MeshBatch batch;
  batch.first_vertex = VertexId(0);
  batch.vertex_count = 6;
  batch.coordinates = {
      {3e-200, 3e-160, 3e160, 3e300, 0, 3}, {4e-200, -4e-160, 4e160, -4e300, 0, 4}, {0, 0, 0, 0, 0, 0}};
  const std::vector<double> expected = {5e-200, 5e-160, 5e160, 5e300, 0, 5};
  std::vector<double> values(6), same(6);
  source("distance:0,0,0").evaluate(batch, values);
  for (std::size_t i = 0; i < expected.size(); ++i) EXPECT_DOUBLE_EQ(values[i], expected[i]);
  const std::vector<VertexId> ids = {VertexId(0), VertexId(1), VertexId(2), VertexId(3), VertexId(4), VertexId(5)};
  const std::vector<std::span<const double>> columns(batch.coordinates.begin(), batch.coordinates.end());
  source("distance:0,0,0").evaluate(ids, columns, same);
  EXPECT_EQ(same, values);
  batch.coordinates[0][3] = batch.coordinates[1][3] = 1.7e308;  // further than a number can be
  EXPECT_NE(error_of([&] { source("distance:0,0,0").evaluate(batch, values); }).message().find("vertex 3"),
            std::string::npos);
}

TEST(FunctionValues, ByIndexAreTheSame) {
  const std::vector<VertexId> ids = {VertexId(1), VertexId(0), VertexId(1)};
  std::vector<double> values(3);
  for (const std::string& path :
       {write_file("v.txt", "10\n20\n"), write_file("w.f64", scalar_bytes(10.0) + scalar_bytes(20.0)),
        write_file("a.npy", npy("<f8", "(2,)", scalar_bytes(10.0) + scalar_bytes(20.0))),
        write_file("b.npy", npy(">i2", "(2, 1)", std::string("\0\12\0\24", 4))),
        write_file("c.npy", npy("|u1", "(1, 2)", "\12\24"))}) {
    auto function = source("file:" + path);
    EXPECT_TRUE(function.columns().empty());
    function.evaluate(ids, {}, values);
    EXPECT_EQ(values, (std::vector<double>{20, 10, 20}));
    function.check_count(2);
    EXPECT_THROW(function.check_count(1), Error);
    EXPECT_THROW(function.check_count(3), Error);
  }
  // In order, then again from the beginning.
  auto lines = source("file:" + write_file("v.txt", "10\n20\n"));
  for (int i = 0; i < 2; ++i) {
    lines.evaluate(std::vector<VertexId>{VertexId(0), VertexId(1)}, {}, std::span(values).first(2));
    EXPECT_EQ(values, (std::vector<double>{10, 20, 20}));
    lines.check_count(2);
  }
  EXPECT_EQ(lines.lookup_bytes(1000), 8000u);
  auto property = source("property:q");
  ASSERT_EQ(property.columns().size(), 1u);
  EXPECT_EQ(property.columns()[0], 3u);
  const std::vector<double> gathered = {5, 6, 5};
  const std::span<const double> columns[] = {gathered};
  property.evaluate(ids, columns, values);
  EXPECT_EQ(values, (std::vector<double>{5, 6, 5}));
}

TEST(FunctionErrors, SayWhere) {
  EXPECT_EQ(error_of([] { source("c3"); }).kind(), ErrorKind::kBadInput);
  EXPECT_NE(error_of([] { source("property:p"); }).message().find("\"p\""), std::string::npos);
  const Error odd = error_of([] { values_of(source("property:q"), 10); });
  EXPECT_EQ(odd.file(), "mesh");
  EXPECT_NE(odd.message().find("vertex 11"), std::string::npos);
  EXPECT_EQ(error_of([] { values_of(source("file:" + write_file("s", "1\n"))); }).position(), "2:1");
  // How many vertices the mesh has is not known yet.
  const char* const few = "has 1 value, but the mesh has more vertices";
  EXPECT_EQ(error_of([] { values_of(source("file:" + write_file("s", "1\n"))); }).message(), few);
  EXPECT_EQ(error_of([] { values_of(source("file:" + write_file("s.f64", std::string(8, '\0')))); }).message(), few);
  EXPECT_EQ(error_of([] { values_of(source("file:" + write_file("n", "1\n2 3\n"))); }).position(), "2:3");
  EXPECT_EQ(error_of([] { values_of(source("file:" + write_file("n", "1\nnan\n"))); }).position(), "2:1");
  const std::string nan = write_file("n.f64", scalar_bytes(1.0) + scalar_bytes(kInfinity));
  EXPECT_EQ(error_of([&] { values_of(source("file:" + nan)); }).position(), "8");
  EXPECT_EQ(error_of([] { source("file:" + write_file("c.f64", "123456789")); }).position(), "8");
  const auto npy_error = [](const std::string& bytes) {
    return error_of([path = write_file("e.npy", bytes)] { values_of(source("file:" + path)); });
  };
  EXPECT_EQ(npy_error("1\n2\n").position(), "0");
  EXPECT_NE(npy_error(npy("<f4", "(2, 2)", std::string(16, '\0'))).message().find("several axes"), std::string::npos);
  EXPECT_NE(npy_error(npy("<f4", "(2,)", "1234567")).message().find("announces 2"), std::string::npos);
  EXPECT_NE(npy_error(npy("<f4", "(1,)", "1234")).message().find("has 1 value, but"), std::string::npos);
  const std::string body = npy("<f4", "(2,)", scalar_bytes(1.0f) + scalar_bytes(static_cast<float>(kInfinity)));
  EXPECT_EQ(npy_error(body).position(), std::to_string(body.size() - 4));
}

TEST(FileWindows, SeeEveryByteWithOverlapInAnyOrder) {
  std::string bytes(300'001, '\0');
  for (std::size_t i = 0; i < bytes.size(); ++i) bytes[i] = static_cast<char>(i * 2654435761u >> 13);
  FileWindows windows(write_file("windows", bytes), {.window_bits = 12, .window_count = 3, .overlap_bytes = 64});
  for (std::size_t step : {1u, 4099u, 77'777u})
    for (std::size_t i = 0, offset = 0; i < 300'001; i += step, offset = (offset + step * 3) % bytes.size()) {
      const std::size_t length = std::min<std::size_t>(64, bytes.size() - offset);
      ASSERT_EQ(std::string_view(windows.at(offset), length), std::string_view(bytes).substr(offset, length));
      ASSERT_GE(windows.view(offset).size(), length);
    }
}

TEST(FileWindows, RefuseWhatIsNoFile) {
  EXPECT_EQ(error_of([] { FileWindows windows(scratch_folder().string()); }).kind(), ErrorKind::kBadInput);
  EXPECT_EQ(error_of([] { FileWindows windows(write_file("nothing", "")); }).position(), "0");
}

}  // namespace
}  // namespace reeb::io::testing
