#pragma once

#include <deque>
#include <functional>
#include <map>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include <CLI/CLI.hpp>

#include "command_line.h"

// What a command's declaration is to the parser; for command_line.cpp and program.cpp alone.
namespace marey::cli {

struct Option::Declared {
  CLI::Option* parsed = nullptr;
  std::string name;
  std::vector<Check> checks;
  std::function<std::vector<std::string>()> inputs, outputs;
  const Declared* may_replace = nullptr;
  std::vector<pipeline::jobs::Option*> rows;  ///< of jobs, which this option sets

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
  std::deque<pipeline::jobs::Table> tables;
  std::function<std::map<std::string, std::string>()> records;

  Option::Declared& declare_row(const pipeline::jobs::Option& row);
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

}  // namespace marey::cli
