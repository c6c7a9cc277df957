#include "marey/calibrate/board/board_dictionary.h"

#include <algorithm>
#include <array>
#include <string_view>
#include <vector>

#include "marey/calibrate/board/board.h"

namespace marey::calibrate::board {
namespace {

struct Entry {
  std::string_view name;
  cv::aruco::PREDEFINED_DICTIONARY_NAME id;
  int size;
};

using namespace cv::aruco;
constexpr std::array kDictionaries{
    Entry{"4X4_50", DICT_4X4_50, 50},
    Entry{"4X4_100", DICT_4X4_100, 100},
    Entry{"4X4_250", DICT_4X4_250, 250},
    Entry{"4X4_1000", DICT_4X4_1000, 1000},
    Entry{"5X5_50", DICT_5X5_50, 50},
    Entry{"5X5_100", DICT_5X5_100, 100},
    Entry{"5X5_250", DICT_5X5_250, 250},
    Entry{"5X5_1000", DICT_5X5_1000, 1000},
    Entry{"6X6_50", DICT_6X6_50, 50},
    Entry{"6X6_100", DICT_6X6_100, 100},
    Entry{"6X6_250", DICT_6X6_250, 250},
    Entry{"6X6_1000", DICT_6X6_1000, 1000},
    Entry{"7X7_50", DICT_7X7_50, 50},
    Entry{"7X7_100", DICT_7X7_100, 100},
    Entry{"7X7_250", DICT_7X7_250, 250},
    Entry{"7X7_1000", DICT_7X7_1000, 1000},
    Entry{"ARUCO_ORIGINAL", DICT_ARUCO_ORIGINAL, 1024},
    Entry{"APRILTAG_16H5", DICT_APRILTAG_16h5, 30},
    Entry{"APRILTAG_25H9", DICT_APRILTAG_25h9, 35},
    Entry{"APRILTAG_36H10", DICT_APRILTAG_36h10, 2320},
    Entry{"APRILTAG_36H11", DICT_APRILTAG_36h11, 587},
};

const Entry* find(const std::string& name) {
  const auto* entry = std::ranges::find(kDictionaries, name, &Entry::name);
  return entry == kDictionaries.end() ? nullptr : entry;
}

}  // namespace

std::optional<int> board_dictionary_size(const std::string& name) {
  const Entry* entry = find(name);
  return entry ? std::optional(entry->size) : std::nullopt;
}

cv::Ptr<cv::aruco::Dictionary> board_dictionary(const std::string& name) {
  return cv::aruco::getPredefinedDictionary(find(name)->id);
}

std::vector<std::string> board_dictionaries() {
  std::vector<std::string> names;
  for (const Entry& entry : kDictionaries) names.emplace_back(entry.name);
  return names;
}

}  // namespace marey::calibrate::board
