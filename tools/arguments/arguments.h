// The command line of a program: commands, their options, and where the values go. Only this room includes CLI11, whose
// header takes longer to compile than most of what uses it.
#pragma once

#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <vector>

namespace CLI {
class App;
class Option;
}  // namespace CLI

namespace reeb::tools {

// An option of a command, or an argument (an option whose name has no dash). A handle, cheap to copy; each function
// changes the option and returns the handle.
class Option {
 public:
  explicit Option(CLI::Option& option) : option_(&option) {}

  Option required();
  // What the help shows for the value.
  Option type_name(const std::string& text);
  // What the help shows after the name, in place of all it would say by itself.
  Option option_text(const std::string& text);
  Option one_of(const std::vector<std::string>& values);
  Option needs(Option other);
  Option excludes(Option other);
  // For an option that may be repeated: one value each time.
  Option one_value_each_time();

 private:
  CLI::Option* option_;
};

// A command of a program: a handle, cheap to copy. Targets must outlive the parsing.
class Command {
 public:
  explicit Command(CLI::App& command) : command_(&command) {}

  // `names` as "-o,--output", or "MESH" for an argument.
  Option add_option(const std::string& names, std::string& target, const std::string& description);
  Option add_option(const std::string& names, std::vector<std::string>& target, const std::string& description);
  Option add_flag(const std::string& names, bool& target, const std::string& description);
  Option add_flag(const std::string& names, std::function<void()> set, const std::string& description);
  // An option whose text `take` reads, and may refuse by an Error.
  Option add_option(const std::string& names, std::function<void(const std::string&)> take,
                    const std::string& description);

  // An option of other commands, which this one does not have, with or without a value. Help does not show it.
  void refuse_option(const std::string& name, const std::string& why, const std::string& hint);
  void footer(const std::string& text);
  // What the command does, called once all options are set.
  void callback(std::function<void()> run);

 private:
  CLI::App* command_;
};

class Program {
 public:
  Program(const std::string& name, const std::string& description);
  ~Program();
  Program(const Program&) = delete;
  Program& operator=(const Program&) = delete;

  Command add_command(const std::string& name, const std::string& description);
  void set_version(const std::string& text);
  // What the help says after "Usage: ".
  void set_usage(const std::string& text);
  void footer(const std::string& text);
  // Called when the options of a command are set, before its callback.
  void before_commands(const std::function<void()>& call);

  bool has_command(const std::string& name) const;
  std::string help() const;

  // Sets the targets and calls the callback of the command in `words`. Returns what to print instead where --help or
  // --version asks for it.
  // THROWS: Error{kUsage}; what the callback throws.
  std::optional<std::string> run(const std::vector<std::string>& words);

 private:
  std::unique_ptr<CLI::App> program_;
};

}  // namespace reeb::tools
