#include "mutator.h"

#include <algorithm>
#include <array>
#include <cctype>
#include <string_view>
#include <utility>
#include <vector>

namespace marey::faults {
namespace {

constexpr std::size_t kMaxSize = std::size_t{1} << 20;

constexpr std::array kWildNumbers{"0",
                                  "-1",
                                  "nan",
                                  "inf",
                                  "-inf",
                                  "1e308",
                                  "-1e308",
                                  "1e-320",
                                  "999999999",
                                  "2147483647",
                                  "-2147483648",
                                  "4294967296",
                                  "9223372036854775807",
                                  "18446744073709551616",
                                  "1e999",
                                  "0.1.2",
                                  "--5",
                                  "+",
                                  "",
                                  "0x10",
                                  "1e9",
                                  "65536",
                                  "255"};
constexpr std::array kNestings{"[", "{", "<a>", "(", "- ", "a.", "{\"a\":", "[[", "<a b=\"", "\"", "/*", "!!", "&a ", "a: "};

class Mutation {
 public:
  Mutation(std::string text, std::span<const std::string> others, std::mt19937_64& random)
      : text_(std::move(text)), others_(others), random_(random) {}

  void once();
  std::string take() { return std::move(text_); }

 private:
  std::size_t below(std::size_t end) { return end == 0 ? 0 : random_() % end; }
  std::size_t location() { return below(text_.size() + 1); }

  void flip();
  void exclude();
  void repeat();
  void truncate() { text_.resize(location()); }
  void make_number_wild();
  void change_lines();
  void swap_fields();
  void nest();
  void splice();
  void write_integer();

  /// The places where lines begin.
  std::vector<std::size_t> line_starts() const;
  std::pair<std::size_t, std::size_t> line_at(const std::vector<std::size_t>& starts, std::size_t index) const {
    return {starts[index], index + 1 < starts.size() ? starts[index + 1] : text_.size()};
  }

  std::string text_;
  std::span<const std::string> others_;
  std::mt19937_64& random_;
};

void Mutation::once() {
  using Change = void (Mutation::*)();
  constexpr std::array<Change, 14> kChanges{&Mutation::flip,
                                            &Mutation::flip,
                                            &Mutation::exclude,
                                            &Mutation::repeat,
                                            &Mutation::truncate,
                                            &Mutation::make_number_wild,
                                            &Mutation::make_number_wild,
                                            &Mutation::make_number_wild,
                                            &Mutation::change_lines,
                                            &Mutation::change_lines,
                                            &Mutation::swap_fields,
                                            &Mutation::nest,
                                            &Mutation::splice,
                                            &Mutation::write_integer};
  (this->*kChanges[below(kChanges.size())])();
  if (text_.size() > kMaxSize) text_.resize(kMaxSize);
}

void Mutation::flip() {
  if (text_.empty()) return;
  for (std::size_t left = 1 + below(4); left > 0; --left) {
    char& byte = text_[below(text_.size())];
    byte = below(2) == 0 ? static_cast<char>(byte ^ (1 << below(8))) : static_cast<char>(random_());
  }
}

void Mutation::exclude() {
  const std::size_t from = location();
  text_.erase(from, 1 + below(below(2) == 0 ? 8 : 200));
}

void Mutation::repeat() {
  const std::size_t from = location();
  std::string part = text_.substr(from, 1 + below(below(2) == 0 ? 8 : 200));
  for (std::size_t doublings = below(8); doublings > 0 && part.size() < 50'000; --doublings) part += part;
  text_.insert(location(), part);
}

void Mutation::make_number_wild() {
  const auto is_digit = [](char c) { return std::isdigit(static_cast<unsigned char>(c)) != 0; };
  const auto found = std::find_if(text_.begin() + static_cast<std::ptrdiff_t>(location()), text_.end(), is_digit);
  if (found == text_.end()) return;
  std::size_t begin = static_cast<std::size_t>(found - text_.begin()), end = begin;
  while (begin > 0 && (is_digit(text_[begin - 1]) || std::string_view("+-.").find(text_[begin - 1]) != std::string_view::npos))
    --begin;
  while (end < text_.size() && (is_digit(text_[end]) || text_[end] == '.')) ++end;
  text_.replace(begin, end - begin, kWildNumbers[below(kWildNumbers.size())]);
}

std::vector<std::size_t> Mutation::line_starts() const {
  std::vector<std::size_t> starts{0};
  for (std::size_t at = text_.find('\n'); at != std::string::npos && at + 1 < text_.size(); at = text_.find('\n', at + 1))
    starts.push_back(at + 1);
  return starts;
}

void Mutation::change_lines() {
  const std::vector<std::size_t> starts = line_starts();
  const auto [begin, end] = line_at(starts, below(starts.size()));
  const auto [other, other_end] = line_at(starts, below(starts.size()));
  const std::string line = text_.substr(begin, end - begin), other_line = text_.substr(other, other_end - other);
  switch (below(3)) {
    case 0:
      text_.erase(begin, line.size());
      break;
    case 1:
      text_.insert(other, line);
      break;
    default:
      text_.replace(begin, line.size(), other_line);
  }
}

void Mutation::swap_fields() {
  constexpr std::string_view kSeparators = ",;:\t =|";
  const std::vector<std::size_t> starts = line_starts();
  const auto [begin, end] = line_at(starts, below(starts.size()));
  std::vector<std::size_t> cuts{begin};
  for (std::size_t at = begin; at < end; ++at) {
    if (kSeparators.find(text_[at]) != std::string_view::npos) cuts.push_back(at + 1);
  }
  if (cuts.size() < 3) return;
  const std::size_t first = below(cuts.size() - 2), second = first + 1;
  const std::string a = text_.substr(cuts[first], cuts[second] - cuts[first]),
                    b = text_.substr(cuts[second], cuts[second + 1] - cuts[second]);
  text_.replace(cuts[first], a.size() + b.size(), b + a);
}

void Mutation::nest() {
  const std::string_view level = kNestings[below(kNestings.size())];
  std::string levels;
  for (std::size_t left = std::size_t{1} << below(15); left > 0; --left) levels += level;
  text_.insert(location(), levels);
}

void Mutation::splice() {
  if (others_.empty()) return;
  const std::string& other = others_[below(others_.size())];
  const std::size_t from = below(other.size() + 1);
  const std::string part = other.substr(from, below(2) == 0 ? below(64) : std::string::npos);
  const std::size_t at = location();
  text_.replace(at, below(2) == 0 ? part.size() : 0, part);
}

/// One of 2 or 4 bytes, as binary files count things.
void Mutation::write_integer() {
  constexpr std::array<std::uint32_t, 8> kValues{0, 1, 0x7F, 0xFF, 0x7FFF, 0xFFFF, 0x7FFFFFFF, 0xFFFFFFFF};
  const std::size_t size = below(2) == 0 ? 2 : 4;
  if (text_.size() < size) return;
  const std::size_t at = below(std::min<std::size_t>(text_.size() - size + 1, below(2) == 0 ? 512 : kMaxSize));
  const std::uint32_t value = kValues[below(kValues.size())];
  for (std::size_t i = 0; i < size; ++i) text_[at + i] = static_cast<char>(value >> (8 * i));
}

}  // namespace

std::string mutated(const std::string& file, std::span<const std::string> others, std::mt19937_64& random) {
  Mutation mutation(file, others, random);
  for (std::size_t left = 1 + random() % 4; left > 0; --left) mutation.once();
  return mutation.take();
}

}  // namespace marey::faults
