#include "io/functions/value_file.h"

#include <algorithm>
#include <cmath>
#include <utility>
#include <vector>

#include "io/file/content_source.h"
#include "io/file/file.h"
#include "io/file/file_windows.h"
#include "io/images/numpy.h"
#include "io/mesh/scalar_bytes.h"
#include "io/text/hints.h"
#include "io/text/text_cursor.h"
#include "libreeb/base/count_text.h"
#include "libreeb/base/error.h"

namespace reeb::io {
namespace {

// `vertices`: nothing if only known to be more.
[[noreturn]] void throw_wrong_count(const std::string& path, const std::string& position, std::uint64_t values,
                                    bool or_more, std::optional<std::uint64_t> vertices) {
  throw Error(ErrorKind::kBadInput,
              "has " + count_of(values, "value") + (or_more ? " or more" : "") + ", but the mesh has " +
                  (vertices ? count_of(*vertices, "vertex") : "more vertices"),
              "the file must have one value per vertex")
      .at(path, position);
}

[[noreturn]] void throw_not_finite(const std::string& path, std::uint64_t vertex, const std::string& position) {
  throw Error(ErrorKind::kBadInput, "the value of vertex " + std::to_string(vertex) + " is not finite",
              "give every vertex a finite value")
      .at(path, position);
}

class RawValueFile final : public ValueFile {
 public:
  explicit RawValueFile(std::shared_ptr<const InputFile> file)
      : path_(file->path()), windows_(std::move(file), {.window_bits = 14, .window_count = 64, .overlap_bytes = 8}) {
    if (windows_.size() % 8 != 0)
      throw Error(ErrorKind::kBadInput, "its size is not a multiple of 8 bytes",
                  "a .f64 file has 8 bytes per vertex; the file may be cut")
          .at(path_, std::to_string(windows_.size() / 8 * 8));
  }
  double next() override { return at(next_++); }
  void skip_to(std::uint64_t vertex) override { next_ = vertex; }
  double at(std::uint64_t vertex) override {
    if (vertex >= windows_.size() / 8)
      throw_wrong_count(path_, std::to_string(windows_.size()), windows_.size() / 8, false, {});
    const double value = load_scalar<double>(windows_.at(8 * vertex), false);
    if (std::isfinite(value)) [[likely]]
      return value + 0.0;
    throw_not_finite(path_, vertex, std::to_string(8 * vertex));
  }
  void check_unchanged() const override { windows_.file()->check_unchanged("the file"); }
  void check_count(std::uint64_t vertex_count) override {
    if (windows_.size() / 8 != vertex_count)
      throw_wrong_count(path_, std::to_string(8 * std::min(vertex_count, windows_.size() / 8)), windows_.size() / 8,
                        false, vertex_count);
  }

 private:
  std::string path_;
  FileWindows windows_;
  std::uint64_t next_ = 0;
};

// An array of NumPy, of any type of number, with one axis; others of size 1 do not count.
class NumpyValueFile final : public ValueFile {
 public:
  explicit NumpyValueFile(const std::string& path)
      : path_(path), windows_(path, {.window_bits = 14, .window_count = 64, .overlap_bytes = 8}) {
    std::string head(static_cast<std::size_t>(std::min<std::uint64_t>(windows_.size(), ContentSource::kLookahead)), 0);
    windows_.file()->read_at(0, std::as_writable_bytes(std::span(head)));
    if (!is_numpy(head))
      throw Error(ErrorKind::kBadInput, "this is not a NumPy array", "write it with numpy.save").at(path, "0");
    header_ = parse_numpy_header(head, path);
    bytes_ = byte_size(header_.type);
    for (const std::uint64_t size : header_.shape) {
      if (count_ > 1 && size > 1)
        throw Error(ErrorKind::kBadInput, "an array of several axes is not a list of values",
                    "save one column of it, an array of shape (n,)")
            .at(path, "0");
      count_ *= size;
    }
    const std::uint64_t body = windows_.size() - header_.body_offset;
    if (body / bytes_ < count_)
      throw Error(
          ErrorKind::kBadInput,
          "has room for " + count_of(body / bytes_, "value") + ", but its header announces " + with_commas(count_),
          kCutOrDamagedHint)
          .at(path, std::to_string(windows_.size()));
  }
  double next() override { return at(next_++); }
  void skip_to(std::uint64_t vertex) override { next_ = vertex; }
  double at(std::uint64_t vertex) override {
    if (vertex >= count_) throw_wrong_count(path_, std::to_string(place(count_)), count_, false, {});
    const double value = load_double(header_.type, windows_.at(place(vertex)), header_.big_endian);
    if (std::isfinite(value)) [[likely]]
      return value;
    throw_not_finite(path_, vertex, std::to_string(place(vertex)));
  }
  void check_unchanged() const override { windows_.file()->check_unchanged("the file"); }
  void check_count(std::uint64_t vertex_count) override {
    if (count_ != vertex_count)
      throw_wrong_count(path_, std::to_string(place(std::min(vertex_count, count_))), count_, false, vertex_count);
  }

 private:
  std::uint64_t place(std::uint64_t vertex) const { return header_.body_offset + bytes_ * vertex; }

  std::string path_;
  FileWindows windows_;
  NumpyHeader header_;
  std::uint64_t bytes_ = 0, count_ = 1, next_ = 0;
};

class TextValueFile final : public ValueFile {
 public:
  TextValueFile(const std::string& path, bool has_gaps) : path_(path), input_(path), has_gaps_(has_gaps) { open(); }

  double next() override {
    require_more();
    const auto value = text_->finite_number<double>("value");
    end_line();
    return value;
  }
  void skip_to(std::uint64_t vertex) override {
    while (read_ < vertex) (void)next_of_any();
  }
  double at(std::uint64_t vertex) override {
    if (values_.empty()) {
      if (has_gaps_ && vertex > read_) skip_to(vertex);
      if (vertex == read_) return next();
      open();
    }
    load(vertex + 1);
    if (std::isfinite(values_[vertex])) [[likely]]
      return values_[vertex];
    throw_not_finite(path_, vertex, "");
  }
  void check_unchanged() const override { input_.check_unchanged("the file"); }
  void check_count(std::uint64_t vertex_count) override {
    if (!values_.empty() || read_ == 0) {
      values_.reserve(vertex_count);
      load(vertex_count);
    }
    if (has_gaps_ && read_ < vertex_count) skip_to(vertex_count);
    const bool more = text_->more();
    text_->mark();
    if (more || read_ != vertex_count)
      throw_wrong_count(path_, text_->position(), read_ + (more ? 1 : 0), more, vertex_count);
  }
  std::uint64_t lookup_bytes(std::uint64_t vertex_count) const override { return vertex_count * sizeof(double); }

 private:
  void open() {
    text_.emplace(input_.open(), TextStyle{.comments = true});
    read_ = 0;
  }

  void require_more() {
    if (text_->more()) return;
    text_->mark();
    throw_wrong_count(path_, text_->position(), read_, false, {});
  }
  void end_line() {
    if (text_->more_on_line()) {
      text_->token();
      text_->fail("a line has more than one number", "write one number per line, in the order of vertices");
    }
    ++read_;
  }
  // Perhaps not finite.
  double next_of_any() {
    require_more();
    const ParsedNumber<double> number = parse_number<double>(text_->token());
    if (!number.ok) text_->fail("value is not a number", "write one number per line, in the order of vertices");
    end_line();
    return number.value + 0.0;
  }
  void load(std::uint64_t count) {
    while (values_.size() < count) values_.push_back(has_gaps_ ? next_of_any() : next());
  }

  std::string path_;
  Input input_;
  bool has_gaps_;
  std::optional<TextCursor> text_;
  std::uint64_t read_ = 0;
  std::vector<double> values_;  // filled if vertices are looked up out of order or counted beforehand
};

// An empty file has the values of a mesh without vertices.
class EmptyValueFile final : public ValueFile {
 public:
  explicit EmptyValueFile(const std::string& path) : path_(path) {}
  double next() override { throw_empty(path_); }
  void skip_to(std::uint64_t) override {}
  double at(std::uint64_t) override { throw_empty(path_); }
  void check_count(std::uint64_t vertex_count) override {
    if (vertex_count != 0) throw_empty(path_);
  }
  void check_unchanged() const override {}

 private:
  std::string path_;
};

}  // namespace

std::unique_ptr<ValueFile> raw_values(std::shared_ptr<const InputFile> file) {
  return std::make_unique<RawValueFile>(std::move(file));
}

std::unique_ptr<ValueFile> open_values(const std::string& path, std::optional<std::uint64_t> vertex_count,
                                       bool has_gaps) {
  check_input_file(path);
  if (is_regular_file(path) && File::open_for_reading(path).size() == 0) {
    if (vertex_count && *vertex_count != 0) throw_empty(path);
    return std::make_unique<EmptyValueFile>(path);
  }
  const bool is_numpy_name = path.ends_with(".npy");
  if (!is_numpy_name && !path.ends_with(".f64")) return std::make_unique<TextValueFile>(path, has_gaps);
  std::unique_ptr<ValueFile> values;
  if (is_numpy_name)
    values = std::make_unique<NumpyValueFile>(path);
  else
    values = raw_values(std::make_shared<const InputFile>(path));
  if (vertex_count) values->check_count(*vertex_count);
  return values;
}

}  // namespace reeb::io
