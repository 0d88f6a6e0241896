// The texts of the program: counts, sizes, progress bars and lines of 80 columns.
#include <gtest/gtest.h>

#include <limits>
#include <optional>
#include <string>
#include <vector>

#include "libreeb/base/count_text.h"
#include "libreeb/base/error.h"
#include "libreeb/base/nearest_name.h"
#include "tools/program/bar_line.h"
#include "tools/program/quantity.h"
#include "tools/program/wrapping.h"
#include "tools/repair/repair_mesh.h"

namespace reeb::tools {
namespace {

TEST(CountText, OneIsSingularAndThousandsAreSeparated) {
  EXPECT_EQ(count_of(0, "loop"), "0 loops");
  EXPECT_EQ(count_of(1, "loop"), "1 loop");
  EXPECT_EQ(count_of(1, "vertex"), "1 vertex");
  EXPECT_EQ(count_of(2, "vertex"), "2 vertices");
  EXPECT_EQ(count_of(2, "boundary"), "2 boundaries");
  EXPECT_EQ(count_of(1000, "non-manifold edge"), "1,000 non-manifold edges");
  EXPECT_EQ(with_commas(999), "999");
  EXPECT_EQ(with_commas(372001196), "372,001,196");
  EXPECT_EQ(with_commas(18446744073709551615u), "18,446,744,073,709,551,615");
}

TEST(LargeThreshold, MayBeMeantInPerCent) {
  const ValueRange range{0.5, 0.644443};
  EXPECT_EQ(large_threshold("4", range, "y"), "the threshold 4 is more than the range 0.144443 of y; did you mean 4%?");
  EXPECT_EQ(large_threshold("400", range, "y"), "the threshold 400 is more than the range 0.144443 of y");
  EXPECT_EQ(large_threshold("200%", range, "y"), "the threshold 200% is more than the range of y");
  EXPECT_EQ(large_threshold("200%", {1, 1}, "y"), "");
  for (const char* text : {"0.1", "0.144444", "4%", "100%"}) EXPECT_EQ(large_threshold(text, range, "y"), "") << text;
  EXPECT_EQ(large_threshold("4", {1, 1}, "y"), "") << "any is more";
}

TEST(RepairSummary, CountsHaveCommas) {
  Repair repair;
  repair.rows.resize(7216);
  for (RepairedRow& row : repair.rows) {
    row.kind = DefectKind::kHandle;
    row.why = "it is too long";
  }
  for (std::size_t i = 0; i < 6000; ++i) repair.rows[i].done = true;
  repair.repaired = 6000;
  EXPECT_EQ(summary_of(repair),
            (std::vector<std::string>{"6,000 of 7,216 loops repaired", "1,216 left: it is too long"}));
}

TEST(RepairSummary, SaysWhichLengthWasSuggestedAndIfItIsUncertain) {
  Repair repair;
  repair.rows.resize(3);
  for (RepairedRow& row : repair.rows) row.done = true;
  repair.repaired = 3;
  repair.suggestion = SuggestedLength{.length = 0.25, .confidence = 0.9, .why = ""};
  EXPECT_EQ(summary_of(repair),
            (std::vector<std::string>{"3 of 3 loops repaired",
                                      "as suggested, those with a curve of at most 0.25 (confidence 90 %)"}));
  repair.suggestion->confidence = 0.5;
  ASSERT_EQ(summary_of(repair).size(), 3u);
  EXPECT_NE(summary_of(repair)[2].find("--longest"), std::string::npos);
  repair.suggestion->length = std::nullopt;
  EXPECT_EQ(summary_of(repair).size(), 1u);
}

TEST(RepairSummary, SaysWhenASecondRepairMayHelp) {
  Repair repair;
  repair.rows.resize(2);
  repair.rows[0].done = true;
  repair.rows[1].kind = DefectKind::kTunnel;
  repair.rows[1].why = "cutting along it would divide the surface";
  repair.repaired = 1;
  EXPECT_EQ(summary_of(repair).size(), 2u);
  repair.second_may_help = true;
  ASSERT_EQ(summary_of(repair).size(), 3u);
  EXPECT_NE(summary_of(repair)[2].find("a second repair, of the output"), std::string::npos);
}

TEST(RepairSummary, SaysWhatMayHelpWithUnclearRows) {
  Repair repair;
  repair.rows.resize(1);
  repair.rows[0].kind = DefectKind::kUnclear;
  repair.rows[0].why = "no curve was found";
  const auto note = [&] {
    std::string found;
    for (const std::string& line : summary_of(repair))
      if (line.find("unclear") != std::string::npos) found += line;
    return found;
  };
  EXPECT_EQ(note(), "") << "the mesh has neither boundaries nor duplicates";
  repair.mesh_boundaries = 407;
  EXPECT_EQ(
      note(),
      "note: the kind of one loop is unclear; the mesh has 407 boundaries: --fill-boundaries LENGTH, and a second "
      "repair, of the output, can help");
  repair.mesh_duplicates = 1;
  EXPECT_NE(note().find("--fill-boundaries LENGTH, --drop-duplicates"), std::string::npos);
  repair.rows.push_back(repair.rows[0]);
  repair.cleaning.boundary_length = 1;
  EXPECT_EQ(note(),
            "note: the kind of 2 loops is unclear; the mesh has 1 duplicate triangle: --drop-duplicates, and a second "
            "repair, of the output, can help");
  repair.cleaning.duplicates = true;
  EXPECT_EQ(note(), "");
  repair.boundaries_filled = 3;
  EXPECT_EQ(note(), "note: the kind of 2 loops is unclear; repair the output again");
}

TEST(RepairSummary, SaysWhatItCannotChange) {
  Repair repair;
  repair.rows.resize(1);
  repair.rows[0].kind = DefectKind::kUnclear;
  repair.rows[0].why = "kind unclear";
  const auto text = [&] {
    std::string all;
    for (const std::string& line : summary_of(repair)) all += line + "\n";
    return all;
  };
  const std::string before = text();
  repair.nonmanifold_edges = 42;
  repair.nonmanifold_vertices = 1;
  EXPECT_EQ(text(), before +
                        "note: the mesh has 42 non-manifold edges and 1 non-manifold vertex, which repair does not "
                        "separate; a loop there stays unclear\n");
  repair.nonmanifold_edges = 0;
  EXPECT_NE(text().find("the mesh has 1 non-manifold vertex, which"), std::string::npos);
  repair.nonmanifold_vertices = 0;
  repair.pinched_boundaries = 2;
  EXPECT_EQ(text(), before + "note: 2 boundaries of the mesh cannot be filled: they are not simple paths\n");
  // A seam is joined first.
  repair.pinched_boundaries = 0;
  repair.mesh_boundaries = 5;
  EXPECT_NE(text().find("--fill-boundaries LENGTH"), std::string::npos);
  repair.seam_vertices = 8;
  EXPECT_EQ(text().find("--fill-boundaries LENGTH"), std::string::npos);
  EXPECT_NE(text().find("note: 8 vertices of boundaries have the coordinates of another one"), std::string::npos);
}

TEST(RepairSummary, SaysThatNothingWasDropped) {
  Repair repair;
  repair.mesh_triangles = 5;
  repair.cleaning.components_percent = 1;
  repair.isolated_vertices = 1113;
  EXPECT_EQ(summary_of(repair).back(), "no component dropped; 1,113 isolated vertices stay");
  repair.suggestion = SuggestedLength{.length = 0.1122, .confidence = 0.9, .why = ""};
  for (const std::string& line : summary_of(repair)) EXPECT_EQ(line.find("suggested"), std::string::npos) << line;
}

TEST(RowChoice, ALoopWithoutACurveIsNotCalledTooLong) {
  Defects defects;
  defects.functions = {"x"};
  DefectRow row{};
  row.length_contour = row.length_cycle = std::numeric_limits<double>::infinity();
  defects.table.rows = {row};
  RowFilter up_to_100, all;
  up_to_100.limits.longest = 100;
  all.all = true;
  for (const RowFilter& filter : {RowFilter(), up_to_100, all}) {
    const std::vector<ChosenRow> chosen = choose_rows(defects, filter);
    ASSERT_EQ(chosen.size(), 1u);
    EXPECT_EQ(chosen[0].why_not, "no short curve was found");
  }
}

// Where sheets meet, a short contour is not along edges, so it has a length and no path.
TEST(RowChoice, ALoopWithALengthAndNoPathIsUnclear) {
  Defects defects;
  defects.functions = {"x"};
  DefectRow row{};
  row.length_contour = 0.5;
  defects.table.rows = {row};
  RowFilter all, shorter;
  all.all = true;
  shorter.limits.longest = 0.25;
  EXPECT_EQ(choose_rows(defects, all)[0].why_not, "kind unclear: a boundary, or no oriented manifold");
  EXPECT_EQ(choose_rows(defects, shorter)[0].why_not, "curve longer than --longest 0.25");
}

TEST(Quantity, CountsTakeUnitsFractionsAndExponents) {
  const auto count = [](const std::string& text) { return parse_count("--chunk", text); };
  EXPECT_EQ(count("0"), 0u);
  EXPECT_EQ(count("50000"), 50'000u);
  EXPECT_EQ(count("10k"), 10'000u);
  EXPECT_EQ(count("1.5k"), 1'500u);
  EXPECT_EQ(count("1.5K"), 1'500u);
  EXPECT_EQ(count("12M"), 12'000'000u);
  EXPECT_EQ(count("1G"), 1'000'000'000u);
  EXPECT_EQ(count("1e3"), 1'000u);
  EXPECT_EQ(count("1.25e2k"), 125'000u);
  // No double is 4.1, and the product is not exact.
  for (int i = 0; i < 10'000; ++i) {
    const std::string digits = std::to_string(1'000'000 + i);
    EXPECT_EQ(count("8." + digits.substr(1) + "M"), 8'000'000u + static_cast<unsigned>(i));
    EXPECT_EQ(count(std::to_string(i / 1000) + "." + std::to_string(1000 + i % 1000).substr(1) + "k"),
              static_cast<unsigned>(i));
  }
  EXPECT_EQ(count("18446744073709551615"), 18446744073709551615u);
  EXPECT_EQ(count("9007199254740993"), 9007199254740993u) << "2^53 + 1, which no double is";
}

TEST(Quantity, WhatIsNoCountIsRefusedWithTheNameOfTheOption) {
  for (const char* text : {"", " ", "-1", "-5k", "+1", "x", "1.5", "0.0001k", "1kk", "10kB", "1e30", "nan", "inf",
                           "0x10", "99999999999999999999"}) {
    try {
      parse_count("--nodes", text);
      ADD_FAILURE() << text;
    } catch (const Error& error) {
      EXPECT_EQ(error.kind(), ErrorKind::kUsage);
      EXPECT_EQ(error.message(), "--nodes: \"" + std::string(text) + "\" is not a whole number");
    }
  }
  try {
    parse_count("--chunk", "0", {.least = 1});
    ADD_FAILURE();
  } catch (const Error& error) {
    EXPECT_EQ(error.message(), "--chunk must be at least 1");
  }
  try {
    parse_count("--threads", "2k", {.least = 1, .most = 1024});
    ADD_FAILURE();
  } catch (const Error& error) {
    EXPECT_EQ(error.message(), "--threads can be at most 1,024");
  }
}

TEST(Quantity, SizesAreInPowersOf1024) {
  const auto size = [](const std::string& text) { return parse_size("--memory", text); };
  EXPECT_EQ(size("4096"), 4096u);
  EXPECT_EQ(size("64M"), 64u << 20);
  EXPECT_EQ(size("64mb"), 64u << 20);
  EXPECT_EQ(size("1.5GiB"), 3u << 29);
  EXPECT_EQ(size("1e3k"), 1000u << 10);
  for (const char* text : {"", "-1", "-64M", "64X", "M", "1Mi", "1ib", "1e40", "nan"})
    EXPECT_THROW(size(text), Error) << text;
}

TEST(BarLine, FitsAnyTerminalAndKeepsWhatMatters) {
  const BarState full{"2/4 sorting on disk", 0.425, 7.4, 12.34, 123u << 20};
  EXPECT_EQ(bar_line(full, 200),
            "2/4 sorting on disk  [###########.................]  42 %  12.3 M triangles/s  10 s left  123.0 MiB");
  for (const BarState& state :
       {full, BarState{"1/3 reading", -1, 100, 0.1, 1u << 30}, BarState{"4/4 simplification", 1, 0, 0, 12},
        BarState{"3/3 simplification", 0.0101, 86400, 0, 1u << 30}})
    for (std::size_t columns = 1; columns <= 120; ++columns) {
      const std::string line = bar_line(state, columns);
      EXPECT_LE(line.size(), columns) << line;
      if (columns >= 30 && state.share >= 0) {
        EXPECT_NE(line.find('%'), std::string::npos) << line;
      }
      if (columns >= 79) {
        EXPECT_EQ(line.find('[') != std::string::npos, state.share >= 0) << line;
      }
    }
}

TEST(BarLine, SaysHowLongInTheLargestFittingUnit) {
  EXPECT_NE(bar_line({"x", 0.5, 10, 0, 0}, 80).find("10 s left"), std::string::npos);
  EXPECT_NE(bar_line({"x", 0.5, 200, 0, 0}, 80).find("3 min 20 s left"), std::string::npos);
  EXPECT_NE(bar_line({"x", 0.5, 3900, 0, 0}, 80).find("1 h 05 min left"), std::string::npos);
  EXPECT_EQ(bar_line({"x", 0.001, 10, 0, 0}, 80).find("left"), std::string::npos) << "too early to tell";
}

TEST(Wrapping, BreaksAtSpacesOnly) {
  EXPECT_EQ(wrapped("one two three", 2, 20), "one two three");
  EXPECT_EQ(wrapped("one two three", 2, 9), "one two\n  three");
  EXPECT_EQ(wrapped("one two three", 2, 7), "one two\n  three");
  EXPECT_EQ(wrapped("  a  b  c", 4, 20), "  a  b  c");
  EXPECT_EQ(wrapped("a-very-long-word x", 2, 5), "a-very-long-word\n  x");
  EXPECT_EQ(wrapped("", 2, 5), "");
}

TEST(UsageError, FindsNamesThatAreNear) {
  const std::vector<std::string> commands = {"compute", "info", "convert"}, options = {"--force", "--format"};
  EXPECT_EQ(nearest("comptue", commands), "compute");
  EXPECT_EQ(nearest("holes", commands), "");
  EXPECT_EQ(nearest("--foo", options), "--force");
  EXPECT_EQ(nearest("--wide", options), "");
  EXPECT_EQ(nearest("x", {}), "");
}

TEST(Quantity, APercentSignMayFollowABlank) {
  EXPECT_DOUBLE_EQ(parse_threshold("--threshold", "5 %", {0, 20}), 1);
  EXPECT_DOUBLE_EQ(parse_share("--drop", "5 %", "hint"), 5);
  for (const char* text : {"5 % ", "5 ", " %", "%", "0,5%", "5%%", "5 x%"})
    EXPECT_THROW(parse_threshold("--threshold", text, {0, 20}), Error) << text;
}

TEST(Quantity, SharesOfARangeBeyondTheDoubles) {
  const ValueRange range{-1e308, 1e308};
  EXPECT_DOUBLE_EQ(parse_threshold("--threshold", "0.1%", range), 2e305);
  EXPECT_DOUBLE_EQ(percent_of(range, -2e307, 5e307), 35);
  EXPECT_DOUBLE_EQ(percent_of(range, -1e308, 1e308), 100);
  EXPECT_DOUBLE_EQ(percent_of({0, 5e-324}, 0, 5e-324), 100);
}

}  // namespace
}  // namespace reeb::tools
