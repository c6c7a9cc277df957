#pragma once

#include <string>

namespace marey {

/// Names as people sort them: numbers within them compare by value, everything else by character. "match2" is before "match10".
struct NaturalOrder {
  bool operator()(const std::string& a, const std::string& b) const;
};

}  // namespace marey
