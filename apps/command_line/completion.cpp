// Completions and manual pages out of what the commands declare, so that they cannot say anything else than the help does.
#include "completion.h"

#include <cctype>
#include <filesystem>
#include <iterator>

#include <fmt/format.h>

#include "marey/files/whole_file.h"

#include "declared.h"

namespace marey::cli {

/// The path to the declaration of a command.
struct DeclaredOf {
  static const Command::Declared& get(const Command& command) { return *command.declared_; }
};

namespace {

using Declared = Command::Declared;

std::string joined(const std::vector<std::string>& words, const char* between = " ") {
  return CLI::detail::join(words, between);
}

/// "--rate", "-o": what begins with a dash.
std::vector<std::string> dashed(const CLI::Option& option) {
  std::vector<std::string> names;
  for (const std::string& name : option.get_snames()) names.push_back(std::string("-").append(name));
  for (const std::string& name : option.get_lnames()) names.push_back(std::string("--").append(name));
  return names;
}

bool takes_file(const CLI::Option& option) {
  return option.get_type_name() == "FILE" || option.get_type_name() == "FOLDER";
}

/// The names after the last colon of a choice's meaning; none of any other option.
std::vector<std::string> choices_of(const CLI::Option& option) {
  if (option.get_type_name() != "NAME") return {};
  const std::string meaning = option.get_description();
  std::vector<std::string> names;
  std::size_t begin = meaning.rfind(": ");
  while (begin != std::string::npos && begin < meaning.size()) {
    const std::size_t start = begin + 2, end = meaning.find(", ", start);
    names.push_back(meaning.substr(start, end == std::string::npos ? end : end - start));
    begin = end;
  }
  return names;
}

template <typename Visit>
void visit(const Declared& command, const Visit& what) {
  what(command);
  for (const auto& below : command.below) visit(*below, what);
}

std::vector<std::string> names_below(const Declared& command) {
  std::vector<std::string> names;
  for (const auto& below : command.below) names.push_back(below->app->get_name());
  return names;
}

std::vector<std::string> all_options(const Declared& command) {
  std::vector<std::string> names;
  for (const CLI::Option* option : command.app->get_options()) {
    for (std::string& name : dashed(*option)) names.push_back(std::move(name));
  }
  return names;
}

std::string underlined(std::string text) {
  for (char& c : text) c = c == ' ' || c == '-' ? '_' : c;
  return text;
}

// ---- bash

/// The words that have been typed choose the command; what stands before the cursor, an option's values.
std::string bash(const Declared& root) {
  std::string text =
      "# bash completion for marey; made by `marey completion bash`.\n_marey() {\n  local current=${COMP_WORDS[COMP_CWORD]} "
      "previous=${COMP_WORDS[COMP_CWORD-1]} command=marey word\n  COMPREPLY=()\n"
      "  for word in \"${COMP_WORDS[@]:1:COMP_CWORD-1}\"; do\n    case \"$command $word\" in\n";
  auto out = std::back_inserter(text);
  visit(root, [&](const Declared& command) {
    for (const auto& below : command.below) fmt::format_to(out, "      \"{}\") command=\"{}\" ;;\n", below->path(), below->path());
  });
  text += "    esac\n  done\n  case \"$command $previous\" in\n";
  visit(root, [&](const Declared& command) {
    for (const CLI::Option* option : command.app->get_options()) {
      const std::vector<std::string> names = dashed(*option), choices = choices_of(*option);
      if (names.empty() || choices.empty()) continue;
      std::vector<std::string> patterns;
      for (const std::string& name : names) patterns.push_back(fmt::format("\"{} {}\"", command.path(), name));
      fmt::format_to(out, "    {}) COMPREPLY=($(compgen -W \"{}\" -- \"$current\")); return ;;\n", joined(patterns, "|"),
                     joined(choices));
    }
  });
  text += "  esac\n  local words=\n  case \"$command\" in\n";
  visit(root, [&](const Declared& command) {
    std::vector<std::string> words = names_below(command);
    for (std::string& option : all_options(command)) words.push_back(std::move(option));
    fmt::format_to(out, "    \"{}\") words=\"{}\" ;;\n", command.path(), joined(words));
  });
  text +=
      "  esac\n  COMPREPLY=($(compgen -W \"$words\" -- \"$current\"))\n"
      "  [[ $current == -* ]] || COMPREPLY+=($(compgen -f -- \"$current\"))\n}\ncomplete -o filenames -F _marey marey\n";
  return text;
}

// ---- zsh

/// Within _arguments' brackets, in single quotes.
std::string for_zsh(const std::string& meaning) {
  std::string text;
  for (const char c : meaning) {
    if (c == '\'') {
      text += "'\\''";
    } else if (c == '[' || c == ']' || c == ':' || c == '\\') {
      text += std::string("\\") + c;
    } else {
      text += c;
    }
  }
  return text;
}

std::string zsh(const Declared& root) {
  std::string text = "#compdef marey\n# zsh completion for marey; made by `marey completion zsh`.\n";
  auto out = std::back_inserter(text);
  visit(root, [&](const Declared& command) {
    fmt::format_to(out, "_{}() {{\n  local state line\n  _arguments -C \\\n", underlined(command.path()));
    for (const CLI::Option* option : command.app->get_options()) {
      const std::vector<std::string> choices = choices_of(*option);
      const std::string value = option->get_type_size() == 0 ? ""
                                : !choices.empty()           ? ":value:(" + joined(choices) + ")"
                                : takes_file(*option)        ? ":file:_files"
                                                             : ":value:";
      for (const std::string& name : dashed(*option))
        fmt::format_to(out, "    '{}[{}]{}' \\\n", name, for_zsh(option->get_description()), value);
    }
    if (command.below.empty()) {
      text += "    '*:file:_files'\n}\n";
      return;
    }
    text += "    '1:command:->command' '*::argument:->rest'\n  case $state in\n    command) local -a commands=(\n";
    for (const auto& below : command.below)
      fmt::format_to(out, "      '{}:{}'\n", below->app->get_name(), for_zsh(below->app->get_description()));
    text += "    ); _describe command commands ;;\n    rest) case $line[1] in\n";
    for (const auto& below : command.below)
      fmt::format_to(out, "      {}) _{} ;;\n", below->app->get_name(), underlined(below->path()));
    text += "    esac ;;\n  esac\n}\n";
  });
  return text + "_marey \"$@\"\n";
}

// ---- fish

std::string for_fish(const std::string& text) {
  std::string out;
  for (const char c : text) out += c == '\'' || c == '\\' ? std::string("\\") + c : std::string(1, c);
  return fmt::format("'{}'", out);
}

/// When the words so far are this command's path, and no command below it was named.
std::string fish_condition(const Declared& command) {
  std::string text;
  const std::string path = command.path();
  for (std::size_t begin = path.find(' '); begin != std::string::npos;) {
    const std::size_t end = path.find(' ', begin + 1);
    text += "__fish_seen_subcommand_from " + path.substr(begin + 1, end == std::string::npos ? end : end - begin - 1) + "; and ";
    begin = end;
  }
  if (command.below.empty()) return text.empty() ? "true" : text.substr(0, text.size() - 6);
  return text + "not __fish_seen_subcommand_from " + joined(names_below(command));
}

std::string fish(const Declared& root) {
  std::string text = "# fish completion for marey; made by `marey completion fish`.\n";
  auto out = std::back_inserter(text);
  visit(root, [&](const Declared& command) {
    const std::string when = for_fish(fish_condition(command));
    for (const auto& below : command.below)
      fmt::format_to(out, "complete -c marey -f -n {} -a {} -d {}\n", when, below->app->get_name(),
                     for_fish(below->app->get_description()));
    for (const CLI::Option* option : command.app->get_options()) {
      if (dashed(*option).empty()) continue;
      std::string names;
      for (const std::string& name : option->get_snames()) names += " -s " + name;
      for (const std::string& name : option->get_lnames()) names += " -l " + name;
      const std::vector<std::string> choices = choices_of(*option);
      const std::string value = option->get_type_size() == 0 ? ""
                                : !choices.empty()           ? " -x -a " + for_fish(joined(choices))
                                : takes_file(*option)        ? " -r"
                                                             : " -x";
      fmt::format_to(out, "complete -c marey -n {}{}{} -d {}\n", when, names, value, for_fish(option->get_description()));
    }
  });
  return text;
}

// ---- manual pages

/// A line that does not begin with what troff takes for a command.
std::string for_troff(const std::string& text) {
  std::string out;
  for (const char c : text) {
    if (c == '\\') {
      out += "\\e";
    } else if (c == '-') {
      out += "\\-";
    } else {
      out += c;
    }
  }
  return out.starts_with('.') || out.starts_with('\'') ? std::string("\\&").append(out) : out;
}

std::string value_of(const CLI::Option& option) {
  return option.get_type_size() == 0 ? "" : fmt::format(" \\fI{}\\fR", for_troff(option.get_type_name()));
}

std::string page_of(const Declared& command) {
  const std::string path = command.path();
  std::string dashed_path = path;
  for (char& c : dashed_path) c = c == ' ' ? '-' : c;
  std::string title = dashed_path;
  for (char& c : title) c = static_cast<char>(std::toupper(static_cast<unsigned char>(c)));
  std::string text = fmt::format(".TH {} 1 \"\" \"Marey\" \"User Commands\"\n.SH NAME\n{} \\- {}\n.SH SYNOPSIS\n.B {}\n", title,
                                 for_troff(dashed_path), for_troff(command.app->get_description()), for_troff(path));
  auto out = std::back_inserter(text);
  for (const CLI::Option* option : command.app->get_options()) {
    if (dashed(*option).empty()) fmt::format_to(out, "[\\fI{}\\fR]\n", for_troff(option->get_name()));
  }
  text += command.below.empty() ? "[\\fIOPTIONS\\fR]\n" : "\\fICOMMAND\\fR\n";
  if (!command.below.empty()) {
    text += ".SH COMMANDS\n";
    for (const auto& below : command.below)
      fmt::format_to(out, ".TP\n.B {}\n{}\n", for_troff(below->path()), for_troff(below->app->get_description()));
  }
  text += ".SH OPTIONS\n";
  for (const CLI::Option* option : command.app->get_options()) {
    const std::vector<std::string> names = dashed(*option);
    fmt::format_to(out, ".TP\n.B {}{}\n{}", for_troff(names.empty() ? option->get_name() : joined(names, ", ")),
                   names.empty() ? "" : value_of(*option), for_troff(option->get_description()));
    if (!option->get_default_str().empty()) fmt::format_to(out, " (default: {})", for_troff(option->get_default_str()));
    text += '\n';
  }
  text += ".SH EXIT STATUS\n0: done. 1: the outside world failed, one sentence on standard error. 2: wrong usage. 130: stopped.\n";
  return text;
}

}  // namespace

std::string completion_for(const Command& root, const std::string& shell) {
  const Declared& declared = DeclaredOf::get(root);
  if (shell == "bash") return bash(declared);
  if (shell == "zsh") return zsh(declared);
  if (shell == "fish") return fish(declared);
  throw WrongUsage("\"{}\" is not a shell that is known; supported: bash, zsh, fish", shell);
}

void write_manual(const Command& root, const std::string& folder) {
  std::error_code error;
  std::filesystem::create_directories(folder, error);
  if (error) throw Error("{}: this folder cannot be made ({})", folder, error.message());
  visit(DeclaredOf::get(root), [&](const Declared& command) {
    std::string name = command.path() + ".1";
    for (char& c : name) c = c == ' ' ? '-' : c;
    WholeFile file((std::filesystem::path(folder) / name).string());
    file.write(page_of(command));
    file.finish();
  });
}

}  // namespace marey::cli
