#include "marey/pipeline/jobs/option.h"

#include <algorithm>
#include <cctype>

#include <fmt/ranges.h>

#include "marey/files/overwriting.h"

namespace marey::pipeline::jobs {
namespace {

std::string lower(std::string text) {
  std::transform(text.begin(), text.end(), text.begin(), [](unsigned char c) { return std::tolower(c); });
  return text;
}

std::string shown_number(double value) {
  return fmt::format("{}", value);
}

}  // namespace

void Option::set(const std::string& text) {
  given = take(text);
}

Option& Option::needing(std::string other) {
  needs = std::move(other);
  return *this;
}

Option& Option::depending_on(std::vector<std::string> names) {
  depends = std::move(names);
  return *this;
}

Option& Option::checked(std::function<void(const std::string&)> check) {
  take = [check = std::move(check), before = std::move(take)](const std::string& text) {
    check(text);
    return before(text);
  };
  return *this;
}

Option& Option::ending_in(std::vector<std::string> endings) {
  return checked([endings = std::move(endings)](const std::string& text) {
    const auto fits = [&](const std::string& ending) { return lower(text).ends_with(ending); };
    if (is_stream(text) || std::any_of(endings.begin(), endings.end(), fits)) return;
    throw WrongOption("{}: the ending is of another format than the one that is written; name a file that ends in {}", text,
                      fmt::join(endings, " or "));
  });
}

Option& Table::add(std::string name, Kind kind, std::string value, std::string fallback, std::string help,
                   std::function<std::string(const std::string&)> take) {
  Option& option = options_.emplace_back();
  option.name = std::move(name);
  option.kind = kind;
  option.value = std::move(value);
  option.fallback = std::move(fallback);
  option.help = std::move(help);
  option.group = group_;
  option.take = std::move(take);
  return option;
}

Option& Table::flag(std::string name, bool& value, std::string help, bool on) {
  return add(std::move(name), Kind::flag, "", "", std::move(help), [&value, on](const std::string& text) {
    if (text != "true") throw WrongOption("\"{}\" is not true", text);
    value = on;
    return text;
  });
}

template <typename T>
Option& Table::add_number(std::string name, T& value, std::string fallback, const char* unit, const Interval& interval,
                          std::string help) {
  return add(std::move(name), Kind::number, fmt::format("{} in {}", unit, notation(interval)), std::move(fallback), std::move(help),
             [&value, unit, interval](const std::string& text) {
               const double number = number_in(text, unit, interval);
               value = number;
               return shown_number(number);
             });
}

template <typename T>
Option& Table::add_whole(std::string name, T& value, std::string fallback, const char* unit, int low, int high, std::string help) {
  return add(std::move(name), Kind::whole, fmt::format("{} in {}", unit, notation(low, high)), std::move(fallback), std::move(help),
             [&value, unit, low, high](const std::string& text) {
               const auto number = static_cast<int>(whole_number_in(text, unit, low, high));
               value = number;
               return fmt::format("{}", number);
             });
}

Option& Table::number(std::string name, double& value, const char* unit, const Interval& interval, std::string help) {
  return add_number(std::move(name), value, contains(interval, value) ? shown_number(value) : "", unit, interval, std::move(help));
}

Option& Table::number(std::string name, std::optional<double>& value, const char* unit, const Interval& interval,
                      std::string help) {
  return add_number(std::move(name), value, "", unit, interval, std::move(help));
}

Option& Table::whole(std::string name, int& value, const char* unit, int low, int high, std::string help) {
  return add_whole(std::move(name), value, fmt::format("{}", value), unit, low, high, std::move(help));
}

Option& Table::whole(std::string name, std::optional<int>& value, const char* unit, int low, int high, std::string help) {
  return add_whole(std::move(name), value, "", unit, low, high, std::move(help));
}

Option& Table::text_of(Kind kind, const char* shown, std::string name, std::string& value, std::string help) {
  return add(std::move(name), kind, shown, value, std::move(help), [&value](const std::string& text) { return value = text; });
}

Option& Table::text(std::string name, std::string& value, std::string help) {
  return text_of(Kind::text, "TEXT", std::move(name), value, std::move(help));
}

Option& Table::texts(std::string name, std::vector<std::string>& values, std::string help) {
  return add(std::move(name), Kind::texts, "TEXT", "", std::move(help), [&values](const std::string& text) {
    values.push_back(text);
    return fmt::format("{}", fmt::join(values, ","));
  });
}

Option& Table::size(std::string name, std::string& value, std::string help) {
  return text_of(Kind::size, "LENGTHxWIDTH", std::move(name), value, std::move(help));
}

Option& Table::corners(std::string name, std::string& value, std::string help) {
  return text_of(Kind::corners, "CORNERS", std::move(name), value, std::move(help));
}

Option& Table::input_file(std::string name, std::string& value, std::string help) {
  return text_of(Kind::input_file, "FILE", std::move(name), value, std::move(help));
}

Option& Table::output_file(std::string name, std::string& value, std::string help) {
  return text_of(Kind::output_file, "FILE", std::move(name), value, std::move(help));
}

Option& Table::output_folder(std::string name, std::string& value, std::string help) {
  return text_of(Kind::output_folder, "FOLDER", std::move(name), value, std::move(help));
}

Option& Table::choice(std::string name, std::string& value, std::vector<std::string> names, std::string help) {
  Option& option = text_of(Kind::choice, "NAME", std::move(name), value, std::move(help));
  option.choices = std::move(names);
  return option.checked([known = option.choices](const std::string& text) {
    if (std::find(known.begin(), known.end(), text) == known.end())
      throw WrongOption("\"{}\" is not supported; use one of {}", text, fmt::join(known, ", "));
  });
}

Option* Table::find(const std::string& name) {
  const auto found = std::find_if(options_.begin(), options_.end(), [&](const Option& option) { return option.name == name; });
  return found != options_.end() ? &*found : nullptr;
}

void Table::check_needs() {
  for (const Option& option : options_) {
    if (!option.given || option.needs.empty()) continue;
    const Option* other = find(option.needs);
    if (other != nullptr && !other->given) throw WrongOption("--{} requires --{}", option.name, option.needs);
  }
}

std::map<std::string, std::string> Table::given() const {
  std::map<std::string, std::string> texts = always_;
  for (const Option& option : options_) {
    if (option.given && !option.is_file()) texts[option.name] = *option.given;
  }
  return texts;
}

std::vector<std::string> Table::files(bool outputs) const {
  std::vector<std::string> paths;
  for (const Option& option : options_) {
    if (option.given && option.is_file() && (option.kind != Kind::input_file) == outputs) paths.push_back(*option.given);
  }
  return paths;
}

}  // namespace marey::pipeline::jobs
