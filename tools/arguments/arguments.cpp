#include "tools/arguments/arguments.h"

#include <CLI/CLI.hpp>

#include <algorithm>
#include <sstream>
#include <string_view>
#include <utility>

#include "io/file/file.h"
#include "libreeb/base/error.h"
#include "tools/arguments/usage_error.h"
#include "tools/program/wrapping.h"

namespace reeb::tools {
namespace {

// Helps in 80 columns.
class HelpFormatter : public CLI::Formatter {
 public:
  HelpFormatter() {
    label("REQUIRED", "(required)");
    label("Positionals", "Arguments");
    label("SUBCOMMAND", "COMMAND");
    column_width(27);
  }
  void set_usage(const std::string& text) { usage_ = text; }
  // Refused options are in a group without a name, for which CLI11 leaves an empty line.
  std::string make_help(const CLI::App* app, std::string name, CLI::AppFormatMode mode) const override {
    std::string text = CLI::Formatter::make_help(app, std::move(name), mode);
    for (std::size_t at; (at = text.find("\n\n\n")) != std::string::npos;) text.erase(at, 1);
    return text;
  }
  std::string make_usage(const CLI::App* app, std::string name) const override {
    if (app->get_parent() != nullptr || usage_.empty()) return CLI::Formatter::make_usage(app, std::move(name));
    return "Usage: " + usage_ + "\n";
  }
  std::string make_option_desc(const CLI::Option* option) const override {
    return wrapped(option->get_description(), 0, kTextColumns - get_column_width());
  }
  // The descriptions say what an option needs, and the errors what it excludes.
  std::string make_option_opts(const CLI::Option* option) const override {
    const std::string text = CLI::Formatter::make_option_opts(option);
    return text.substr(0, std::min(text.find(" Needs:"), text.find(" Excludes:")));
  }

 private:
  std::string usage_;  // of the program, if it is not that of CLI11
};

// Files do not know which command uses them. One without --temp-dir takes the folder from TMPDIR.
std::string hint_without_temp_dir(std::string hint) {
  constexpr std::pair<std::string_view, std::string_view> kChanges[] = {
      {"choose a folder that exists and is writable with --temp-dir DIR",
       "set TMPDIR to a folder that exists and is writable"},
      {io::kOtherTempFolderHint, "set TMPDIR to a folder of another"}};
  for (const auto& [from, to] : kChanges)
    if (const auto at = hint.find(from); at != std::string::npos) hint.replace(at, from.size(), to);
  return hint;
}

// An unset variable of a shell is an empty value: taken for no value, it would change what a command does.
CLI::Option* refuse_empty(CLI::Option* option) {
  const auto check = [name = option->get_name()](const std::string& word) {
    if (word.empty())
      throw Error(ErrorKind::kUsage, name + ": the value is empty", "give one, or leave the option out");
    return std::string();
  };
  return option->nonpositional() ? option->check(CLI::Validator(check, "")) : option;
}

// Splits `--name=`, for which CLI11 would take the next word.
std::vector<std::string> with_empty_values(const CLI::App& program, const std::vector<std::string>& words) {
  const CLI::App* command = words.empty() ? nullptr : find_command(program, words[0]);
  if (command == nullptr) return words;
  std::vector<std::string> split;
  for (auto word = words.begin(); word != words.end(); ++word) {
    if (*word == "--") {
      split.insert(split.end(), word, words.end());
      break;
    }
    const bool is_empty = word->starts_with("--") && word->ends_with('=');
    const std::string name = is_empty ? word->substr(0, word->size() - 1) : *word;
    const CLI::Option* option = is_empty ? command->get_option_no_throw(name) : nullptr;
    split.push_back(option == nullptr ? *word : name);
    if (option != nullptr) split.emplace_back();
  }
  return split;
}

}  // namespace

Option Option::required() {
  option_->required();
  return *this;
}

Option Option::type_name(const std::string& text) {
  option_->type_name(text);
  return *this;
}

Option Option::option_text(const std::string& text) {
  option_->option_text(text);
  return *this;
}

Option Option::one_of(const std::vector<std::string>& values) {
  const auto check = [values](const std::string& word) {
    if (std::ranges::find(values, word) != values.end()) return std::string();
    std::string names = values[0];
    for (std::size_t i = 1; i < values.size(); ++i) names += (i + 1 < values.size() ? ", " : " or ") + values[i];
    return "takes " + names + ", not '" + word + "'";
  };
  option_->check(CLI::Validator(check, ""));
  return *this;
}

Option Option::needs(Option other) {
  option_->needs(other.option_);
  return *this;
}

Option Option::excludes(Option other) {
  option_->excludes(other.option_);
  return *this;
}

Option Option::one_value_each_time() {
  option_->allow_extra_args(false);
  return *this;
}

Option Command::add_option(const std::string& names, std::string& target, const std::string& description) {
  return Option(*refuse_empty(command_->add_option(names, target, description)));
}

Option Command::add_option(const std::string& names, std::vector<std::string>& target, const std::string& description) {
  return Option(*refuse_empty(command_->add_option(names, target, description)));
}

Option Command::add_option(const std::string& names, std::function<void(const std::string&)> take,
                           const std::string& description) {
  return Option(*refuse_empty(command_->add_option_function<std::string>(names, std::move(take), description)));
}

Option Command::add_flag(const std::string& names, bool& target, const std::string& description) {
  return Option(*command_->add_flag(names, target, description));
}

Option Command::add_flag(const std::string& names, std::function<void()> set, const std::string& description) {
  return Option(*command_->add_flag_callback(names, std::move(set), description));
}

void Command::refuse_option(const std::string& name, const std::string& why, const std::string& hint) {
  const auto refuse = [=](const std::string&) { throw Error(ErrorKind::kUsage, name + ": " + why, hint); };
  command_->add_option_function<std::string>(name, refuse)->expected(0, 1)->group("");
}

void Command::footer(const std::string& text) { command_->footer(text); }

void Command::callback(std::function<void()> run) {
  command_->callback([command = command_, run = std::move(run)] {
    try {
      run();
    } catch (const Error& error) {
      const std::string hint = hint_without_temp_dir(error.hint());
      if (hint == error.hint() || command->get_option_no_throw("--temp-dir") != nullptr) throw;
      throw error.with_hint(hint);
    }
  });
}

Program::Program(const std::string& name, const std::string& description)
    : program_(std::make_unique<CLI::App>(description, name)) {
  program_->formatter(std::make_shared<HelpFormatter>());
  program_->set_help_flag("-h,--help", "Print this help");
  program_->require_subcommand(0, 1);
}

Program::~Program() = default;

Command Program::add_command(const std::string& name, const std::string& description) {
  return Command(*program_->add_subcommand(name, description)->group("Commands"));
}

void Program::set_version(const std::string& text) {
  program_->set_version_flag("--version", text, "Print the version");
}

void Program::set_usage(const std::string& text) {
  const auto formatter = std::make_shared<HelpFormatter>();
  formatter->set_usage(text);
  program_->formatter(formatter);
}

void Program::footer(const std::string& text) { program_->footer(text); }

void Program::before_commands(const std::function<void()>& call) {
  for (CLI::App* command : program_->get_subcommands({})) command->parse_complete_callback(call);
}

bool Program::has_command(const std::string& name) const { return find_command(*program_, name) != nullptr; }

std::string Program::help() const { return program_->help(); }

std::optional<std::string> Program::run(const std::vector<std::string>& words) {
  if (const auto error = missing_value(*program_, words)) throw *error;
  try {
    std::vector<std::string> all = with_empty_values(*program_, words);
    std::ranges::reverse(all);  // as CLI11 takes them
    program_->parse(all);
  } catch (const CLI::ParseError& refusal) {
    if (refusal.get_exit_code() != 0) throw usage_error(*program_, words, refusal);
    std::ostringstream text;
    program_->exit(refusal, text);
    return text.str();
  }
  return {};
}

}  // namespace reeb::tools
