#include "marey/pipeline/people/image_log.h"

#include <utility>

#include "marey/pipeline/people/image_rows.h"
#include "marey/track/offline/fill_gaps.h"

namespace marey::pipeline::people {

ImageLog::ImageLog(bool contours, std::string spill_path, bool with_lines)
    : with_contours_(contours), spill_path_(std::move(spill_path)), with_lines_(with_lines), contours_(new_contours()) {}

std::unique_ptr<track::offline::OutlineLog> ImageLog::new_contours() const {
  return with_contours_ ? std::make_unique<track::offline::OutlineLog>(spill_path_, with_lines_) : nullptr;
}

void ImageLog::add_searched(const Frame& frame) {
  searched_.push_back(static_cast<std::int32_t>(time_steps_.size()));
  time_steps_.push_back({frame.index, frame.time});
}

Timestamp ImageLog::time_of(std::int64_t number) const {
  return time_steps_[static_cast<std::size_t>(searched_[static_cast<std::size_t>(number)])].time;
}

void ImageLog::add(std::int64_t number, std::span<const Track<2>> tracks, std::span<const track::image::Clothes> clothes,
                   const geometry::Similarity2& view_from_scene) {
  tracks_.add(number, time_of(number), tracks, clothes, view_from_scene);
  if (contours_) contours_->add(number, tracks);
}

ImageLog::Tracked ImageLog::begin_again() {
  Tracked first{std::exchange(tracks_, {}), std::move(contours_)};
  contours_ = new_contours();
  return first;
}

void ImageLog::restore(Tracked tracked) {
  tracks_ = std::move(tracked.tracks);
  contours_ = std::move(tracked.contours);
}

std::unique_ptr<corridor::InstantSource> ImageLog::finish(const track::offline::JoinOptions& options,
                                                          track::offline::JoinReport& report, bool observed_only) {
  std::vector<track::offline::TrackRow> rows = track::offline::join(tracks_, options, &report);
  if (searched_.size() < time_steps_.size()) {
    std::vector<Timestamp> times;
    times.reserve(time_steps_.size());
    for (const Recording::TimeStep& time_step : time_steps_) times.push_back(time_step.time);
    rows = track::offline::fill_between_searches(rows, searched_, times);
  }
  return instants_of(std::move(rows), std::move(time_steps_), contours_.get(), observed_only);
}

}  // namespace marey::pipeline::people
