#pragma once

#include <string>
#include <string_view>

#include <nlohmann/json.hpp>

namespace marey::format::rig {

/// What a file of cv::FileStorage holds, in YAML, JSON or XML: maps, sequences, texts and numbers (all as double). Read is what
/// OpenCV writes and people write like it; matrices are maps of rows, cols, dt and data. No anchors, no texts over several lines,
/// no second document. Throws Error, `name:line: ...` where the line is known. Time and memory are linear in the text.
nlohmann::json parse_file_storage(std::string_view text, const std::string& name);

}  // namespace marey::format::rig
