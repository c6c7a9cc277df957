#pragma once

#include <array>
#include <concepts>
#include <cstdint>
#include <functional>
#include <limits>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include <fmt/format.h>

#include "marey/core/error.h"
#include "marey/pipeline/jobs/option.h"

// The one door to the library that parses the command line. A subcommand declares its options here, and what runs.
namespace marey::cli {

using pipeline::jobs::above;
using pipeline::jobs::closed;
using pipeline::jobs::Interval;
using pipeline::jobs::kRates;
using pipeline::jobs::number_in;
using pipeline::jobs::number_of;
using pipeline::jobs::numbers_in;
using pipeline::jobs::whole_number_in;
using pipeline::jobs::whole_number_of;

/// The command line asks for what cannot be done: exit code 2, the message is one sentence.
class WrongUsage : public Error {
 public:
  using Error::Error;
};

/// Ends the program with this exit code; all that is to be said was said.
struct EndWith {
  int code;
};

/// Throws Error for a text that an option does not take; its sentence lists what is valid.
using Check = std::function<void(const std::string&)>;
using Paths = std::function<std::vector<std::string>()>;

/// A positional or an option that was declared: a name of it, to be passed by value. Valid as long as its Program.
class Option {
 public:
  struct Declared;
  explicit Option(Declared& declared) : declared_(&declared) {}

  Option& required();
  Option& needs(const Option& other);
  Option& excludes(const Option& other);
  /// Called for each text that is given.
  Option& check(Check check);
  /// Of an output: it ends in one of these (".svg"), or the command line is refused. What is not a file, as /dev/null, is taken.
  Option& ends_in(std::vector<std::string> endings);
  /// Of an output: it may be that input, which the command reads whole before it writes.
  Option& may_replace(const Option& input);

 private:
  friend class Command;
  Declared* declared_;
};

/// A subcommand, or the program itself. Values that options are bound to live as long as the Program.
class Command {
 public:
  struct Declared;
  explicit Command(Declared& declared) : declared_(&declared) {}
  friend struct DeclaredOf;

  Command subcommand(const std::string& name, const std::string& meaning);
  /// What is declared after it stands below this title in the help.
  void group(const std::string& title);

  /// Names are "INPUT" (a positional), "--long" or "-s,--long".
  Option text(const std::string& name, std::string& value, const std::string& meaning);
  /// May be given often.
  Option texts(const std::string& name, std::vector<std::string>& values, const std::string& meaning);
  /// Sets `value` to `on`.
  Option flag(const std::string& name, bool& value, const std::string& meaning, bool on = true);

  /// A number, finite and in `interval`: help and refusals say "UNIT in [LOW, HIGH]".
  Option number(const std::string& name, double& value, const char* unit, const Interval& interval, const std::string& meaning) {
    return add_number(name, pipeline::jobs::contains(interval, value) ? shown(value) : "", 1, unit, interval, meaning,
                      [&value](int, double given) { value = given; });
  }
  Option number(const std::string& name, std::optional<double>& value, const char* unit, const Interval& interval,
                const std::string& meaning) {
    return add_number(name, "", 1, unit, interval, meaning, [&value](int, double given) { value = given; });
  }
  /// As many numbers, with blanks between.
  template <std::size_t N>
  Option numbers(const std::string& name, std::array<double, N>& values, const char* unit, const Interval& interval,
                 const std::string& meaning) {
    return add_number(name, shown(values), N, unit, interval, meaning,
                      [&values](int i, double given) { values[static_cast<std::size_t>(i)] = given; });
  }
  template <std::integral T>
  Option whole(const std::string& name, T& value, const char* unit, std::int64_t low, std::int64_t high,
               const std::string& meaning) {
    return add_whole(name, fmt::format("{}", value), 1, unit, low, high, meaning,
                     [&value](int, std::int64_t given) { value = static_cast<T>(given); });
  }
  template <std::integral T>
  Option whole(const std::string& name, std::optional<T>& value, const char* unit, std::int64_t low, std::int64_t high,
               const std::string& meaning) {
    return add_whole(name, "", 1, unit, low, high, meaning, [&value](int, std::int64_t given) { value = static_cast<T>(given); });
  }
  /// As many whole numbers, with blanks between; zeros are not shown as their default.
  template <std::integral T, std::size_t N>
  Option wholes(const std::string& name, std::array<T, N>& values, const char* unit, std::int64_t low, std::int64_t high,
                const std::string& meaning) {
    return add_whole(name, values == std::array<T, N>{} ? "" : shown(values), N, unit, low, high, meaning,
                     [&values](int i, std::int64_t given) { values[static_cast<std::size_t>(i)] = static_cast<T>(given); });
  }
  /// "--seed": which of the endlessly many.
  template <std::integral T>
  Option seed(T& value, const std::string& meaning) {
    return whole("--seed", value, "N", 0, std::numeric_limits<std::int64_t>::max(), meaning);
  }

  /// One of the names in `choices`, which sets `value` to what stands beside it.
  template <typename T, typename Choices>
  Option choice(const std::string& name, T& value, const Choices& choices, const std::string& meaning) {
    std::vector<std::string> names;
    std::vector<T> values;
    std::string typical;
    for (const auto& [its_name, its_value] : choices) {
      names.emplace_back(its_name);
      values.push_back(its_value);
      if (its_value == value) typical = names.back();
    }
    return add_choice(name, std::move(names), typical, meaning, [&value, values](std::size_t chosen) { value = values[chosen]; });
  }

  /// Files that are read: no output may be one of them. A folder and a pattern stand for the images in them; CAMERA=FILE stands
  /// for the file where `texts` are given.
  Option input_file(const std::string& name, std::string& value, const std::string& meaning);
  Option input_files(const std::string& name, std::vector<std::string>& values, const std::string& meaning);
  Option output_file(const std::string& name, std::string& value, const std::string& meaning);
  Option output_folder(const std::string& name, std::string& value, const std::string& meaning);
  /// Files that are read or written without being named on the command line. Called before the command runs; an Error of theirs
  /// is left to the command to find.
  void also_reads(Paths paths);
  void also_writes(Paths paths);

  /// The rows of a job as options of this command, "--name" with their help, unit, domain and default. Rows of several jobs that
  /// have one name are one option, which sets all of them; `when` states in which case this job runs, if its help differs
  /// ("with --ground"). What a row needs was declared before. The command keeps the table.
  pipeline::jobs::Table& rows(pipeline::jobs::Table table, const std::string& when = "");
  /// What recordings hold as the options that were given, in place of the words of the command line.
  void records(std::function<std::map<std::string, std::string>()> options);

  /// --json and -q,--quiet, which every command has; --markdown if there is a value for it.
  void reports(bool& json, bool& quiet, const std::string& what = "summary", bool* markdown = nullptr);

  void runs(std::function<void()> run);

 private:
  template <std::size_t N, typename T>
  static std::string shown(const std::array<T, N>& values) {
    std::string text;
    for (const T& value : values) text += fmt::format("{}{}", text.empty() ? "" : " ", value);
    return text;
  }
  static std::string shown(double value) { return fmt::format("{}", value); }

  Option add_number(const std::string& name, const std::string& typical, int count, const char* unit, const Interval& interval,
                    const std::string& meaning, std::function<void(int, double)> set);
  Option add_whole(const std::string& name, const std::string& typical, int count, const char* unit, std::int64_t low,
                   std::int64_t high, const std::string& meaning, std::function<void(int, std::int64_t)> set);
  Option add_choice(const std::string& name, std::vector<std::string> names, const std::string& typical, const std::string& meaning,
                    std::function<void(std::size_t)> set);

  Declared* declared_;
};

/// The whole command line.
class Program {
 public:
  Program(const std::string& name, const std::string& meaning);
  ~Program();
  Program(const Program&) = delete;
  Program& operator=(const Program&) = delete;

  Command root();
  /// Parses, runs and says what went wrong, in one line on standard error. Returns the exit code: 0, 1 for what the outside world
  /// did, 2 for wrong usage; 1 too where standard output did not take everything.
  int run(int argc, char** argv);

 private:
  struct Parser;
  std::unique_ptr<Parser> parser_;
};

/// "0.1.0 (commit 0123456789ab)".
std::string version_text();

/// The options that the running command was given, without their dashes; not those that name files.
const std::map<std::string, std::string>& given_options();

}  // namespace marey::cli
