// The description of a job's options: one row per option with its name, kind, unit, domain, default and help, bound to a member of
// the job's value. The command line, Python, `made_by.options` of a recording and the tables in docs/ are made from it, so that
// they cannot differ. What depends on several options is not decided here but in the job's `resolved`.
#pragma once

#include <concepts>
#include <deque>
#include <functional>
#include <map>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include <fmt/format.h>

#include "marey/pipeline/jobs/numbers.h"

namespace marey::pipeline::jobs {

enum class Kind {
  flag,
  number,
  whole,
  text,
  choice,
  size,     ///< a text, "105x68"
  corners,  ///< a text, "x,y x,y x,y"
  input_file,
  output_file,
  output_folder,
  texts,  ///< may be given often, each a text
};

/// One row.
struct Option {
  std::string name;  ///< words with dashes between: "measured-only"
  Kind kind = Kind::text;
  std::string help;
  std::string value;                 ///< what it takes: "s in [0, 60]", "TEXT", "FILE"; empty for a flag
  std::string fallback;              ///< the default as text, if it is a constant
  std::string group;                 ///< the title that it is listed under; may be empty
  std::vector<std::string> choices;  ///< all of them, if `kind` is choice
  std::string needs;                 ///< an option without which this one has no meaning; the front end may have it
  std::vector<std::string> depends;  ///< options that the default of this one, or its effect, depends on
  std::optional<std::string> given;  ///< what it was set to, in canonical notation

  /// Sets the member. Throws Error for a text that is not in the domain; the sentence does not contain the option's name.
  void set(const std::string& text);

  Option& needing(std::string other);
  Option& depending_on(std::vector<std::string> names);
  /// `check` is called with each text that is set, and throws Error.
  Option& checked(std::function<void(const std::string&)> check);
  /// Of an output: its name ends in one of these (".svg"), unless it is a stream.
  Option& ending_in(std::vector<std::string> endings);

  bool is_file() const { return kind == Kind::input_file || kind == Kind::output_file || kind == Kind::output_folder; }

  std::function<std::string(const std::string&)> take;  ///< sets the member and returns the text in canonical notation
};

/// All rows of one job. Members are bound by reference: the job's value lives longer than its table and does not move.
class Table {
 public:
  /// Rows that are added from now on are listed under this title.
  void group(std::string title) { group_ = std::move(title); }

  /// Sets `value` to `on`.
  Option& flag(std::string name, bool& value, std::string help, bool on = true);
  /// Finite and in `interval`.
  Option& number(std::string name, double& value, const char* unit, const Interval& interval, std::string help);
  Option& number(std::string name, std::optional<double>& value, const char* unit, const Interval& interval, std::string help);
  Option& whole(std::string name, int& value, const char* unit, int low, int high, std::string help);
  Option& whole(std::string name, std::optional<int>& value, const char* unit, int low, int high, std::string help);
  Option& text(std::string name, std::string& value, std::string help);
  /// May be given often: each is added.
  Option& texts(std::string name, std::vector<std::string>& values, std::string help);
  Option& input_file(std::string name, std::string& value, std::string help);
  Option& output_file(std::string name, std::string& value, std::string help);
  Option& output_folder(std::string name, std::string& value, std::string help);
  Option& size(std::string name, std::string& value, std::string help);
  Option& corners(std::string name, std::string& value, std::string help);
  /// One of `names`; the text itself is kept, a `resolved` function resolves it.
  Option& choice(std::string name, std::string& value, std::vector<std::string> names, std::string help);

  /// A word that every recording of this job states in `made_by.options`: {"targets", "markers"}.
  void always(std::string name, std::string value) { always_.emplace(std::move(name), std::move(value)); }

  /// Null if it does not exist.
  Option* find(const std::string& name);
  std::deque<Option>& options() { return options_; }
  /// Throws WrongOption if an option was set without the one that it needs.
  void check_needs();
  /// The options that were set, without files: what `made_by.options` of the recording holds.
  std::map<std::string, std::string> given() const;
  /// The files that were set, of one direction.
  std::vector<std::string> files(bool outputs) const;

 private:
  Option& add(std::string name, Kind kind, std::string value, std::string fallback, std::string help,
              std::function<std::string(const std::string&)> take);
  Option& text_of(Kind kind, const char* shown, std::string name, std::string& value, std::string help);
  template <typename T>
  Option& add_number(std::string name, T& value, std::string fallback, const char* unit, const Interval& interval,
                     std::string help);
  template <typename T>
  Option& add_whole(std::string name, T& value, std::string fallback, const char* unit, int low, int high, std::string help);

  std::string group_;
  std::deque<Option> options_;
  std::map<std::string, std::string> always_;
};

}  // namespace marey::pipeline::jobs
