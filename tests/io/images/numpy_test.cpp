// NumPy arrays, written by hand; same_volume_test has some of NumPy's own.
#include "tests/io/images/image_files.h"

namespace reeb::io::testing {
namespace {

using Values = std::vector<double>;

std::string npy(const std::string& dictionary, const std::string& data, char version = 1) {
  std::string bytes = "\x93NUMPY" + std::string(1, version) + std::string(1, '\0');
  bytes += version == 1 ? scalar_bytes(static_cast<std::uint16_t>(dictionary.size()))
                        : scalar_bytes(static_cast<std::uint32_t>(dictionary.size()));
  return bytes + dictionary + data;
}

std::string dictionary(const std::string& type, const std::string& shape, bool fortran = false) {
  return "{'descr': '" + type + "', 'fortran_order': " + (fortran ? "True" : "False") + ", 'shape': " + shape +
         ", }  \n";
}

template <class T>
void expect_type(const std::string& name) {
  const std::vector<T> stored = {
      0, 1, static_cast<T>(-2), std::numeric_limits<T>::max(), std::numeric_limits<T>::lowest(), 5};
  for (const bool big : {false, true}) {
    for (const char version : {'\1', '\2', '\3'}) {
      const std::string type = (sizeof(T) == 1 ? "|" : big ? ">" : "<") + name;
      SCOPED_TRACE(type);
      const Grid grid = read_grid(write_file("a.npy", npy(dictionary(type, "(2, 3)"), binary(stored, big), version)));
      EXPECT_EQ(grid.values, Values(stored.begin(), stored.end()));
    }
  }
}

TEST(NumPy, EveryTypeInBothByteOrders) {
  expect_type<std::int8_t>("i1");
  expect_type<std::uint8_t>("u1");
  expect_type<std::int16_t>("i2");
  expect_type<std::uint16_t>("u2");
  expect_type<std::int32_t>("i4");
  expect_type<std::uint32_t>("u4");
  expect_type<std::int64_t>("i8");
  expect_type<std::uint64_t>("u8");
  expect_type<float>("f4");
  expect_type<double>("f8");
}

TEST(NumPy, TheAxisThatVariesFastestIsTheFirst) {
  const auto info = [](const std::string& shape, bool fortran) {
    return read_grid(write_file("a.npy", npy(dictionary("|u1", shape, fortran), std::string(24, '\1')))).info;
  };
  EXPECT_EQ(info("(2, 3, 4)", false).size, (std::array<std::uint64_t, 3>{4, 3, 2}));
  EXPECT_EQ(info("(2, 3, 4)", true).size, (std::array<std::uint64_t, 3>{2, 3, 4}));
  EXPECT_EQ(info("(4,6)", false).size, (std::array<std::uint64_t, 3>{6, 4, 1}));
  EXPECT_EQ(info("(4L, 6L)", false).axes, 2u);
  EXPECT_EQ(info("(24, 1, 1)", false).axes, 3u);
}

TEST(NumPy, BadFilesAreRefused) {
  const auto error = [](const std::string& bytes) { return error_of(write_file("bad.npy", bytes)); };
  const auto described = [&](const std::string& text) { return error(npy(text, std::string(24, '1'))); };
  EXPECT_EQ(described(dictionary("<f8", "(2, 2)")),
            "bad.npy:72: the header announces 4 values (32 bytes), but the file holds 24 bytes of data");
  EXPECT_EQ(described(dictionary("<f8", "(100000, 100000, 100)")).substr(0, 55),
            "bad.npy:87: the header announces 1,000,000,000,000 valu");
  EXPECT_EQ(described(dictionary("<f2", "(2, 2)")), "bad.npy:21: values of type \"<f2\" are not read");
  EXPECT_EQ(described(dictionary("<c8", "(2, 2)")), "bad.npy:21: values of type \"<c8\" are not read");
  EXPECT_EQ(described(dictionary("O", "(2, 2)")), "bad.npy:20: an array of records is not read");
  EXPECT_EQ(described("{'descr': [('x', '<f4')], 'fortran_order': False, 'shape': (2, 2), }"),
            "bad.npy:20: an array of records is not read");
  EXPECT_EQ(described(dictionary("|u1", "(24,)")), "bad.npy: the image has 1 axis");
  EXPECT_EQ(described(dictionary("|u1", "()")), "bad.npy: the image has 0 axes");
  EXPECT_EQ(described(dictionary("|u1", "(1, 2, 3, 4)")), "bad.npy: the image has 4 axes");
  EXPECT_EQ(described(dictionary("|u1", "(2, -2)")), "bad.npy:64: the shape has \"-2\", which is not a size");
  EXPECT_EQ(described(dictionary("|u1", "(99999999999999999999, 2)")).substr(0, 32),
            "bad.npy:61: the shape has \"99999");
  EXPECT_EQ(described("{'descr': '|u1', 'shape': (2, 2)}"), "bad.npy:10: the header has no fortran_order");
  EXPECT_EQ(described("{}"), "bad.npy:10: the header has no descr");
  EXPECT_EQ(error(npy(dictionary("|u1", "(2, 2)"), "1234", 9)), "bad.npy:6: version 9 of the format is not read");
  EXPECT_EQ(error(npy(dictionary("|u1", "(2, 2)"), "1234").substr(0, 30)),
            "bad.npy:8: the file ends inside its header");
  EXPECT_EQ(error("\x93NUMPY\1"), "bad.npy:7: the file ends inside its header");
}

}  // namespace
}  // namespace reeb::io::testing
