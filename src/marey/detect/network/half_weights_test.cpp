#include "marey/detect/network/half_weights.h"

#include <cstring>

#include <gtest/gtest.h>

namespace marey::detect::network {
namespace {

using namespace std::string_literals;

std::string message(int field, const std::string& content) {
  return std::string(1, static_cast<char>(field << 3 | 2)) + static_cast<char>(content.size()) + content;
}

/// A model with one node, one tensor of two numbers and a name after it, as onnx.proto numbers them.
std::string model_of(char type, const std::string& numbers) {
  const std::string tensor = "\x08\x02"s + "\x10"s + type + message(8, "w") + message(9, numbers);
  return "\x08\x07"s + message(7, message(1, "node") + message(5, tensor) + message(2, "graph")) + message(8, "");
}

TEST(HalfWeights, BecomeFloats) {
  const float numbers[] = {1, -2.5};
  const std::string floats(reinterpret_cast<const char*>(numbers), sizeof numbers);
  EXPECT_EQ(with_full_weights(model_of(10, "\x00\x3c\x00\xc1"s)), model_of(1, floats));
  EXPECT_EQ(with_full_weights(model_of(1, floats)), model_of(1, floats));
}

TEST(HalfWeights, KeepsNonNetworkFile) {
  EXPECT_EQ(with_full_weights(""), "");
  EXPECT_EQ(with_full_weights("no network at all"), "no network at all");
  const std::string whole = model_of(10, "\x00\x3c\x00\xc1"s);
  for (std::size_t length = 3; length + 2 < whole.size(); ++length)
    EXPECT_EQ(with_full_weights(whole.substr(0, length)), whole.substr(0, length)) << length;
  EXPECT_EQ(with_full_weights(model_of(10, "\x00\x3c\x00"s)), model_of(10, "\x00\x3c\x00"s)) << "an odd number of bytes";
}

}  // namespace
}  // namespace marey::detect::network
