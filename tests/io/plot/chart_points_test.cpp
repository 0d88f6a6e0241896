// What charts show, against plain counts; and names that mean something to gnuplot or XML.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <random>
#include <span>

#include "io/drawing/svg_text.h"
#include "io/plot/diagram_chart.h"
#include "io/plot/gnuplot_text.h"
#include "io/plot/loop_chart.h"
#include "io/plot/value_axis.h"
#include "io/text/number_text.h"

namespace reeb::io {
namespace {

TEST(LoopSteps, HaveACornerForEachOfAFewLoops) {
  const std::vector<double> percents = {0.5, 0.5, 2, 30};
  const std::vector<std::pair<double, std::size_t>> expected = {{0.5, 4}, {0.5, 3}, {2, 2}, {30, 1}};
  EXPECT_EQ(loop_steps(percents), expected);
  EXPECT_TRUE(loop_steps({}).empty());
}

// Each corner is a true count, and no loop is farther from a corner than a column of the picture.
TEST(LoopSteps, OfManyLoopsKeepTheCurve) {
  std::mt19937_64 random(5);
  std::vector<double> percents;
  for (int i = 0; i < 50000; ++i)
    percents.push_back(std::pow(10, -6 + 8 * (static_cast<double>(random() >> 11) * 0x1p-53)));
  std::sort(percents.begin(), percents.end());
  const auto steps = loop_steps(percents);
  EXPECT_LE(steps.size(), kMostCorners);
  EXPECT_EQ(steps.front(), std::pair(percents.front(), percents.size()));
  EXPECT_EQ(steps.back(), std::pair(percents.back(), std::size_t{1}));
  for (const auto& [percent, count] : steps) EXPECT_EQ(percents[percents.size() - count], percent);
  for (const double percent : percents) {
    const auto near = std::lower_bound(steps.begin(), steps.end(), std::pair(percent, std::size_t{0}));
    ASSERT_NE(near, steps.end());
    EXPECT_LT(std::log10(near->first / percent), 8.0 / 400);
  }
}

TEST(LoopSteps, OfEqualLoopsAreFew) { EXPECT_EQ(loop_steps(std::vector<double>(5000, 7.0)).size(), 2u); }

// All curves look alike, however many loops there are.
TEST(LoopChart, HasNoMarks) {
  for (const std::size_t count : {1u, 20u, 900u}) {
    const LoopSeries series{"a", std::vector<double>(count, 5.0)};
    EXPECT_EQ(loop_chart(std::span(&series, 1)).find("points"), std::string::npos) << count;
  }
}

TEST(DiagramPoints, PutMinimaAboveAndMaximaBelowTheDiagonal) {
  DiagramPoints points(4, 0, 10);
  points.add(PairType::kOrd0, 1, 2);
  points.add(PairType::kRel1, 1, 2);
  points.add(PairType::kExt0, 0, 10);
  points.add(PairType::kExt1, 3, 4);
  points.finish();
  EXPECT_FALSE(points.is_thinned());
  for (const PairType type : {PairType::kOrd0, PairType::kRel1, PairType::kExt0, PairType::kExt1}) {
    ASSERT_EQ(points.of(type).size(), 1u);
    const bool above = points.of(type)[0].y > points.of(type)[0].x;
    EXPECT_EQ(above, type == PairType::kOrd0 || type == PairType::kExt0) << name_of(type);
  }
}

// Of many pairs fewer points are drawn, but none is far from one of its type.
TEST(DiagramPoints, OfManyPairsAreThinnedEvenly) {
  constexpr std::size_t kPairs = 60000;
  std::mt19937_64 random(9);
  DiagramPoints points(kPairs, -2, 2);
  std::vector<DiagramPoints::Point> minima;
  for (std::size_t i = 0; i < kPairs; ++i) {
    double lo = static_cast<double>(random() % 4000) / 1000 - 2, hi = static_cast<double>(random() % 4000) / 1000 - 2;
    if (lo > hi) std::swap(lo, hi);
    points.add(i % 2 == 0 ? PairType::kOrd0 : PairType::kRel1, lo, hi);
    if (i % 2 == 0) minima.push_back({lo, hi});
  }
  points.finish();
  EXPECT_TRUE(points.is_thinned());
  EXPECT_EQ(points.count(PairType::kOrd0), kPairs / 2);
  const auto& drawn = points.of(PairType::kOrd0);
  EXPECT_LE(drawn.size() + points.of(PairType::kRel1).size(), DiagramPoints::kMostPoints);
  EXPECT_GT(drawn.size(), 1000u);
  for (std::size_t i = 0; i < minima.size(); i += 97)
    EXPECT_TRUE(std::any_of(drawn.begin(), drawn.end(), [&](const auto& point) {
      return std::hypot(point.x - minima[i].x, point.y - minima[i].y) < 4 * 0.03;
    })) << i;
}

TEST(ChartText, QuotesWhatGnuplotWouldRead) {
  EXPECT_EQ(gnuplot_quoted("it's `rm` \"x\" \\n $1 @y"), "'it''s `rm` \"x\" \\n $1 @y'");
  EXPECT_EQ(gnuplot_quoted("a\nb"), "'a\\x0ab'");
}

TEST(ChartText, HasTheHeadingInBold) {
  const std::string chart = with_heading("<svg>\n<path/>\n</svg>\n\n", {"a < b", "c"});
  EXPECT_NE(chart.find("font-weight=\"bold\" fill=\"#222222\">a &lt; b</text>"), std::string::npos);
  EXPECT_TRUE(chart.ends_with("</g>\n</svg>\n\n"));
}

TEST(ChartText, HasTheTitleForReadersInsteadOfThatOfGnuplot) {
  const std::string chart = with_heading(
      "<?xml version=\"1.0\"?>\n<svg \n width=\"8\"\n>\n\n<title>Gnuplot</title>\n<desc>Produced by GNUPLOT 5.4 "
      "</desc>\n"
      "<g><title>gnuplot_plot_1</title></g>\n</svg>\n",
      {"a < b", "c"});
  EXPECT_NE(chart.find("<svg role=\"img\" \n width=\"8\"\n>\n<title>a &lt; b</title>\n"), std::string::npos) << chart;
  EXPECT_EQ(chart.find("Gnuplot"), std::string::npos);
  EXPECT_EQ(chart.find("GNUPLOT"), std::string::npos);
  EXPECT_NE(chart.find("gnuplot_plot_1"), std::string::npos);
  EXPECT_NE(begin_svg(8, 8, {"a < b", "c"}).find(" role=\"img\""), std::string::npos);
  EXPECT_NE(begin_svg(8, 8, {"a < b", "c"}).find("<title>a &lt; b</title>"), std::string::npos);
}

// gnuplot gives a column the room for its longest name, in wide letters.
TEST(LoopChart, HasOneColumnOfNamesIfTheyAreLong) {
  std::vector<LoopSeries> series(3, {"head, f = y: 677 loops", {1, 2}});
  EXPECT_NE(loop_chart(series).find("maxcols 2 maxrows 2"), std::string::npos);
  series[1].name = "the upper half of the head, f = y: 677 loops";
  EXPECT_NE(loop_chart(series).find("maxcols 1 maxrows 3"), std::string::npos);
}

TEST(ChartText, WritesShortCoordinates) {
  for (const auto& [value, text] : {std::pair(1.0, "1"), {-0.04, "0"}, {12.345, "12.3"}, {0.0 / 0.0, "0"}}) {
    std::string svg;
    append_coordinate(svg, value);
    EXPECT_EQ(svg, text);
  }
}

// Values whose range is small beside them, as coordinates of maps are.
TEST(ValueAxis, TellsNumbersOfASmallRangeApart) {
  EXPECT_EQ(digits_for_range(0, 1), 6);
  EXPECT_EQ(digits_for_range(-3, 2), 6);
  EXPECT_EQ(digits_for_range(5, 5), 6);
  EXPECT_EQ(digits_for_range(-1e308, 1e308), 6);
  const double low = 4900122.7, high = 4900124.3;
  EXPECT_EQ(digits_for_range(low, high, 4), 10);
  EXPECT_EQ(short_number(low, digits_for_range(low, high, 4)), "4900122.7");
  EXPECT_NE(short_number(1e9, digits_for_range(1e9, 1e9 + 1e-6)),
            short_number(1e9 + 1e-6, digits_for_range(1e9, 1e9 + 1e-6)));
  const auto labels = round_values(low, high, 5);
  EXPECT_EQ(axis_base(low, high, labels), labels.front());
  EXPECT_EQ(axis_base(-low, -low + 1e-3, {-low}), -low);
  EXPECT_EQ(axis_base(0, 1, {0, 0.5, 1}), 0);
  EXPECT_EQ(axis_base(100, 101, {100, 100.5, 101}), 0);
}

TEST(ValueAxis, HasRoundValuesInTheRange) {
  EXPECT_EQ(round_values(0, 1, 5), (std::vector<double>{0, 0.2, 0.4, 0.6000000000000001, 0.8, 1}));
  EXPECT_EQ(round_values(3, 3, 5), (std::vector<double>{3}));
  for (const auto& [low, high] : {std::pair(-1e300, 1e300), {1e-300, 2e-300}, {1.0, std::nextafter(1.0, 2.0)}}) {
    const auto values = round_values(low, high, 8);
    EXPECT_LE(values.size(), 32u);
    for (const double value : values) EXPECT_TRUE(std::isfinite(value));
  }
}

}  // namespace
}  // namespace reeb::io
