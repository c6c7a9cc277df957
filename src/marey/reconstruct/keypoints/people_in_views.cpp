#include "marey/reconstruct/keypoints/people_in_views.h"

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>

#include "marey/core/keypoint_sets.h"
#include "marey/reconstruct/keypoints/ray_pair.h"

namespace marey::reconstruct::keypoints {
namespace {

constexpr double kOneStep_s = 1;       // longer steps are a cut: every person is where he was, and may be anywhere near
constexpr double kForget_s = 0.5;      // a keypoint that was not seen for this long is not expected anywhere
constexpr double kSamePerson_m = 0.3;  // mean distance of keypoints below which a start is a known person's
constexpr double kMinLength_m = 0.08, kMaxLength_m = 0.75;  // of thighs, shanks, upper arms and forearms, of a child and of a giant
constexpr double kSoundBones = 0.7;                         // share

constexpr std::array<std::pair<const char*, const char*>, 8> kMeasuredBones{{{"left_hip", "left_knee"},
                                                                             {"right_hip", "right_knee"},
                                                                             {"left_knee", "left_ankle"},
                                                                             {"right_knee", "right_ankle"},
                                                                             {"left_shoulder", "left_elbow"},
                                                                             {"right_shoulder", "right_elbow"},
                                                                             {"left_elbow", "left_wrist"},
                                                                             {"right_elbow", "right_wrist"}}};

}  // namespace

PeopleInViews::PeopleInViews(const KeypointSet& set, int cameras, const PeopleOptions& options)
    : set_(set), cameras_(cameras), options_(options), triangulator_(options.triangulate), limbs_(limbs_of(set)) {
  for (const auto& [from, to] : kMeasuredBones) {
    const auto a = point_named(set, from), b = point_named(set, to);
    if (a && b) lengths_.emplace_back(*a, *b);
  }
}

const std::vector<LocatedPerson>& PeopleInViews::step(double seconds, std::span<const PersonView> views) {
  if (seconds > kOneStep_s) people_.clear();
  for (Person& person : people_) expect(person, seconds);
  views_observed_ += std::ssize(views);
  taken_.assign(views.size(), 0);
  give_views(views);
  begin_people(views);
  located_.clear();
  for (std::size_t p = 0; p < people_.size(); ++p) {
    if (auto located = location(people_[p], views, given_[p], seconds)) located_.push_back(std::move(*located));
  }
  std::erase_if(people_, [&](const Person& person) { return person.unobserved_s > options_.lost_s; });
  return located_;
}

void PeopleInViews::expect(Person& person, double seconds) const {
  person.unobserved_s += seconds;
  for (auto& point : person.points) {
    if (!point) continue;
    point->position += seconds * point->velocity;
    point->unobserved_s += seconds;
    if (point->unobserved_s > kForget_s && person.unobserved_s < kForget_s) point.reset();
  }
}

std::optional<double> PeopleInViews::point_misfit(const Point& point, const SightLine& line) const {
  const double depth = line.depth(point.position);
  const double bound = options_.bound * options_.bound;
  if (depth <= 0.1) return bound;
  const double location = options_.position_m + options_.position_m_s * point.unobserved_s;
  const double spread = location * line.scale() / depth;
  return std::min(bound, line.error(point.position).squaredNorm() / (2 * (line.sigma * line.sigma + spread * spread)));
}

/// Mean square of the bounded errors, in standard deviations; nothing if too few points are in common.
std::optional<double> PeopleInViews::misfit(const Person& person, const PersonView& view) const {
  double sum = 0;
  int count = 0;
  for (std::size_t i = 0; i < view.points.size(); ++i) {
    if (!view.points[i] || !person.points[i]) continue;
    sum += *point_misfit(*person.points[i], *view.points[i]);
    ++count;
  }
  if (count < options_.min_points) return std::nullopt;
  return sum / count;
}

void PeopleInViews::give_views(std::span<const PersonView> views) {
  given_.assign(people_.size(), {});
  std::vector<assign::GatedPair> pairs;
  std::vector<int> columns;
  const double gate = options_.gate * options_.gate;
  for (int camera = 0; camera < cameras_; ++camera) {
    pairs.clear();
    columns.clear();
    for (int v = 0; v < std::ssize(views); ++v) {
      if (views[static_cast<std::size_t>(v)].camera != camera) continue;
      for (int p = 0; p < std::ssize(people_); ++p) {
        const auto cost = misfit(people_[static_cast<std::size_t>(p)], views[static_cast<std::size_t>(v)]);
        if (cost && *cost < gate) pairs.push_back({p, static_cast<int>(columns.size()), gate - *cost});
      }
      columns.push_back(v);
    }
    const auto column_of = assigner_.assign(static_cast<int>(people_.size()), static_cast<int>(columns.size()), pairs);
    for (std::size_t p = 0; p < people_.size(); ++p) {
      if (column_of[p] == assign::kNoIndex) continue;
      const int view = columns[static_cast<std::size_t>(column_of[p])];
      given_[p].push_back(view);
      taken_[static_cast<std::size_t>(view)] = 1;
    }
  }
}

std::optional<PeopleInViews::Start> PeopleInViews::start_of(const PersonView& a, const PersonView& b) const {
  Start start;
  start.points.resize(set_.points.size());
  const double bound = options_.bound * options_.bound;
  int count = 0, met = 0;
  for (std::size_t i = 0; i < set_.points.size(); ++i) {
    if (!a.points[i] || !b.points[i]) continue;
    ++count;
    const auto pair = pass_of(*a.points[i], *b.points[i]);
    start.cost += pair ? std::min(bound, pair->square) : bound;
    if (!pair || pair->square >= bound) continue;
    start.points[i] = Point{.position = pair->position};
    ++met;
  }
  if (met < options_.min_points) return std::nullopt;
  start.cost /= count;
  if (start.cost > options_.pair_gate * options_.pair_gate || !is_body(start.points)) return std::nullopt;
  return start;
}

bool PeopleInViews::is_body(const std::vector<std::optional<Point>>& points) const {
  int bones = 0, sound = 0;
  for (const auto& [a, b] : lengths_) {
    const auto &from = points[static_cast<std::size_t>(a)], &to = points[static_cast<std::size_t>(b)];
    if (!from || !to) continue;
    const double length = (from->position - to->position).norm();
    ++bones;
    sound += length > kMinLength_m && length < kMaxLength_m ? 1 : 0;
  }
  return sound >= kSoundBones * bones;
}

/// Takes in the views of other cameras that see the same.
void PeopleInViews::extend(Start& start, std::span<const PersonView> views) const {
  const Person person{.points = start.points};
  for (int camera = 0; camera < cameras_; ++camera) {
    int best = -1;
    double minimum = options_.gate * options_.gate;
    bool has = false;
    for (int v = 0; v < std::ssize(views); ++v) {
      if (views[static_cast<std::size_t>(v)].camera != camera) continue;
      has |= std::find(start.views.begin(), start.views.end(), v) != start.views.end();
      if (taken_[static_cast<std::size_t>(v)] != 0) continue;
      const auto cost = misfit(person, views[static_cast<std::size_t>(v)]);
      if (cost && *cost < minimum) {
        minimum = *cost;
        best = v;
      }
    }
    if (!has && best >= 0) start.views.push_back(best);
  }
}

/// The person who is there already; nothing if no person is.
std::optional<std::size_t> PeopleInViews::known_at(const Start& start) const {
  for (std::size_t p = 0; p < people_.size(); ++p) {
    double sum = 0;
    int count = 0;
    for (std::size_t i = 0; i < start.points.size(); ++i) {
      if (!start.points[i] || !people_[p].points[i]) continue;
      sum += (start.points[i]->position - people_[p].points[i]->position).norm();
      ++count;
    }
    if (count > 0 && sum < kSamePerson_m * count) return p;
  }
  return std::nullopt;
}

void PeopleInViews::begin_people(std::span<const PersonView> views) {
  std::vector<Start> starts;
  for (int a = 0; a < std::ssize(views); ++a) {
    if (taken_[static_cast<std::size_t>(a)] != 0) continue;
    for (int b = a + 1; b < std::ssize(views); ++b) {
      const PersonView &one = views[static_cast<std::size_t>(a)], &other = views[static_cast<std::size_t>(b)];
      if (taken_[static_cast<std::size_t>(b)] != 0 || one.camera == other.camera) continue;
      auto start = start_of(one, other);
      if (!start) continue;
      start->views = {a, b};
      extend(*start, views);
      starts.push_back(std::move(*start));
    }
  }
  std::stable_sort(starts.begin(), starts.end(), [](const Start& a, const Start& b) {
    return a.views.size() != b.views.size() ? a.views.size() > b.views.size() : a.cost < b.cost;
  });
  const auto is_free = [&](const Start& start) {
    return std::none_of(start.views.begin(), start.views.end(), [&](int v) { return taken_[static_cast<std::size_t>(v)] != 0; });
  };
  for (Start& start : starts) {
    if (!is_free(start)) {  // others of its views may be free still
      start.views.resize(2);
      if (!is_free(start)) continue;
      extend(start, views);
    }
    const auto known = known_at(start);
    if (known && given_[*known].size() >= 2) continue;
    for (const int v : start.views) taken_[static_cast<std::size_t>(v)] = 1;
    if (known) {  // they moved farther than was expected
      for (const int v : given_[*known]) taken_[static_cast<std::size_t>(v)] = 0;
      people_[*known].points = std::move(start.points);
      people_[*known].is_new = true;
      given_[*known] = std::move(start.views);
      continue;
    }
    people_.push_back({.id = next_id_++, .unobserved_s = 0, .points = std::move(start.points)});
    given_.push_back(std::move(start.views));
  }
}

void PeopleInViews::find_mirrored(const Person& person, std::span<const PersonView> views, const std::vector<int>& own,
                                  std::vector<Mirrored>& mirrored) const {
  int arms = 0, legs = 0;
  for (const int v : own) {
    const PersonView& view = views[static_cast<std::size_t>(v)];
    std::array<double, 2> gain{0, 0};
    for (std::size_t i = 0; i < view.points.size(); ++i) {
      const auto other = static_cast<std::size_t>(set_.mirrored[i]);
      if (!limbs_[i] || !view.points[i] || !person.points[i] || !person.points[other]) continue;
      gain[static_cast<std::size_t>(*limbs_[i])] +=
          *point_misfit(*person.points[i], *view.points[i]) - *point_misfit(*person.points[other], *view.points[i]);
    }
    const double minimum = options_.swap_gain * options_.swap_gain / 2;
    Mirrored& of = mirrored[static_cast<std::size_t>(view.camera)];
    of = {.arms = gain[0] > minimum, .legs = gain[1] > minimum};
    arms += of.arms ? 1 : 0;
    legs += of.legs ? 1 : 0;
  }
  const int maximum = static_cast<int>(own.size());
  for (Mirrored& of : mirrored) {
    of.arms &= 2 * arms <= maximum;
    of.legs &= 2 * legs <= maximum;
  }
}

void PeopleInViews::triangulate(std::span<const PersonView> views, const std::vector<int>& own, LocatedPerson& located,
                                const Person* expected) const {
  std::array<SightLine, 64> lines;
  for (std::size_t i = 0; i < set_.points.size(); ++i) {
    std::size_t count = 0;
    for (const int v : own) {
      const PersonView& view = views[static_cast<std::size_t>(v)];
      const bool swapped = located.mirrored[static_cast<std::size_t>(view.camera)].of(limbs_[i]);
      const auto& line = view.points[swapped ? static_cast<std::size_t>(set_.mirrored[i]) : i];
      if (line && count < lines.size()) lines[count++] = *line;
    }
    const std::span<const SightLine> rays(lines.data(), count);
    const auto found =
        expected != nullptr && expected->points[i] ? triangulator_(rays, expected->points[i]->position) : triangulator_(rays);
    located.points[i].reset();
    if (const SpacePoint* point = std::get_if<SpacePoint>(&found)) {
      located.points[i] = *point;
      std::uint64_t cameras = 0;
      for (std::size_t r = 0; r < count; ++r) {
        if (point->used >> r & 1) cameras |= std::uint64_t{1} << lines[r].camera;
      }
      located.points[i]->used = cameras;
    }
  }
}

std::optional<LocatedPerson> PeopleInViews::location(Person& person, std::span<const PersonView> views, const std::vector<int>& own,
                                                     double seconds) {
  if (own.size() < 2) return std::nullopt;
  LocatedPerson located{.id = person.id,
                        .views = std::vector<int>(static_cast<std::size_t>(cameras_), -1),
                        .mirrored = std::vector<Mirrored>(static_cast<std::size_t>(cameras_)),
                        .points = std::vector<std::optional<SpacePoint>>(set_.points.size())};
  for (const int v : own) {
    const PersonView& view = views[static_cast<std::size_t>(v)];
    located.views[static_cast<std::size_t>(view.camera)] = view.index;
  }
  views_located_ += std::ssize(own);
  find_mirrored(person, views, own, located.mirrored);
  triangulate(views, own, located, &person);
  learn(person, located, person.is_new ? 0 : seconds);
  person.is_new = false;
  person.unobserved_s = 0;
  return located;
}

/// An alpha-beta filter of each keypoint (Benedict and Bordner's relation of its two gains).
void PeopleInViews::learn(Person& person, const LocatedPerson& located, double seconds) const {
  const double alpha = seconds > 0 ? 1 - std::exp(-seconds / options_.settle_s) : 1, beta = alpha * alpha / (2 - alpha);
  Vector<3> velocity = Vector<3>::Zero();
  int moving = 0;
  for (std::size_t i = 0; i < located.points.size(); ++i) {
    if (!located.points[i]) continue;
    auto& point = person.points[i];
    if (!point || seconds <= 0) {
      point = Point{.position = located.points[i]->position, .velocity = point ? point->velocity : Vector<3>::Zero()};
      continue;
    }
    const Vector<3> ahead = located.points[i]->position - point->position;
    point->position += alpha * ahead;
    point->velocity += beta / seconds * ahead;
    point->unobserved_s = 0;
    velocity += point->velocity;
    ++moving;
  }
  if (moving == 0) return;
  for (auto& point : person.points) {  // what is not seen continues with the body
    if (point && point->unobserved_s > 0) point->velocity += alpha * (velocity / moving - point->velocity);
  }
}

}  // namespace marey::reconstruct::keypoints
