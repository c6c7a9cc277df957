#include "marey/source/region_source.h"

#include <fmt/format.h>

#include "marey/core/error.h"

namespace marey::source {
namespace {

class RegionSource final : public Source {
 public:
  RegionSource(std::unique_ptr<Source> source, const cv::Rect& region) : source_(std::move(source)), region_(region) {
    info_ = source_->info();
    const cv::Rect whole({}, info_.size);
    if (region.width <= 0 || region.height <= 0 || (region & whole) != region) {
      throw Error("{}: the region [{}, {}, {}, {}] does not lie within its images of {}×{} px; correct it in the rig", info_.name,
                  region.x, region.y, region.width, region.height, info_.size.width, info_.size.height);
    }
    info_.size = region.size();
  }

  const SourceInfo& info() const override { return info_; }

  std::optional<Frame> next() override {
    auto frame = source_->next();
    while (frame && !frame->image.empty() && (region_ & cv::Rect({}, frame->image.size())) != region_) {
      ++excluded_;
      frame = source_->next();
    }
    if (frame && !frame->image.empty()) frame->image = frame->image.part(region_);
    return frame;
  }

  std::vector<std::string> warnings() const override {
    auto all = source_->warnings();
    if (excluded_ > 0) {
      all.push_back(fmt::format("{}: {} images were too small for the camera's region and were omitted", info_.name, excluded_));
    }
    return all;
  }

 private:
  std::unique_ptr<Source> source_;
  cv::Rect region_;
  SourceInfo info_;
  std::int64_t excluded_ = 0;
};

}  // namespace

std::unique_ptr<Source> crop(std::unique_ptr<Source> source, cv::Rect region) {
  return std::make_unique<RegionSource>(std::move(source), region);
}

}  // namespace marey::source
