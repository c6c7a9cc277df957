#pragma once

#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "marey/core/source.h"

namespace marey::source {

/// The images that `path` names, sorted as a person would: picture2 before picture10. A folder: every file in it that ends
/// as images do. A pattern: files whose whole name matches, `%d` or `%04d` for a number, `*` and `?` as in a shell; patterns
/// stand in the last part of the path. Empty if nothing matches.
std::vector<std::string> find_images(const std::string& path);

/// Throws Error if the images of a folder are not sequence: their names are not one name with a number that counts.
void require_sequence(const std::string& folder, const std::vector<std::string>& files);

/// Whether the name ends as images do: .png, .jpg, .tif …
bool is_image_name(const std::string& path);

/// Whether the name is a pattern for find_images.
bool is_image_pattern(const std::string& path);

/// Images as a source, `rate_hz` a second (25 where nothing is given, with a warning that says so). An image that cannot be read
/// or whose size is not the first one's is omitted, with a warning; its time passes all the same. Throws Error if `files` is
/// empty or none of them can be read; `name` is what the user gave.
std::unique_ptr<Source> open_images(const std::string& name, std::vector<std::string> files, std::optional<double> rate_hz);

}  // namespace marey::source
