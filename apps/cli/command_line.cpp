#include "command_line.h"

#include <cctype>
#include <cerrno>
#include <cstdio>
#include <cstring>
#include <map>
#include <system_error>

#include <CLI/CLI.hpp>

#include "file_checks.h"
#include "process_options.h"
#include "spelling.h"

namespace marey::cli {
namespace {

/// Options that were called otherwise once.
struct Renamed {
  const char *before, *now;
};
constexpr std::array<Renamed, 2> kRenamed{{{"--out", "--output"}, {"--in-step", "--synced"}}};

/// Help in one notation: "--rate HZ in (0, 1e6] (25)".
class HelpText : public CLI::Formatter {
 public:
  HelpText() { column_width(38); }

  std::string make_option_opts(const CLI::Option* option) const override {
    if (option->get_type_size() == 0) return {};
    std::string text = " " + option->get_type_name();
    if (option->get_expected_min() > 1) text += " x " + std::to_string(option->get_expected_min());
    if (!option->get_default_str().empty()) text += " (" + option->get_default_str() + ")";
    if (option->get_expected_max() == CLI::detail::expected_max_vector_size) text += " ...";
    if (option->get_required()) text += " REQUIRED";
    return text;
  }
};

/// The program or a group of commands was named without the command that is wanted.
struct CommandMissing {
  std::string help;
};

std::map<std::string, std::string> asked_for;  // of the command that runs

void say(const char* sentence) {
  fmt::print(stderr, "marey: {}\n", sentence);
}

}  // namespace

struct Option::Declared {
  CLI::Option* parsed = nullptr;
  std::string name;
  std::vector<Check> checks;
  std::function<std::vector<std::string>()> inputs, outputs;
  const Declared* may_replace = nullptr;

  void take(const std::string& text, const Check& use) const {
    try {
      for (const Check& check : checks) check(text);
      use(text);
    } catch (const Error& error) {
      throw WrongUsage("{}: {}", name, error.what());
    }
  }
};

struct Command::Declared {
  CLI::App* app = nullptr;
  std::string group;
  std::vector<std::unique_ptr<Option::Declared>> options;
  std::vector<std::unique_ptr<Declared>> below;
  std::vector<Paths> reads, writes;
  std::function<void()> run;
  const bool* json = nullptr;

  /// An option that is given `count` values, or with 0 any number; `use` is called for each with its index.
  Option::Declared& declare(const std::string& name, const std::string& meaning, const std::string& type, int count,
                            std::function<void(int, const std::string&)> use) {
    auto option = std::make_unique<Option::Declared>();
    option->name = name.substr(name.find(',') == std::string::npos ? 0 : name.find(',') + 1);
    option->parsed = app->add_option(
        name,
        [its = option.get(), use = std::move(use)](const CLI::results_t& texts) {
          int index = 0;
          for (const std::string& text : texts) its->take(text, [&](const std::string& taken) { use(index++, taken); });
          return true;
        },
        meaning);
    if (count > 0) option->parsed->expected(count);
    if (count == 0) option->parsed->expected(1, CLI::detail::expected_max_vector_size)->allow_extra_args();
    option->parsed->type_name(type);
    return add(std::move(option));
  }

  Option::Declared& add(std::unique_ptr<Option::Declared> option) {
    if (!group.empty()) option->parsed->group(group);
    options.push_back(std::move(option));
    return *options.back();
  }

  /// The command that the words name. Throws WrongUsage for one, or an option, that there is not, and names the nearest.
  Declared& named_by(const std::vector<std::string>& words);
  Declared& child(const std::string& word);
  const CLI::Option& option(const std::string& name) const;

  std::string path() const {
    std::string text = app->get_name();
    for (const CLI::App* above = app->get_parent(); above != nullptr; above = above->get_parent())
      text = above->get_name() + " " + text;
    return text;
  }

  void check_its_files() const;
  std::map<std::string, std::string> given() const;
};

struct Program::Parser {
  CLI::App app;
  Command::Declared program;
};

// ---- options

Option& Option::required() {
  declared_->parsed->required();
  return *this;
}

Option& Option::needs(const Option& other) {
  declared_->parsed->needs(other.declared_->parsed);
  return *this;
}

Option& Option::excludes(const Option& other) {
  declared_->parsed->excludes(other.declared_->parsed);
  return *this;
}

Option& Option::check(Check check) {
  declared_->checks.push_back(std::move(check));
  return *this;
}

Option& Option::ends_in(std::vector<std::string> endings) {
  return check([endings = std::move(endings)](const std::string& text) {
    const auto fits = [&](const std::string& ending) { return CLI::detail::to_lower(text).ends_with(ending); };
    if (is_stream(text) || std::any_of(endings.begin(), endings.end(), fits)) return;
    throw Error("{}: its ending says another format than what is written; name a file that ends in {}", text,
                CLI::detail::join(endings, " or "));
  });
}

Option& Option::may_replace(const Option& input) {
  declared_->may_replace = input.declared_;
  return *this;
}

// ---- commands

Command Command::subcommand(const std::string& name, const std::string& meaning) {
  auto below = std::make_unique<Declared>();
  below->app = declared_->app->add_subcommand(name, meaning);
  below->app->group("Commands");
  declared_->below.push_back(std::move(below));
  return Command(*declared_->below.back());
}

void Command::group(const std::string& title) {
  declared_->group = title;
}

Option Command::text(const std::string& name, std::string& value, const std::string& meaning) {
  Option::Declared& option = declared_->declare(name, meaning, "TEXT", 1, [&value](int, const std::string& text) { value = text; });
  option.parsed->default_str(value);
  return Option(option);
}

Option Command::texts(const std::string& name, std::vector<std::string>& values, const std::string& meaning) {
  return Option(declared_->declare(name, meaning, "TEXT", 0, [&values](int, const std::string& text) { values.push_back(text); }));
}

Option Command::flag(const std::string& name, bool& value, const std::string& meaning, bool on) {
  auto option = std::make_unique<Option::Declared>();
  option->name = name;
  option->parsed = declared_->app->add_flag_callback(name, [&value, on] { value = on; }, meaning);
  return Option(declared_->add(std::move(option)));
}

Option Command::add_number(const std::string& name, const std::string& usual, int count, const char* unit, const Interval& interval,
                           const std::string& meaning, std::function<void(int, double)> set) {
  Option::Declared& option =
      declared_->declare(name, meaning, fmt::format("{} in {}", unit, notation(interval)), count,
                         [=](int index, const std::string& text) { set(index, number_in(text, unit, interval)); });
  option.parsed->default_str(usual);
  return Option(option);
}

Option Command::add_whole(const std::string& name, const std::string& usual, int count, const char* unit, std::int64_t low,
                          std::int64_t high, const std::string& meaning, std::function<void(int, std::int64_t)> set) {
  Option::Declared& option =
      declared_->declare(name, meaning, fmt::format("{} in {}", unit, notation(low, high)), count,
                         [=](int index, const std::string& text) { set(index, whole_number_in(text, unit, low, high)); });
  option.parsed->default_str(usual);
  return Option(option);
}

Option Command::add_choice(const std::string& name, std::vector<std::string> names, const std::string& usual,
                           const std::string& meaning, std::function<void(std::size_t)> set) {
  const std::string listed = CLI::detail::join(names, ", ");
  Option::Declared& option =
      declared_->declare(name, meaning + ": " + listed, "NAME", 1, [=, set = std::move(set)](int, const std::string& text) {
        const auto chosen = std::find(names.begin(), names.end(), text);
        if (chosen == names.end()) throw Error("\"{}\" is not known; known are: {}.{}", text, listed, suggestion(text, names));
        set(static_cast<std::size_t>(chosen - names.begin()));
      });
  option.parsed->default_str(usual);
  return Option(option);
}

Option Command::input_file(const std::string& name, std::string& value, const std::string& meaning) {
  const Option option = text(name, value, meaning);
  option.declared_->parsed->type_name("FILE");
  option.declared_->inputs = [&value] { return std::vector{value}; };
  return option;
}

Option Command::input_files(const std::string& name, std::vector<std::string>& values, const std::string& meaning) {
  const Option option = texts(name, values, meaning);
  option.declared_->inputs = [&values] {
    std::vector<std::string> files;
    for (const std::string& value : values) files.push_back(value.substr(value.find('=') + 1));
    return files;
  };
  return option;
}

Option Command::output_file(const std::string& name, std::string& value, const std::string& meaning) {
  const Option option = text(name, value, meaning);
  option.declared_->parsed->type_name("FILE");
  option.declared_->outputs = [&value] { return std::vector{value}; };
  return option;
}

Option Command::output_folder(const std::string& name, std::string& value, const std::string& meaning) {
  const Option option = output_file(name, value, meaning);
  option.declared_->parsed->type_name("FOLDER");
  return option;
}

void Command::also_reads(Paths paths) {
  declared_->reads.push_back(std::move(paths));
}

void Command::also_writes(Paths paths) {
  declared_->writes.push_back(std::move(paths));
}

void Command::reports(bool& json, bool& quiet, const std::string& what) {
  declared_->group.clear();
  flag("--json", json, "print the " + what + " as JSON on standard output");
  flag("-q,--quiet", quiet, "no progress and no " + what + "; warnings and JSON stay");
  add_process_options(*this);
  declared_->json = &json;
}

void Command::runs(std::function<void()> run) {
  declared_->run = std::move(run);
}

void Command::Declared::check_its_files() const {
  std::vector<NamedPath> inputs, outputs;
  const auto first = [](const std::function<std::vector<std::string>()>& paths) {
    const std::vector<std::string> files = paths ? paths() : std::vector<std::string>{};
    return files.empty() ? std::string() : files.front();
  };
  for (const auto& option : options) {
    if (option->inputs) {
      for (const std::string& path : option->inputs()) inputs.push_back({option->name, path, {}});
    }
    if (!option->outputs) continue;
    const std::string path = first(option->outputs);
    outputs.push_back({option->name, path, option->may_replace != nullptr ? first(option->may_replace->inputs) : ""});
    if (json != nullptr && *json && (path == "-" || path == "/dev/stdout"))
      throw WrongUsage("{} {} and --json both go to standard output; name a file", option->name, path);
  }
  const auto add = [](std::vector<NamedPath>& to, const std::vector<Paths>& from, const char* name) {
    for (const Paths& paths : from) {
      try {
        for (const std::string& path : paths()) to.push_back({name, path, {}});
      } catch (const Error&) {
        return;  // the run meets it again, and says it
      }
    }
  };
  add(inputs, reads, "input");
  add(outputs, writes, "output");
  check_files(inputs, outputs);
}

// ---- words

Command::Declared& Command::Declared::child(const std::string& word) {
  std::vector<std::string> names;
  for (const auto& each : below) {
    if (each->app->get_name() == word) return *each;
    names.push_back(each->app->get_name());
  }
  throw WrongUsage("{} has no command \"{}\", but {}.{}", path(), word, CLI::detail::join(names, ", "), suggestion(word, names));
}

const CLI::Option& Command::Declared::option(const std::string& name) const {
  if (const CLI::Option* found = app->get_option_no_throw(name)) return *found;
  for (const Renamed& renamed : kRenamed) {
    if (name == renamed.before && app->get_option_no_throw(renamed.now) != nullptr)
      throw WrongUsage("{} is called {} now", name, renamed.now);
  }
  std::vector<std::string> names;
  for (const CLI::Option* each : app->get_options()) {
    for (const std::string& known : each->get_lnames()) names.push_back("--" + known);
  }
  throw WrongUsage("{} has no option {}; `{} --help` lists them.{}", path(), name, path(), suggestion(name, names));
}

Command::Declared& Command::Declared::named_by(const std::vector<std::string>& words) {
  Declared* at = this;
  for (std::size_t i = 0; i < words.size() && words[i] != "--"; ++i) {
    const std::string& word = words[i];
    if (word == "-h" || word == "--help" || word == "--version") return *at;
    const bool is_long = word.starts_with("--");
    const bool is_short = !is_long && word.size() > 1 && word[0] == '-' && std::isalpha(static_cast<unsigned char>(word[1])) != 0;
    if (is_long) {
      const CLI::Option& named = at->option(word.substr(0, word.find('=')));
      if (word.find('=') == std::string::npos) i += static_cast<std::size_t>(named.get_items_expected_min());
    } else if (is_short) {
      const CLI::Option& named = at->option(word.substr(0, 2));
      if (word.size() == 2) i += static_cast<std::size_t>(named.get_items_expected_min());
    } else if (!at->below.empty()) {
      at = &at->child(word);
    }
  }
  if (!at->below.empty()) throw CommandMissing{at->app->help()};
  return *at;
}

// ---- the program

/// What was asked for, by option, but for its files: those are told by name and hash.
std::map<std::string, std::string> Command::Declared::given() const {
  std::map<std::string, std::string> texts;
  for (const auto& option : options) {
    if (option->inputs || option->outputs || option->parsed->count() == 0) continue;
    const std::string longest = option->name.substr(option->name.find_last_of(',') + 1);
    if (longest == "--threads") continue;  // has no part in what comes out
    texts[longest.substr(longest.find_first_not_of('-'))] = CLI::detail::join(option->parsed->results(), " ");
  }
  return texts;
}

const std::map<std::string, std::string>& given_options() {
  return asked_for;
}

Program::Program(const std::string& name, const std::string& meaning) : parser_(std::make_unique<Parser>()) {
  parser_->app.name(name);
  parser_->app.description(meaning);
  parser_->app.formatter(std::make_shared<HelpText>());
  parser_->app.require_subcommand(0, 1);
  parser_->app.set_version_flag("--version", name + " " MAREY_VERSION);
  parser_->program.app = &parser_->app;
}

Program::~Program() = default;

Command Program::root() {
  return Command(parser_->program);
}

namespace {

/// The exit code, after the last byte of standard output: what it did not take was lost.
int finish(int code) {
  errno = 0;
  const bool lost = std::ferror(stdout) != 0 || std::fflush(stdout) != 0;
  const int reason = errno;
  if (!lost && std::fclose(stdout) == 0) return code;
  const std::string why = reason != 0 ? fmt::format(" ({})", std::strerror(reason)) : "";
  say(fmt::format("standard output: could not be written to the end{}", why).c_str());
  return code == 0 ? 1 : code;
}

}  // namespace

int Program::run(int argc, char** argv) {
  int code = 0;
  try {
    std::vector<std::string> words(argv + std::min(argc, 1), argv + argc);
    if (!words.empty() && words.front() == "help") {
      words.erase(words.begin());
      words.emplace_back("--help");
    }
    const Command::Declared& command = parser_->program.named_by(words);
    std::reverse(words.begin(), words.end());
    parser_->app.parse(words);
    command.check_its_files();
    asked_for = command.given();
    command.run();
  } catch (const EndWith& end) {
    code = end.code;
  } catch (const CommandMissing& missing) {
    fmt::print(stderr, "{}", missing.help);
    code = 2;
  } catch (const CLI::Success& said) {
    parser_->app.exit(said);
  } catch (const CLI::ParseError& error) {
    say(error.what());
    code = 2;
  } catch (const WrongUsage& error) {
    say(error.what());
    code = 2;
  } catch (const std::exception& error) {
    if (std::ferror(stdout) == 0) say(error.what());  // else `finish` says it
    code = 1;
  }
  return finish(code);
}

}  // namespace marey::cli
