// Writers: byte for byte the files of the authors of the formats, and back.
#include <gtest/gtest.h>

#include <filesystem>
#include <sstream>

#include "io/events/stream_writer.h"
#include "tests/io/streaming/samples.h"
#include "tests/support/same.h"

namespace reeb::io {
namespace {

void copy(EventReader& reader, StreamWriter& writer) {
  while (const StreamEvent* event = reader.next()) writer.write(*event);
  writer.close();
}

// NAME of NAME.pre.sma.
std::vector<std::string> mesh_names() {
  std::vector<std::string> names;
  for (const Sample& sample : all_samples())
    if (sample.good() && sample.file.ends_with(".pre.sma"))
      names.push_back(sample.file.substr(0, sample.file.size() - 8));
  return names;
}

bool has_sample(const std::string& file) { return std::filesystem::exists(test::sample_folder() + "/" + file); }

TEST(StreamWriters, BlocksOfEveryMeshAreTheSampleByteForByte) {
  std::size_t count = 0;
  for (const std::string& name : mesh_names()) {
    if (!has_sample(name + ".le.smb")) continue;
    ++count;
    const std::string source = sample_bytes(name + ".pre.sma");
    const auto reader = open_bytes(source);
    std::ostringstream out;
    copy(*reader, *make_block_writer(out, reader->header()));
    EXPECT_TRUE(test::same(out.str(), sample_bytes(name + ".le.smb"))) << name;
  }
  EXPECT_GT(count, 9u);
}

TEST(StreamWriters, CompressedMeshesAreTheSamplesByteForByte) {
  std::size_t count = 0;
  for (const Sample& sample : all_samples()) {
    const std::size_t dot = sample.file.find(".v");
    if (!sample.good() || dot == std::string::npos || !sample.file.ends_with(".smc")) continue;
    const std::string name = sample.file.substr(0, dot);
    if (!has_sample(name + ".pre.sma")) continue;
    const std::string variant = sample.file.substr(dot + 1, sample.file.size() - dot - 5);
    const std::string source = sample_bytes(name + ".pre.sma");
    const auto reader = open_bytes(source);
    StreamHeader header = reader->header();
    SmcOptions options;
    options.version = variant[1] == '1' ? 1 : 3;
    const std::size_t dash = variant.find('-');
    const char kind = dash == std::string::npos ? ' ' : variant[dash + 1];
    if (kind == 'q' || kind == 'a')
      options.precision = static_cast<std::uint32_t>(std::stoul(variant.substr(dash + 2)));
    if (kind != 'q' && kind != 'b') header.box.reset();
    if (kind == 'a') header.vertex_count = header.cell_count = std::nullopt;
    std::ostringstream out;
    try {
      copy(*reader, *make_smc_writer(out, header, options));
    } catch (const Error& error) {
      ADD_FAILURE() << sample.file << ": " << error.what();
      continue;
    }
    if (sample.file == "tetra.trailing-bytes.v3.smc" || sample.file == "tetra.promises-more.v3.smc") continue;
    ++count;
    EXPECT_TRUE(test::same(out.str(), sample_bytes(sample.file))) << sample.file;
  }
  EXPECT_GT(count, 60u);
}

TEST(StreamWriters, TextOfEverySampleReadsBackTheSame) {
  for (const Sample& sample : all_samples()) {
    if (!sample.good()) continue;
    const std::string source = sample_bytes(sample.file);
    const auto reader = open_bytes(source, sample.file);
    StreamHeader header = reader->header();
    if (sample.warnings.find("COUNT") != std::string::npos) header.vertex_count = header.cell_count = std::nullopt;
    std::ostringstream out;
    copy(*reader, *make_text_writer(out, header));
    const Outcome back = read_all(out.str());
    EXPECT_EQ(back.error, "") << sample.file;
    EXPECT_TRUE(test::same(back.events, golden_events(sample.file))) << sample.file;
  }
}

TEST(StreamWriters, BlocksOfEverySampleReadBackTheSame) {
  for (const Sample& sample : all_samples()) {
    const bool block = sample.file.ends_with(".smb") || sample.file.ends_with(".svb");
    if (!sample.good() || !(block || sample.file.ends_with(".smc"))) continue;
    const std::string source = sample_bytes(sample.file);
    const auto reader = open_bytes(source, sample.file);
    StreamHeader header = reader->header();
    header.vertex_count = header.cell_count = std::nullopt;  // patched in at the end
    std::ostringstream out;
    const auto writer = make_block_writer(out, header);
    copy(*reader, *writer);
    EXPECT_TRUE(writer->warnings().empty()) << sample.file;
    const std::string written = out.str();
    EXPECT_TRUE(open_bytes(written)->header().vertex_count.has_value()) << sample.file;
    const Outcome back = read_all(written);
    EXPECT_EQ(back.error, "") << sample.file;
    EXPECT_TRUE(test::same(back.events, golden_events(sample.file))) << sample.file;
  }
}

TEST(StreamWriters, WhatAFormatCannotHoldIsSaid) {
  const std::string source = "v 0 0 0\nv 1 0 0\nv 0 1 0\nv 9 9 9\nf 1 2 3\nv 0 0 5\nx 1\nx 4\n";
  for (const bool compressed : {false, true}) {
    const auto reader = open_bytes(source);
    std::ostringstream out;
    const auto writer = compressed ? make_smc_writer(out, reader->header()) : make_block_writer(out, reader->header());
    copy(*reader, *writer);
    std::string said;
    for (const auto& text : writer->warnings()) said += text;
    if (compressed) {
      EXPECT_NE(said.find("2 vertices in no triangle"), std::string::npos) << said;
      EXPECT_NE(said.find("1 finalization apart"), std::string::npos) << said;
    } else {
      EXPECT_NE(said.find("2 finalizations"), std::string::npos) << said;
    }
  }
  std::ostringstream out;
  const std::string repeated = "v 0 0 0\nv 1 0 0\nf 1 2 2\n";
  const auto reader = open_bytes(repeated);
  EXPECT_THROW(copy(*reader, *make_smc_writer(out, reader->header())), Error);
}

}  // namespace
}  // namespace reeb::io
