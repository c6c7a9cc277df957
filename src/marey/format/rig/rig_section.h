#pragma once

#include <initializer_list>
#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include <toml++/toml.h>

#include "marey/core/geometry.h"

namespace marey::format::rig {

/// A text of a file, fit for a one-line message.
std::string excerpt(std::string_view text, std::size_t maximum = 40);

/// What is wrong with a TOML file, gathered so that all of it is reported at once.
class Problems {
 public:
  explicit Problems(std::string file) : file_(std::move(file)) {}

  void add(const toml::source_region& where, std::string what) { found_.emplace_back(where.begin.line, std::move(what)); }

  /// Throws Error with one line for each, `file:LINE: what`, from top to bottom.
  void throw_if_any();

 private:
  std::string file_;
  std::vector<std::pair<toml::source_index, std::string>> found_;
};

/// One table of a TOML file: distributes its values by name, nothing if one is missing, and notes those that are not what they
/// must be.
class Section {
 public:
  /// `title` begins each message about this table: `camera "left"`.
  Section(const toml::table& table, std::string title, Problems& problems)
      : table_(table), title_(std::move(title)), problems_(problems) {}

  void rename(std::string title) { title_ = std::move(title); }
  /// Under its name of today, or the one that files of earlier versions have.
  bool has(std::string_view key) const { return find(key) != nullptr; }

  /// A problem with a value, or, where the key is missing, with the table.
  void problem(std::string_view key, std::string_view what) const;
  /// Any other key is a problem, and so is one that is there under its earlier name as well.
  void only(std::initializer_list<std::string_view> known) const;

  std::optional<std::string> text(std::string_view key) const;
  std::optional<double> number(std::string_view key) const;
  std::optional<double> positive(std::string_view key) const;
  std::optional<int> count(std::string_view key) const;
  /// Between `fewest` and `most` numbers; `form` says in words what they must be.
  std::optional<std::vector<double>> numbers(std::string_view key, std::size_t min_count, std::size_t maximum,
                                             std::string_view form) const;
  /// At most `most` rows of at least `fewest` numbers; none where the key is missing, or, with a problem, where it is something
  /// else.
  std::vector<std::vector<double>> rows(std::string_view key, std::size_t min_count, std::size_t maximum,
                                        std::string_view form) const;
  std::optional<Matrix<3>> matrix(std::string_view key) const;
  std::optional<Matrix<3>> invertible(std::string_view key) const;
  /// A rotation matrix, made exact where it is rounded.
  std::optional<Matrix<3>> rotation(std::string_view key) const;

 private:
  const toml::node* find(std::string_view key) const;

  const toml::table& table_;
  std::string title_;
  Problems& problems_;
};

}  // namespace marey::format::rig
