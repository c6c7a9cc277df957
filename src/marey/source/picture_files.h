#pragma once

#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "marey/core/source.h"

namespace marey::source {

/// The pictures that `path` names, sorted as a person would: picture2 before picture10. A folder: every file in it that ends
/// as pictures do. A pattern: files whose whole name matches, `%d` or `%04d` for a number, `*` and `?` as in a shell; patterns
/// stand in the last part of the path. Empty where nothing matches.
std::vector<std::string> find_pictures(const std::string& path);

/// Throws Error where the pictures of a folder are no sequence: their names are not one name with a number that counts.
void require_sequence(const std::string& folder, const std::vector<std::string>& files);

/// Whether the name ends as pictures do: .png, .jpg, .tif …
bool is_picture_name(const std::string& path);

/// Whether the name is a pattern for find_pictures.
bool is_picture_pattern(const std::string& path);

/// Pictures as a source, `rate_hz` a second (25 where nothing is given, with a warning that says so). A picture that cannot be read
/// or whose size is not the first one's is left out, with a warning; its time passes all the same. Throws Error where `files` is
/// empty or none of them can be read; `name` is what the user gave.
std::unique_ptr<Source> open_pictures(const std::string& name, std::vector<std::string> files, std::optional<double> rate_hz);

}  // namespace marey::source
