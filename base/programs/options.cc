#include "base/programs/options.h"

#include <fmt/format.h>
#include <fmt/ranges.h>
#include <toml++/toml.h>

#include <CLI/CLI.hpp>
#include <charconv>
#include <cstdlib>
#include <limits>
#include <locale>
#include <memory>
#include <sstream>
#include <type_traits>

#include "base/errors/errors.h"
#include "base/files/toml_file.h"

namespace glint {
namespace {

template <class T>
struct IsList : std::false_type {};
template <class T>
struct IsList<std::vector<T>> : std::true_type {};

std::string Joined(const std::vector<std::string>& words) {
  std::string text;
  for (const std::string& word : words) text += (text.empty() ? "" : ", ") + word;
  return text;
}

// Each word a number, or numbers with an x between them, as people write sizes: 100x80.
std::vector<double> NumbersIn(const std::vector<std::string>& words) {
  std::vector<double> numbers;
  for (const std::string& word : words) {
    std::string parts = word;
    for (const std::string times : {"×", "x", "X"}) {
      for (size_t at = parts.find(times); at != std::string::npos; at = parts.find(times)) {
        parts.replace(at, times.size(), " ");
      }
    }
    std::istringstream stream(parts);
    stream.imbue(std::locale::classic());
    for (std::string part; stream >> part;) {
      double number = 0;
      const auto [end, error] = std::from_chars(part.data(), part.data() + part.size(), number);
      if (error != std::errc() || end != part.data() + part.size()) {
        throw CLI::ConversionError("'" + word + "' is not a number");
      }
      numbers.push_back(number);
    }
  }
  return numbers;
}

std::string NumberText(double value) {
  std::ostringstream text;
  text << value;
  return text.str();
}

[[noreturn]] void Reject(const toml::node& node, const TomlPlace& place,
                         const std::string& wanted) {
  throw UserError(place.file, place.Field(node), DescribeToml(node), "give " + wanted);
}

// One overload a target type: reads `node` into *target or rejects it.
void ReadInto(const toml::node& node, const TomlPlace& place, bool* target) {
  if (!node.is_boolean()) Reject(node, place, "true or false");
  *target = node.as_boolean()->get();
}
void ReadInto(const toml::node& node, const TomlPlace& place, int* target) {
  if (!node.is_integer()) Reject(node, place, "a whole number");
  const auto value = node.as_integer()->get();
  if (value < std::numeric_limits<int>::min() || value > std::numeric_limits<int>::max()) {
    Reject(node, place, "a whole number of at most 2147483647");
  }
  *target = static_cast<int>(value);
}
void ReadInto(const toml::node& node, const TomlPlace& place, std::uint64_t* target) {
  if (!node.is_integer() || node.as_integer()->get() < 0) {
    Reject(node, place, "a whole number of at least 0");
  }
  *target = static_cast<std::uint64_t>(node.as_integer()->get());
}
void ReadInto(const toml::node& node, const TomlPlace& place, double* target) {
  const auto value = node.value<double>();
  if (!node.is_number() || !value) Reject(node, place, "a number");
  *target = *value;
}
void ReadInto(const toml::node& node, const TomlPlace& place, std::string* target) {
  if (!node.is_string()) Reject(node, place, "text in quotes");
  *target = node.as_string()->get();
}
void ReadInto(const toml::node& node, const TomlPlace& place, std::filesystem::path* target) {
  if (!node.is_string()) Reject(node, place, "a path in quotes");
  const std::filesystem::path path = node.as_string()->get();
  // Paths in a capture.toml are relative to its folder.
  *target = path.is_absolute() || path.empty() ? path : place.file.parent_path() / path;
}
template <class T>
void ReadInto(const toml::node& node, const TomlPlace& place, std::vector<T>* target) {
  if (!node.is_array()) Reject(node, place, "a list in square brackets");
  target->clear();
  for (const toml::node& element : *node.as_array()) {
    T value{};
    ReadInto(element, place, &value);
    target->push_back(value);
  }
}

// "verbose" of "verbose,-v".
std::string OneName(const std::string& names) { return names.substr(0, names.find(',')); }

std::string KindOf(const OptionSet::Target& target) {
  constexpr const char* kKinds[] = {"flag", "integer", "integer", "number",
                                    "text", "path",    "texts",   "numbers"};
  return kKinds[target.index()];  // in the order of OptionSet::Target
}

// Empty where there is none to tell a person: nothing chosen, or a flag that is off.
std::string DefaultText(const OptionSet::Target& target) {
  return std::visit(
      [](const auto* value) -> std::string {
        using T = std::remove_cv_t<std::remove_pointer_t<decltype(value)>>;
        if constexpr (std::is_same_v<T, bool>) {
          return *value ? "on" : "";
        } else if constexpr (std::is_same_v<T, std::filesystem::path>) {
          return value->string();
        } else if constexpr (IsList<T>::value) {
          return "";
        } else if constexpr (std::is_same_v<T, std::string>) {
          return *value;
        } else {
          return fmt::format("{}", *value);
        }
      },
      target);
}

// " (0 to 1000; default 8)"
template <class Option>
std::string Limits(const Option& option) {
  std::vector<std::string> parts;
  if (option.has_range) parts.push_back(fmt::format("{} to {}", option.low, option.high));
  const std::string value = DefaultText(option.target);
  if (!value.empty() && !option.positional) parts.push_back("default: " + value);
  if (parts.empty()) return "";
  return fmt::format(" ({})", fmt::join(parts, "; "));
}

// What gives the option this value on a command line.
template <class T>
std::string WordOf(const std::string& name, const T& value) {
  if constexpr (std::is_same_v<T, bool>) {
    return value ? "--" + name : "--no-" + name;
  } else if constexpr (std::is_same_v<T, std::filesystem::path>) {
    return fmt::format("--{}={}", name, std::filesystem::absolute(value).generic_string());
  } else if constexpr (IsList<T>::value) {
    // Not fmt::join, whose errors' class would bring the image libraries to programs without any.
    std::string words;
    for (const auto& one : value) words += (words.empty() ? "" : ",") + fmt::format("{}", one);
    return fmt::format("--{}={}", name, words);
  } else {
    return fmt::format("--{}={}", name, value);
  }
}

// The choices that a person can type: an empty one only stands for an option that is not given.
template <class Option>
std::vector<std::string> NamedChoices(const Option& option) {
  std::vector<std::string> named;
  for (const std::string& choice : option.choices) {
    if (!choice.empty()) named.push_back(choice);
  }
  return named;
}

// What stands after an option's name in the help.
template <class Option>
std::string Placeholder(const Option& option) {
  if (!option.choices.empty()) return fmt::format("{}", fmt::join(NamedChoices(option), "|"));
  constexpr const char* kWords[] = {"",     "N",    "N",        "NUMBER",
                                    "TEXT", "PATH", "TEXT,...", "NUMBER,..."};
  return kWords[option.target.index()];
}

}  // namespace

void OptionSet::Add(const std::string& name, Target target, const std::string& help,
                    Invalidates invalidates) {
  Option option;
  option.name = name;
  option.target = target;
  option.help = help;
  option.invalidates = invalidates;
  options_.push_back(std::move(option));
}

void OptionSet::AddChoice(const std::string& name, std::string* target,
                          std::vector<std::string> choices, const std::string& help,
                          Invalidates invalidates) {
  Add(name, target, help, invalidates);
  options_.back().choices = std::move(choices);
}

void OptionSet::AddRange(const std::string& name, Target target, double low, double high,
                         const std::string& help, Invalidates invalidates) {
  Add(name, target, help, invalidates);
  options_.back().low = low;
  options_.back().high = high;
  options_.back().has_range = true;
}

void OptionSet::AddPositional(const std::string& name, Target target, const std::string& help,
                              bool required) {
  Add(name, target, help, Invalidates::kNo);
  options_.back().positional = true;
  options_.back().required = required;
}

void OptionSet::Register(CLI::App* app, const std::string& group) {
  for (Option& option : options_) {
    const std::string flag = option.positional ? option.name : "--" + option.name;
    const std::string help = option.help + Limits(option);
    CLI::Option* registered = std::visit(
        [&](auto* target) -> CLI::Option* {
          using T = std::remove_pointer_t<decltype(target)>;
          CLI::Option* added = nullptr;
          if constexpr (std::is_same_v<T, bool>) {
            added = app->add_flag(flag + ",!--no-" + OneName(option.name), *target, help);
          } else if constexpr (std::is_same_v<T, std::filesystem::path>) {
            added = app->add_option_function<std::string>(
                flag, [target](const std::string& text) { *target = text; }, help);
          } else if constexpr (std::is_same_v<T, std::vector<double>>) {
            const auto parse = [target](const std::vector<std::string>& words) {
              *target = NumbersIn(words);
            };
            added = app->add_option_function<std::vector<std::string>>(flag, parse, help);
            if (!option.positional) added->delimiter(',');
          } else {
            added = app->add_option(flag, *target, help);
            if constexpr (IsList<T>::value) {
              if (!option.positional) added->delimiter(',');
            }
          }
          return added;
        },
        option.target);
    if (option.required) registered->required();
    registered->group(group);
    if (!option.choices.empty()) registered->check(CLI::IsMember(option.choices));
    if (option.has_range) registered->check(CLI::Range(option.low, option.high));
    if (!std::holds_alternative<bool*>(option.target) && !option.positional) {
      registered->option_text(Placeholder(option));
    }
    option.set_on_command_line = [registered] { return registered->count() > 0; };
  }
}

Json OptionSet::Describe() const {
  Json list = Json::array();
  for (const Option& option : options_) {
    Json described = {{"name", OneName(option.name)},
                      {"help", option.help},
                      {"kind", KindOf(option.target)},
                      {"positional", option.positional}};
    if (!option.choices.empty()) described["choices"] = NamedChoices(option);
    if (option.has_range) described.update({{"low", option.low}, {"high", option.high}});
    if (const std::string text = DefaultText(option.target); !text.empty()) {
      described["default"] = text;
    }
    list.push_back(std::move(described));
  }
  return list;
}

void OptionSet::LoadToml(const std::filesystem::path& file, const std::string& table) {
  const auto document = ReadTomlFile(file);
  const toml::node* node = document->get(table);
  if (node == nullptr) return;
  if (!node->is_table()) {
    throw UserError(file, table, DescribeToml(*node), "write a table: [" + table + "]");
  }
  for (const auto& [key, value] : *node->as_table()) {
    const TomlPlace place{file, table + "." + std::string(key.str())};
    Option* found = nullptr;
    std::vector<std::string> known;
    for (Option& option : options_) {
      if (option.positional) continue;
      known.push_back(option.name);
      if (option.name == key.str()) found = &option;
    }
    if (found == nullptr) {
      throw UserError(file, place.Field(value), "an unknown key", "use one of: " + Joined(known));
    }
    if (found->set_on_command_line && found->set_on_command_line()) continue;
    // Captured by name, as clang before 16 needs it.
    std::visit([&place, &node = value](auto* target) { ReadInto(node, place, target); },
               found->target);
    if (!found->choices.empty()) {
      const std::string& text = *std::get<std::string*>(found->target);
      if (std::find(found->choices.begin(), found->choices.end(), text) == found->choices.end()) {
        throw UserError(file, place.Field(value), "'" + text + "'",
                        "use one of: " + Joined(found->choices));
      }
    }
    if (found->has_range) {
      const double number = value.value<double>().value_or(0);
      if (!(number >= found->low && number <= found->high)) {
        throw UserError(
            file, place.Field(value), NumberText(number),
            "use a value from " + NumberText(found->low) + " to " + NumberText(found->high));
      }
    }
  }
}

Json OptionSet::Echo(Invalidates which) const {
  Json echo = Json::object();
  for (const Option& option : options_) {
    if (option.positional || option.invalidates != which) continue;
    std::visit(
        [&](auto* target) {
          if constexpr (std::is_same_v<std::remove_pointer_t<decltype(target)>,
                                       std::filesystem::path>) {
            // Where a file lies is no part of a result; its content is, among the inputs.
            echo[option.name] = target->filename().generic_string();
          } else {
            echo[option.name] = *target;
          }
        },
        option.target);
  }
  return echo;
}

Json OptionSet::CommandLineEcho() const {
  const char* names = std::getenv(kRunOptionsVariable);
  const std::string by_run = names == nullptr ? "" : fmt::format(",{},", names);
  Json echo = Json::object();
  for (const Option& option : options_) {
    const std::string name = OneName(option.name);
    if (option.positional || option.invalidates != Invalidates::kYes) continue;
    if (!option.set_on_command_line || !option.set_on_command_line()) continue;
    if (by_run.find("," + name + ",") != std::string::npos) continue;
    echo[name] =
        std::visit([&name](const auto* target) { return WordOf(name, *target); }, option.target);
  }
  return echo;
}

Json OptionSet::ManifestEcho() const { return Echo(Invalidates::kYes); }
Json OptionSet::RunEcho() const { return Echo(Invalidates::kNo); }

}  // namespace glint
