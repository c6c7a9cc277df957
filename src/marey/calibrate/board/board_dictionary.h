#pragma once

#include <optional>
#include <string>

#include <opencv2/aruco.hpp>

namespace marey::calibrate::board {

/// How many markers the dictionary of that name ("4X4_50") holds; nothing if the name is unknown.
std::optional<int> board_dictionary_size(const std::string& name);

/// The dictionary itself; `name` is one that board_dictionary_size knows.
cv::Ptr<cv::aruco::Dictionary> board_dictionary(const std::string& name);

}  // namespace marey::calibrate::board
