#include "tools/arguments/usage_error.h"

#include <algorithm>
#include <cctype>
#include <optional>

#include "io/file/file_name.h"
#include "libreeb/base/nearest_name.h"

namespace reeb::tools {
namespace {

// Short names are not near to anything.
std::vector<std::string> long_names(const CLI::App& command) {
  std::vector<std::string> names;
  for (const CLI::Option* option : command.get_options({})) {
    if (option->get_group().empty()) continue;  // it is refused
    for (const std::string& name : option->get_lnames()) names.push_back("--" + name);
  }
  return names;
}

bool looks_like_option(const std::string& word) {
  return word.size() > 1 && word[0] == '-' && std::isdigit(static_cast<unsigned char>(word[1])) == 0 && word[1] != '.';
}

struct Word {
  std::string text;
  std::size_t values = 0;  // further words that belong to it
  bool known = false;
};

// A word that begins with '-': the long or short name of an option, perhaps with its value.
Word option_word(const CLI::App& command, const std::string& word) {
  const bool is_long = word.starts_with("--");
  const std::string name = is_long ? word.substr(0, word.find('=')) : word.substr(0, 2);
  const CLI::Option* option = command.get_option_no_throw(name);
  if (option == nullptr) return {is_long ? name : word, 0, false};
  const bool has_value = name.size() < word.size();
  return {name, has_value || option->get_items_expected_min() == 0 ? 0u : 1u, true};
}

// The first option in `words` (from the second on) that the command does not have.
std::optional<std::string> unknown_option(const CLI::App& command, const std::vector<std::string>& words) {
  for (std::size_t i = 1; i < words.size(); ++i) {
    if (words[i] == "--") return {};
    if (!looks_like_option(words[i])) continue;
    const Word word = option_word(command, words[i]);
    if (!word.known) return word.text;
    i += word.values;
  }
  return {};
}

std::string without(std::string text, const std::string& end) {
  const auto at = text.find(end);
  return at == std::string::npos ? text : text.substr(0, at);
}

// The words of CLI11 for the errors that are left, in other words.
std::string in_plain_words(const CLI::ParseError& refusal) {
  const std::string text = refusal.what();
  if (dynamic_cast<const CLI::RequiredError*>(&refusal) != nullptr)
    return without(text, " is required") + " is missing";
  if (const std::string between = " excludes "; dynamic_cast<const CLI::ExcludesError*>(&refusal) != nullptr) {
    const auto at = text.find(between);
    if (at != std::string::npos)
      return text.substr(0, at) + " and " + text.substr(at + between.size()) + " cannot be given together";
  }
  if (dynamic_cast<const CLI::ArgumentMismatch*>(&refusal) != nullptr && text.find(": ") != std::string::npos)
    return without(text, ": ") + " needs one value";
  const auto colon = text.find(": ");
  if (dynamic_cast<const CLI::ValidationError*>(&refusal) != nullptr && colon != std::string::npos)
    return text.substr(0, colon) + text.substr(colon + 1);
  return text;
}

// The option that may be missing before a single word too many.
std::string missing_option(const CLI::App& command, const std::string& word) {
  if (word == "%") return " (write a percentage without a blank, as 5%)";
  if (looks_like_option(word)) return {};
  const auto has = [&command](const char* option) { return command.get_option_no_throw(option) != nullptr; };
  const std::string suffix = io::content_suffix(word);
  const bool is_mesh = suffix == ".ply" || suffix == ".obj" || suffix == ".off" || suffix == ".stl";
  if (has("--mesh") && (is_mesh || !has("--output"))) return " (did you mean --mesh " + word + "?)";
  return has("--output") && !is_mesh ? " (did you mean -o " + word + "?)" : "";
}

// The text of CLI11 has them from the last to the first, with the -- before words that are not options.
std::string unexpected_arguments(const CLI::App& command) {
  std::vector<std::string> extras = command.remaining();
  if (const auto dashes = std::ranges::find(extras, "--"); dashes != extras.end()) extras.erase(dashes);
  std::string text = extras.size() == 1 ? "unexpected argument:" : "unexpected arguments:";
  for (const std::string& word : extras) text += " " + word;
  return extras.size() == 1 ? text + missing_option(command, extras[0]) : text;
}

// What the user may have meant as the output that is missing.
std::string meant_output(const std::vector<std::string>& words, const std::string& error) {
  const std::string& last = words.back();
  const bool is_output = words.size() > 2 && words[0] == "glue" && !looks_like_option(last) && last.ends_with(".reeb");
  return is_output && error == "--output is missing" ? " (did you mean -o " + last + "?)" : "";
}

}  // namespace

std::optional<Error> missing_value(const CLI::App& program, const std::vector<std::string>& words) {
  const CLI::App* command = words.empty() ? nullptr : find_command(program, words[0]);
  if (command == nullptr) return {};
  for (std::size_t i = 1; i + 1 < words.size(); ++i) {
    if (words[i] == "--") return {};
    if (!looks_like_option(words[i])) continue;
    const Word word = option_word(*command, words[i]);
    if (!word.known || word.values == 0) continue;
    const std::string& value = words[i + 1];
    if (looks_like_option(value) && command->get_option_no_throw(value.substr(0, value.find('='))) != nullptr)
      return Error(ErrorKind::kUsage, command->get_option_no_throw(word.text)->get_name() + " needs one value",
                   "see `" + program.get_name() + " " + words[0] + " --help`");
    ++i;
  }
  return {};
}

const CLI::App* find_command(const CLI::App& program, const std::string& name) {
  const auto found = program.get_subcommands([&](const CLI::App* command) { return command->get_name() == name; });
  return found.empty() ? nullptr : found.front();
}

Error usage_error(const CLI::App& program, const std::vector<std::string>& words, const CLI::ParseError& refusal) {
  const CLI::App* command = words.empty() ? nullptr : find_command(program, words[0]);
  if (command == nullptr)
    return {ErrorKind::kUsage, in_plain_words(refusal), "see `" + program.get_name() + " --help`"};
  const std::string help = "`" + program.get_name() + " " + words[0] + " --help`";
  if (const auto option = unknown_option(*command, words)) {
    const std::vector<std::string> without_command = long_names(program);
    if (std::ranges::find(without_command, *option) != without_command.end())
      return {ErrorKind::kUsage, *option + " is an option of the program, not of a command",
              "`" + program.get_name() + " " + *option + "`"};
    std::vector<std::string> names = long_names(*command);
    names.insert(names.end(), without_command.begin(), without_command.end());
    const std::string near = nearest(*option, names);
    // An option alone need not be meant for the default command.
    const std::string also =
        words.size() == 2 && words[0] == "compute" ? "`" + program.get_name() + " --help` and " : "";
    return {ErrorKind::kUsage, "unknown option " + *option + (near.empty() ? "" : " (did you mean " + near + "?)"),
            "see " + also + help};
  }
  const bool has_extras = dynamic_cast<const CLI::ExtrasError*>(&refusal) != nullptr;
  std::string text = has_extras ? unexpected_arguments(*command) : in_plain_words(refusal);
  text += meant_output(words, text);
  return {ErrorKind::kUsage, text, "see " + help};
}

}  // namespace reeb::tools
