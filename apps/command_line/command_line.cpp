#include "command_line.h"

#include <algorithm>

#include <fmt/format.h>

#include "marey/files/overwriting.h"

#include "declared.h"
#include "file_checks.h"
#include "process_options.h"
#include "spelling.h"

namespace marey::cli {

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

Option Command::add_number(const std::string& name, const std::string& typical, int count, const char* unit,
                           const Interval& interval, const std::string& meaning, std::function<void(int, double)> set) {
  Option::Declared& option =
      declared_->declare(name, meaning, fmt::format("{} in {}", unit, pipeline::jobs::notation(interval)), count,
                         [=](int index, const std::string& text) { set(index, number_in(text, unit, interval)); });
  option.parsed->default_str(typical);
  return Option(option);
}

Option Command::add_whole(const std::string& name, const std::string& typical, int count, const char* unit, std::int64_t low,
                          std::int64_t high, const std::string& meaning, std::function<void(int, std::int64_t)> set) {
  Option::Declared& option =
      declared_->declare(name, meaning, fmt::format("{} in {}", unit, pipeline::jobs::notation(low, high)), count,
                         [=](int index, const std::string& text) { set(index, whole_number_in(text, unit, low, high)); });
  option.parsed->default_str(typical);
  return Option(option);
}

Option Command::add_choice(const std::string& name, std::vector<std::string> names, const std::string& typical,
                           const std::string& meaning, std::function<void(std::size_t)> set) {
  const std::string listed = CLI::detail::join(names, ", ");
  Option::Declared& option =
      declared_->declare(name, meaning + ": " + listed, "NAME", 1, [=, set = std::move(set)](int, const std::string& text) {
        const auto chosen = std::find(names.begin(), names.end(), text);
        if (chosen == names.end()) throw Error("\"{}\" is not known; supported: {}.{}", text, listed, suggestion(text, names));
        set(static_cast<std::size_t>(chosen - names.begin()));
      });
  option.parsed->default_str(typical);
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

void Command::reports(bool& json, bool& quiet, const std::string& what, bool* markdown) {
  declared_->group.clear();
  const Option as_json = flag("--json", json, "print the " + what + " as JSON on standard output");
  if (markdown != nullptr) {
    flag("--markdown", *markdown, "print the " + what + " as a Markdown table, without times").excludes(as_json);
  }
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

}  // namespace marey::cli
