#include "process_options.h"

#include <algorithm>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include <opencv2/core/utility.hpp>
#include <tbb/global_control.h>

#include "marey/files/limits.h"

namespace marey::cli {
namespace {

constexpr std::int64_t kMaxLimit = 1'000'000'000'000;
constexpr int kMaxThreads = 1024;

std::string limit_names() {
  std::string text;
  for (const NamedLimit& limit : all_limits()) text += std::string(text.empty() ? "" : ", ") + limit.name;
  return text;
}

/// "tracks=200000".
void put_limit_in_force(const std::string& text) {
  const std::size_t equals = text.find('=');
  const std::string name = text.substr(0, equals);
  const auto limits = all_limits();
  const auto named = std::find_if(limits.begin(), limits.end(), [&](const NamedLimit& limit) { return limit.name == name; });
  if (named == limits.end() || equals == std::string::npos)
    throw Error("\"{}\" must be NAME=N, a limit and its number; limits are: {}", text, limit_names());
  Limits changed = Limits::in_force();
  changed.*named->value = static_cast<std::size_t>(whole_number_in(text.substr(equals + 1), named->meaning, 1, kMaxLimit));
  Limits::put_in_force(changed);
}

std::string limits_with_their_numbers() {
  std::string text;
  for (const NamedLimit& limit : all_limits())
    text += fmt::format("{}{} ({})", text.empty() ? "" : ", ", limit.name, Limits::in_force().*limit.value);
  return text;
}

void put_limits_in_force(const std::string& text) {
  for (std::size_t begin = 0; begin <= text.size();) {
    const std::size_t end = std::min(text.find(',', begin), text.size());
    put_limit_in_force(text.substr(begin, end - begin));
    begin = end + 1;
  }
}

void compute_with(const std::string& text) {
  const auto threads = whole_number_in(text, "N", 1, kMaxThreads);
  static std::unique_ptr<tbb::global_control> control;
  control = std::make_unique<tbb::global_control>(tbb::global_control::max_allowed_parallelism, static_cast<std::size_t>(threads));
  cv::setNumThreads(static_cast<int>(threads));
}

}  // namespace

void add_process_options(Command& command) {
  struct Given {
    std::string limits;
    std::optional<int> threads;
  };
  static std::vector<std::unique_ptr<Given>> given;  // options are bound to what lives as long as the program
  Given& its = *given.emplace_back(std::make_unique<Given>());
  command.text("--limit", its.limits, "NAME=N,..., what one input may ask for at most: " + limits_with_their_numbers())
      .check(put_limits_in_force);
  command.whole("--threads", its.threads, "N", 1, kMaxThreads, "that compute at once; results are the same for any number")
      .check(compute_with);
}

}  // namespace marey::cli
