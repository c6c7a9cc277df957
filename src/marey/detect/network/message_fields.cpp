#include "marey/detect/network/message_fields.h"

namespace marey::detect::network {

std::optional<Field> Fields::next() {
  if (rest_.empty()) return std::nullopt;
  const std::string_view from_here = rest_;
  Field field;
  const auto tag = number();
  if (!tag) return broken();
  field.number = *tag >> 3;
  field.coding = static_cast<unsigned>(*tag & 7);
  if (field.coding == Field::varint) {
    const auto value = number();
    if (!value) return broken();
    field.value = *value;
  } else {
    const auto length = field.coding == Field::bytes         ? number()
                        : field.coding == Field::eight_bytes ? std::optional<std::uint64_t>(8)
                        : field.coding == Field::four_bytes  ? std::optional<std::uint64_t>(4)
                                                             : std::nullopt;
    if (!length || *length > rest_.size()) return broken();
    field.content = rest_.substr(0, *length);
    rest_.remove_prefix(*length);
  }
  field.whole = from_here.substr(0, from_here.size() - rest_.size());
  return field;
}

std::optional<std::uint64_t> Fields::number() {
  std::uint64_t value = 0;
  for (unsigned shift = 0; shift < 64 && !rest_.empty(); shift += 7) {
    const auto byte = static_cast<unsigned char>(rest_.front());
    rest_.remove_prefix(1);
    value |= static_cast<std::uint64_t>(byte & 0x7f) << shift;
    if (byte < 0x80) return value;
  }
  return std::nullopt;
}

}  // namespace marey::detect::network
