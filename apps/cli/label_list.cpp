#include "label_list.h"

#include <algorithm>

#include "marey/core/error.h"

namespace marey::cli {

std::vector<std::string> labels_in(const std::string& text) {
  std::vector<std::string> labels;
  for (std::size_t begin = 0; begin <= text.size();) {
    const std::size_t end = std::min(text.find(',', begin), text.size());
    std::string label = text.substr(begin, end - begin);
    label.erase(0, label.find_first_not_of(' '));
    label.erase(label.find_last_not_of(' ') + 1);
    if (label.empty()) throw Error("\"{}\" names no marker between two commas", text);
    if (std::find(labels.begin(), labels.end(), label) != labels.end()) throw Error("the marker {} is named twice", label);
    labels.push_back(std::move(label));
    begin = end + 1;
  }
  return labels;
}

}  // namespace marey::cli
