// Where people stand, on video as a match's cameras show it: blur, halo, smeared chroma, blocks, a shadow under and between the
// shoes. Two of the football stand's cameras, 7.4 m up: 3072 × 1728, and 1280 × 720 for people of 20 to 40 px. The truth is the
// point on the ground between the soles. Evaluated is every person who stands alone and whole in the image: how many rows too low
// the place lies (mean, median), by height, and how far off it is on the ground, by distance. Beside it: the lowest pixel's ray, as
// one places people in an afternoon; and how many rows too far the boxes' lower and upper edges reach beyond the figure.
//   feet [FRAMES (24)] [SEEDS (1)] [sweep]
#include <algorithm>
#include <array>
#include <cmath>
#include <cstdlib>
#include <cstring>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include <fmt/core.h>

#include "marey/detect/detectors.h"
#include "marey/detect/people/person_size_map.h"
#include "marey/geometry/median.h"
#include "marey/reconstruct/person_view.h"
#include "marey/reconstruct/place_people.h"
#include "marey/simulate/match/match_camera.h"

namespace marey {
namespace {

using simulate::match::kMatchPeople;

constexpr double kContact = 0.5, kShadow = 0.8, kNoise = 1.2;  // of the scene
constexpr int kBefore = 7;                                     // images that the scene is learned from
constexpr double kApart_s = 1.7;                               // between images that are evaluated
constexpr double kToe = 0.1;                                   // m, the detector's
constexpr double kAlone = 0.999;                               // visible share

/// The truth of one person in one image, and where it is placed.
struct Standing {
  Vector<2> truth_ground, truth_pixel;
  Box whole;            // px, of the whole figure
  double height = 0;    // px
  double distance = 0;  // m from the camera, on the ground
};

struct Method {
  std::string name;
  std::vector<std::array<double, 4>> off;  // rows too low, height, m off, distance
};

Vector<2> between_soles(const simulate::people::Figure& figure, const simulate::people::Stance& stance) {
  Vector<2> sum = Vector<2>::Zero();
  int ends = 0;
  for (const simulate::people::Limb& limb : simulate::people::pose(figure, stance)) {
    if (limb.part != simulate::people::FigurePart::shoes) continue;
    sum += limb.from.head<2>() + limb.to.head<2>();
    ends += 2;
  }
  return sum / ends;
}

struct Scene {
  simulate::people::ImageDegradation degradation;
  cv::Size size;
  double minimum = 0, maximum = 0;  // px: whose heights are evaluated
};

simulate::match::MatchCamerasOptions stand(cv::Size size) {
  simulate::match::MatchCamerasOptions options;
  options.stand = simulate::match::MatchStand::football;
  options.size = size;
  return options;
}

/// One camera's video, image by image, and what is made of it.
class SweepVideo {
 public:
  SweepVideo(const Scene& scene, std::uint64_t seed)
      : scene_(scene),
        match_(stand(scene.size), seed),
        camera_(*match_.rig.cameras.front().camera()),
        view_(camera_),
        motion_(seed, match_.options.pitch),
        video_(view_, match_.world_from_pitch, match_.options.pitch, video_options(scene.degradation), seed) {
    detect::people::PeopleDetectorOptions options;
    options.people.sizes = std::make_shared<detect::people::PersonSizeMap>(scene.size, [this](double x, double y) {
      std::optional<detect::people::PersonSize> size;
      const auto location = view_.location({x, y});
      if (!location || (location->ground - camera_.centre().head<2>()).norm() > 120) return size;
      const auto box = reconstruct::person_box(camera_, {location->ground.x(), location->ground.y(), 0});
      if (box && box->height >= 8) size = detect::people::PersonSize{box->height, box->width};
      return size;
    });
    detector_ = detect::make_detector(options);
    std::vector<Frame> samples;
    for (int i = 0; i < kBefore; ++i) samples.push_back(next());
    detector_->prime(samples);
  }

  static simulate::match::MatchVideoOptions video_options(const simulate::people::ImageDegradation& degradation) {
    simulate::match::MatchVideoOptions options;
    options.noise = kNoise;
    options.shadow_level = kShadow;
    options.contact = kContact;
    options.degradation = degradation;
    return options;
  }

  /// The next image, who is in it, and what is detected there.
  void step() {
    frame_ = next();
    people_.clear();
    std::vector<Expected> expected;
    const auto stances = match_.stances(motion_.people());
    for (const auto& detected : simulate::match::people_in_view(view_, match_.figures, stances)) {
      expected.push_back({detected.shown});
      const bool whole = detected.shown.height == detected.whole.height && detected.shown.width == detected.whole.width;
      if (!whole || detected.visible_fraction < kAlone) continue;
      Standing one;
      const auto person = static_cast<std::size_t>(detected.person);
      one.truth_ground = between_soles(match_.figures[person], stances[person]);
      one.truth_pixel = *view_.pixel(one.truth_ground);
      one.whole = detected.whole;
      one.height = detected.whole.height;
      one.distance = (one.truth_ground - camera_.centre().head<2>()).norm();
      if (one.height >= scene_.minimum && one.height < scene_.maximum) people_.push_back(one);
    }
    found_ = detector_->detect(frame_, expected);
  }

  void evaluate_lowest(Method& method) const {
    for (const Detection& one : found_.detections) {
      if (const auto location = view_.location(one.box.foot()); location && !one.group) assess(one.box, location->ground, method);
    }
  }

  /// Rows by which edges of boxes reach too far.
  void evaluate_edges(Method& below, Method& above) const {
    for (const Detection& one : found_.detections) {
      const Standing* person = one.group ? nullptr : nearest_to(one.box);
      if (person == nullptr) continue;
      below.off.push_back({one.box.bottom() - person->whole.bottom(), person->height, 0, person->distance});
      above.off.push_back({person->whole.top - one.box.top, person->height, 0, person->distance});
    }
  }

  void assess(const reconstruct::LocalisePeopleOptions& options, Method& method) const {
    const auto located = reconstruct::localise_people(found_.detections, view_, CameraId{0}, options);
    for (std::size_t i = 0; i < located.detected.size(); ++i) {
      if (!located.detected[i].shared) assess(*located.detected[i].box, located.detected[i].value, method);
    }
  }

 private:
  Frame next() {
    time_ += kApart_s;
    motion_.advance(time_);
    Frame frame;
    frame.index = index_++;
    frame.time = timestamp_from_seconds(time_);
    frame.image = video_.render(match_.figures, match_.stances(motion_.people()), time_, frame.index);
    return frame;
  }

  /// A detection is the person's whose feet are nearest to its foot.
  const Standing* nearest_to(const Box& box) const {
    const Standing* nearest = nullptr;
    double minimum = 0;
    for (const Standing& one : people_) {
      const Vector<2> apart = (one.truth_pixel - box.foot()) / one.height;
      if (std::abs(apart.x()) > 0.25 || std::abs(apart.y()) > 0.4) continue;
      if (nearest != nullptr && apart.norm() >= minimum) continue;
      nearest = &one, minimum = apart.norm();
    }
    return nearest;
  }

  void assess(const Box& box, const Vector<2>& ground, Method& method) const {
    const Standing* nearest = nearest_to(box);
    const auto pixel = view_.pixel(ground);
    if (nearest == nullptr || !pixel) return;
    method.off.push_back(
        {pixel->y() - nearest->truth_pixel.y(), nearest->height, (ground - nearest->truth_ground).norm(), nearest->distance});
  }

  Scene scene_;
  simulate::match::MatchScene match_;
  Camera camera_;
  GroundView view_;
  simulate::match::MatchMotion motion_;
  simulate::match::MatchRenderer video_;
  std::unique_ptr<detect::Detector> detector_;
  double time_ = 0;
  std::int64_t index_ = 0;
  Frame frame_;
  detect::Detections found_;
  std::vector<Standing> people_;
};

void print(const Method& method) {
  std::string line = fmt::format("{:<24}", method.name);
  constexpr std::array kHeights{20.0, 40.0, 80.0, 120.0, 200.0};
  for (std::size_t i = 0; i + 1 < kHeights.size(); ++i) {
    std::vector<double> rows;
    double sum = 0;
    for (const auto& off : method.off) {
      if (off[1] < kHeights[i] || off[1] >= kHeights[i + 1]) continue;
      rows.push_back(off[0]);
      sum += off[0];
    }
    line += fmt::format(" |{:4} {:6.2f} {:6.2f}", rows.size(), rows.empty() ? 0 : sum / static_cast<double>(rows.size()),
                        geometry::median_or(rows, 0));
  }
  for (const double distance : {20.0, 40.0, 65.0}) {
    std::vector<double> metres;
    for (const auto& off : method.off) {
      if (off[3] > distance - 5 && off[3] < distance + 5 && off[1] >= 30) metres.push_back(off[2]);
    }
    line += fmt::format(" |{:4} {:5.2f}", metres.size(), geometry::median_or(metres, 0));
  }
  fmt::print("{}\n", line);
}

/// What is compared: how boxes are placed.
struct Variant {
  Method method;
  reconstruct::LocalisePeopleOptions locating = {.toe = kToe};
};

std::vector<Variant> variants(bool sweep) {
  std::vector<Variant> all{{{"box, toe and head", {}}}};
  if (!sweep) return all;
  const auto add = [&](const std::string& name, double value, auto option) {
    Variant& one = all.emplace_back();
    one.method.name = fmt::format("{} {:g}", name, value);
    one.locating.*option = value;
  };
  for (const double v : {0.02, 0.03, 0.06}) add("edge noise", v, &reconstruct::LocalisePeopleOptions::edge_noise);
  for (const double v : {0.0, 0.05, 0.15}) add("toe", v, &reconstruct::LocalisePeopleOptions::toe);
  for (const double v : {0.06, 0.15, 0.25}) add("height spread", v, &reconstruct::LocalisePeopleOptions::height_spread);
  return all;
}

void run(const simulate::people::ImageDegradation& degradation, int frames, int seeds, bool sweep) {
  Method lowest{"lowest pixel", {}}, below{"lower edge", {}}, above{"upper edge", {}};
  std::vector<Variant> all = variants(sweep);
  const std::array kScenes{Scene{degradation, {3072, 1728}, 40, 200}, Scene{degradation, {1280, 720}, 20, 40}};
  for (const Scene& scene : kScenes) {
    for (int seed = 1; seed <= seeds; ++seed) {
      SweepVideo video(scene, static_cast<std::uint64_t>(seed));
      for (int i = 0; i < frames; ++i) {
        video.step();
        video.evaluate_lowest(lowest);
        video.evaluate_edges(below, above);
        for (Variant& one : all) video.assess(one.locating, one.method);
      }
    }
  }
  fmt::print("{} frames, {} seeds; blur {} px, halo {} over {} px, chroma {} px late by {}, quantizer {}, contact {}, noise {}\n",
             frames, seeds, degradation.blur, degradation.halo, degradation.halo_px, degradation.chroma_bleed,
             degradation.chroma_shift, degradation.quantizer, kContact, kNoise);
  fmt::print("{:<24} |  20-40 px: n, mean, median of rows too low | 40-80 | 80-120 | 120-200 | at 20 m: n, m | 40 m | 65 m\n", "");
  for (const Method* one : {&below, &above, &lowest}) print(*one);
  for (const Variant& one : all) print(one.method);
}

}  // namespace
}  // namespace marey

int main(int count, char** words) {
  const int frames = count > 1 ? std::atoi(words[1]) : 24, seeds = count > 2 ? std::atoi(words[2]) : 1;
  const bool sweep = count > 3 && std::strcmp(words[3], "sweep") == 0;
  const marey::simulate::people::ImageDegradation smeared{1.2, 0.8, 3, 6, 4, 8};
  for (const auto& degradation : {marey::simulate::people::ImageDegradation::recorded(), smeared})
    marey::run(degradation, frames, seeds, sweep);
  return 0;
}
