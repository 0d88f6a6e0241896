// Random command lines, for a second, or for REEB_FUZZ_SECONDS. Each must end with a documented exit code, and each
// failure with one error line and one hint. REEB_SEED chooses which command lines.
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <chrono>
#include <cstdio>
#include <regex>
#include <set>
#include <string>
#include <vector>

#include "tests/support/random.h"
#include "tests/support/seed.h"
#include "tests/tools/program.h"

namespace reeb::test {
namespace {

class CommandLineNoise : public ProgramTest {
 protected:
  struct Subcommand {
    std::string name;
    std::vector<std::string> options;
  };

  void SetUp() override {
    const std::string help = reeb({}).output;
    const std::regex line("\n  ([a-z]+) +[A-Z]"), option("--?[a-z][a-z-]*");
    for (std::sregex_iterator it(help.begin(), help.end(), line), end; it != end; ++it) {
      if ((*it)[1] == "view") continue;  // a server does not end
      const std::string name = (*it)[1], own = reeb({name, "--help"}).output;
      std::set<std::string> options;
      for (std::sregex_iterator o(own.begin(), own.end(), option); o != end; ++o) options.insert(o->str());
      subcommands_.push_back({name, {options.begin(), options.end()}});
    }
    ASSERT_GE(subcommands_.size(), 6u);
    write("mesh.off", kSmallOff);
    expect_success(reeb({"compute", "mesh.off", "-o", "mesh.reeb", "--quiet"}));
  }

  // Names of files stay in the folder, and no number makes a large mesh.
  std::vector<std::string> random_words(Random& random) {
    static constexpr std::array kValues = {
        "mesh.off", "mesh.off", "mesh.reeb", "mesh.reeb", "-",    "none",    ".",   "out.reeb", "out.off", "out.json",
        "out.vtp",  "out.smc",  "z",         "x",         "c1",   "random:", "f:",  "index",    "0",       "1",
        "7",        "16M",      "64M",       "1e3",       "-1",   "0.5%",    "nan", "inf",      "torus",   "scan",
        "hilbert",  "sweep:z",  "",          " ",         "\xff", "%s",      "=",   "--",       "---",     "-fx"};
    const Subcommand& command = subcommands_[random.below(subcommands_.size())];
    std::vector<std::string> words;
    if (random.chance(95)) words.push_back(command.name);
    if (random.chance(70)) words.push_back(random.chance(50) ? "mesh.off" : "mesh.reeb");
    for (std::uint64_t count = random.below(6); count > 0; --count) {
      if (random.chance(55)) words.push_back(command.options[random.below(command.options.size())]);
      words.emplace_back(kValues[random.below(kValues.size())]);
      std::string& word = words.back();
      if (random.chance(10) && !word.empty())
        word[random.below(word.size())] = static_cast<char>('!' + random.below(90));
      if (random.chance(5)) word += words.front();
      std::erase(word, '/');
      if (std::count_if(word.begin(), word.end(), [](char c) { return c >= '0' && c <= '9'; }) > 3) word = "3";
    }
    return words;
  }

  std::vector<Subcommand> subcommands_;
};

TEST_F(CommandLineNoise, EndsWithADocumentedExitCode) {
  const auto end =
      std::chrono::steady_clock::now() + std::chrono::seconds(number_in_environment("REEB_FUZZ_SECONDS").value_or(1));
  Random random(base_seed());
  std::size_t runs = 0, good = 0;
  for (; std::chrono::steady_clock::now() < end && !HasFailure(); ++runs) {
    const Outcome outcome = reeb(random_words(random), {.arguments = {}, .most_seconds = 60});
    SCOPED_TRACE(last_command() + '\n' + outcome.error);
    ASSERT_GE(outcome.exit_code, 0) << "a signal ended it";
    ASSERT_LE(outcome.exit_code, 3);
    good += outcome.exit_code == 0 ? 1u : 0u;
    if (outcome.exit_code == 0) continue;
    ASSERT_EQ(lines_after("reeb: error: ", outcome.error).size(), 1u);
    ASSERT_EQ(lines_after("hint: ", outcome.error).size(), 1u);
    ASSERT_EQ(outcome.error.find("please report this"), std::string::npos);
  }
  std::printf("%zu command lines, %zu of them good\n", runs, good);
}

}  // namespace
}  // namespace reeb::test
