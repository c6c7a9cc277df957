#include "marey/pipeline/people/ground/ground_again.h"

#include <algorithm>
#include <functional>
#include <utility>

#include <fmt/format.h>

#include "marey/core/error.h"
#include "marey/pipeline/corridor/clock.h"

namespace marey::pipeline::people::ground {
namespace {

class GroundAgain final : public PeopleOnGround {
 public:
  GroundAgain(const std::vector<corridor::Feed>& feeds, const Rig& rig, const PeopleOnGroundOptions& options)
      : rig_(rig), options_(options), stage_(people_on_ground(feeds, rig, options)) {
    for (const corridor::Feed& feed : feeds) openers_.push_back(options.live ? std::function<corridor::Feed()>() : feed.opener());
  }

  RecordingHeader header() const override { return stage_->header(); }
  void need_boxes() override {
    needs_boxes_ = true;
    stage_->need_boxes();
  }
  const std::vector<analyse::Teams::Team>& teams() const override { return stage_->teams(); }
  std::vector<std::shared_ptr<StandingPeople>> standing() const override { return stage_->standing(); }
  std::vector<std::string> news() override { return stage_->news(); }
  std::span<const Instant> step(const FrameSet& frames) override {
    ++frames_;
    return stage_->step(frames);
  }

  std::unique_ptr<corridor::InstantSource> finish(const Hooks& hooks) override {
    found_ = stage_->standing();
    if (may_detect_again() && !hooks.stop.stop_requested()) {
      try {
        detect_again(hooks);
      } catch (const Stopped&) {  // the first result counts
      }
    }
    return stage_->finish(hooks);
  }

  void report(corridor::Summary& summary) const override {
    stage_->report(summary);
    for (std::size_t i = 0; i < found_.size(); ++i) {
      if (found_[i] == nullptr) continue;
      if (again_ && found_[i]->since_beginning() > 0) {
        const int count = found_[i]->since_beginning();
        summary.notes.push_back(corridor::stated_of(
            rig_.cameras[i],
            fmt::format("{} still from the first frame on and left later: tracked from the first frame on, in a second "
                        "pass over the video",
                        count == 1 ? "1 person stood" : fmt::format("{} people stood", count))));
      } else if (!again_) {
        for (const std::string& message_text : found_[i]->stated())
          summary.notes.push_back(corridor::stated_of(rig_.cameras[i], message_text));
      }
    }
  }

 private:
  /// Not with a ball: in a scene that was corrected, the remainder of people's borders was followed as one.
  bool may_detect_again() const {
    return !options_.ball && std::any_of(found_.begin(), found_.end(), [](const auto& one) {
      return one != nullptr && one->since_beginning() > 0;
    }) && std::all_of(openers_.begin(), openers_.end(), [](const auto& opener) { return static_cast<bool>(opener); });
  }

  void detect_again(const Hooks& hooks) {
    std::vector<corridor::Feed> feeds;
    for (const auto& opener : openers_) feeds.push_back(opener());
    PeopleOnGroundOptions options = options_;
    options.without.assign(found_.begin(), found_.end());
    auto stage = people_on_ground(feeds, rig_, options);
    if (needs_boxes_) stage->need_boxes();
    corridor::Clock clock(std::move(feeds));
    for (std::int64_t done = 0; done < frames_; ++done) {
      const auto frames = clock.next();
      if (!frames || hooks.report({"looking again", done, frames_}) == Continue::no) return;
      stage->step(*frames);
    }
    stage_ = std::move(stage);
    again_ = true;
  }

  Rig rig_;
  PeopleOnGroundOptions options_;
  std::unique_ptr<PeopleOnGround> stage_;
  std::vector<std::function<corridor::Feed()>> openers_;
  std::vector<std::shared_ptr<StandingPeople>> found_;
  std::int64_t frames_ = 0;
  bool needs_boxes_ = false, again_ = false;
};

}  // namespace

std::unique_ptr<PeopleOnGround> people_on_ground_again(const std::vector<corridor::Feed>& feeds, const Rig& rig,
                                                       const PeopleOnGroundOptions& options) {
  return std::make_unique<GroundAgain>(feeds, rig, options);
}

}  // namespace marey::pipeline::people::ground
