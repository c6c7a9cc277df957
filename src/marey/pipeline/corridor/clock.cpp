#include "marey/pipeline/corridor/clock.h"

#include <algorithm>
#include <utility>

#include "marey/pipeline/corridor/frame_grouping.h"

namespace marey::pipeline::corridor {

Clock::Clock(std::vector<Feed> feeds, const ClockOptions& options)
    : grouping_(options.live ? group_live(std::move(feeds), options) : group_files(std::move(feeds), options)) {}

Clock::~Clock() = default;
Clock::Clock(Clock&&) noexcept = default;
Clock& Clock::operator=(Clock&&) noexcept = default;

std::optional<FrameSet> Clock::next() {
  return grouping_->next();
}

double Clock::rate_hz() const {
  return grouping_->rate_hz();
}

const std::vector<Feed>& Clock::feeds() const {
  return grouping_->feeds();
}

std::vector<Feed>& Clock::feeds() {
  return grouping_->feeds();
}

std::int64_t Clock::frames(std::size_t number) const {
  return grouping_->lane(number).frames;
}

std::int64_t Clock::missed(std::size_t number) const {
  return grouping_->lane(number).missed;
}

std::optional<LiveDrops> Clock::drops() const {
  return grouping_->drops();
}

std::vector<FeedState> Clock::states() const {
  return grouping_->states();
}

const StageTimes& Clock::decoding() const {
  return grouping_->decoding();
}

const StageTimes& Clock::detecting() const {
  return grouping_->detecting();
}

std::optional<std::int64_t> Clock::count() const {
  return feeds().empty() ? std::nullopt : feeds().front().info().frame_count;
}

bool Clock::can_rewind() const {
  return std::all_of(feeds().begin(), feeds().end(), [](const Feed& feed) { return feed.can_rewind(); });
}

Clock Clock::again() const {
  std::vector<Feed> feeds;
  for (const Feed& feed : this->feeds()) feeds.push_back(feed.again());
  ClockOptions options = grouping_->options();
  options.interpolate = false;
  return Clock(std::move(feeds), options);
}

std::vector<std::string> Clock::warnings() const {
  std::vector<std::string> all;
  for (const Feed& feed : feeds()) {
    for (std::string& warning : feed.warnings()) all.push_back(std::move(warning));
  }
  return all;
}

}  // namespace marey::pipeline::corridor
