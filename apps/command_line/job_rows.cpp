// The rows of jobs as options of the command line.
#include <algorithm>

#include <fmt/ranges.h>

#include "declared.h"
#include "spelling.h"

namespace marey::cli {
namespace {

using Row = pipeline::jobs::Option;
using pipeline::jobs::Kind;

void set_rows(const Option::Declared& option, const std::string& text) {
  const std::vector<std::string>& choices = option.rows.front()->choices;
  try {
    for (Row* row : option.rows) row->set(text);
  } catch (const Error& error) {
    const std::string near = suggestion(text, choices);
    if (near.empty()) throw;
    throw WrongUsage("{}.{}", error.what(), near);
  }
}

std::string meaning_of(const Row& row) {
  return row.choices.empty() ? row.help : fmt::format("{}: {}", row.help, fmt::join(row.choices, ", "));
}

}  // namespace

Option::Declared& Command::Declared::declare_row(const Row& row) {
  const std::string name = "--" + row.name, meaning = meaning_of(row);
  if (row.kind == Kind::flag) {
    auto flag = std::make_unique<Option::Declared>();
    flag->name = name;
    flag->parsed = app->add_flag_callback(name, [its = flag.get()] { set_rows(*its, "true"); }, meaning);
    return add(std::move(flag));
  }
  const auto its = std::make_shared<const Option::Declared*>(nullptr);
  Option::Declared& option = declare(name, meaning, row.value, row.kind == Kind::texts ? 0 : 1,
                                     [its](int, const std::string& text) { set_rows(**its, text); });
  *its = &option;
  option.parsed->default_str(row.fallback);
  const auto path = [&option] { return std::vector{option.rows.front()->given.value_or("")}; };
  if (row.kind == Kind::input_file) option.inputs = path;
  if (row.kind == Kind::output_file || row.kind == Kind::output_folder) option.outputs = path;
  return option;
}

pipeline::jobs::Table& Command::rows(pipeline::jobs::Table table, const std::string& when) {
  pipeline::jobs::Table& kept = declared_->tables.emplace_back(std::move(table));
  const auto named = [&](const std::string& name) {
    const auto is_it = [&](const auto& option) { return option->name == "--" + name; };
    const auto found = std::find_if(declared_->options.begin(), declared_->options.end(), is_it);
    return found != declared_->options.end() ? found->get() : nullptr;
  };
  const std::string before = declared_->group;
  for (Row& row : kept.options()) {
    group(row.group);
    Option::Declared* option = named(row.name);
    if (option == nullptr) {
      option = &declared_->declare_row(row);
      if (!row.needs.empty()) option->parsed->needs(named(row.needs)->parsed);
    } else if (row.help != option->rows.front()->help) {
      option->parsed->description(fmt::format("{}; {}: {}", option->parsed->get_description(), when, meaning_of(row)));
    }
    option->rows.push_back(&row);
  }
  group(before);
  return kept;
}

void Command::records(std::function<std::map<std::string, std::string>()> options) {
  declared_->records = std::move(options);
}

}  // namespace marey::cli
