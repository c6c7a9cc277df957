// The one register of formats: every file that Marey reads or writes, but for videos and images. What commands say of formats
// (help, errors, the table in docs/formats.md) comes from it. A new format is one file, which ends with its row, and one line in
// register.cpp.
#pragma once

#include <span>
#include <string>
#include <string_view>

#include "marey/core/error.h"
#include "marey/format/format.h"

namespace marey::format {

/// A format or an ending was asked for that is not one, or cannot hold what is to be written: the command line is wrong, not a
/// file.
class WrongFormat : public Error {
 public:
  using Error::Error;
};

/// In the order in which a file is asked.
std::span<const Format> formats();

/// By its content; null where it is not one of them. Throws Error if there is no such file.
const Format* format_of_content(const std::string& path);
/// The same, of those that hold some of `wanted`. Throws Error, which lists them, where it is not one.
const Format& format_to_read(const std::string& path, Contents required);
/// The one of that name that holds some of `wanted`; "csv" is each content's own `.csv` too. Null if it does not exist.
const Format* format_named(std::string_view name, Contents required);
/// The one whose ending a name to be written has.
const Format* format_of_name(std::string_view path, Contents required);
/// What to write `path` in: the format called `name`, or where that is empty the one of its ending. Throws WrongFormat with what
/// can be written if it does not exist, or if it cannot hold this content.
const Format& format_to_write(const std::string& path, std::string_view name, Content content);
/// For a command line, before anything is read: throws WrongFormat where nothing is written under that name.
void check_written_name(const std::string& name);

/// "take, c3d, trc", each once.
std::string names_of_read(Contents required);
std::string names_of_written(Contents required);
/// ".marey (take), .c3d (c3d)": what can be written, each by its first ending, or by its name.
std::string endings_of_written(Contents required);
/// "points in space".
std::string_view words_of(Content content);
/// All endings of a format with commas between, for people.
std::string shown_endings(const Format& format);

/// ".marey"; empty if it has none.
std::string first_ending(const Format& format);

/// A name's other file, where files of that ending come in pairs: data read or written without being named.
std::string companion_file(const std::string& path);

/// The table of docs/formats.md: Markdown, a row a format.
std::string format_table();

}  // namespace marey::format
