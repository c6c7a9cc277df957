// The score is a likelihood ratio against all being false: an observation taken for the ball counts by its density where the ball
// is expected, over that of false things all over the image, and by its appearance; an expected ball not seen costs. Nothing
// may be one's ball for nothing: a ball that is lost has ratio 1. Hypotheses that came to the same (mode, holder, observation
// last, nearly the same place and velocity) are one: the better one. That is Viterbi's step; the beam is what it omits. Reid
// 1979, "An algorithm for tracking multiple targets"; here with one target, whose motion switches. Cost: beam × 6 × views × things
// seen an instant.
#include "marey/track/ball/ball_search.h"

#include <algorithm>
#include <cmath>
#include <iterator>
#include <utility>

#include "marey/track/ball/ball_birth.h"
#include "marey/track/ball/ball_clutter.h"

namespace marey::track::ball {
namespace {

/// What one hypothesis becomes before anything is seen.
struct Continuation {
  BallMode mode;
  BallEvent event;
  int holder;
  double log_prior;
};

const BallPerson* person_at(const BallObservations& time_step, int index) {
  return index < 0 ? nullptr : &time_step.people[static_cast<std::size_t>(index)];
}

/// People whose feet reach a place, nearest first.
std::vector<int> people_near(const BallObservations& time_step, const Vector<2>& location, double reach) {
  std::vector<std::pair<double, int>> near;
  for (std::size_t i = 0; i < time_step.people.size(); ++i) {
    const double away = (time_step.people[i].location - location).norm();
    if (away < reach) near.emplace_back(away, static_cast<int>(i));
  }
  std::sort(near.begin(), near.end());
  std::vector<int> people;
  for (std::size_t i = 0; i < std::min<std::size_t>(3, near.size()); ++i) people.push_back(near[i].second);
  return people;
}

/// The same person at this instant; −1 where it is not there.
int index_of(TrackId id, const BallObservations& time_step) {
  for (std::size_t i = 0; i < time_step.people.size(); ++i) {
    if (time_step.people[i].id == id) return static_cast<int>(i);
  }
  return -1;
}

constexpr double kOverhead = 2.6;  // m; higher, no person plays it

std::vector<Continuation> continuations(const BallNode& before, const BallObservations& time_step,
                                        const BallSearchOptions& options) {
  const int holder = before.step.holder ? index_of(*before.step.holder, time_step) : -1;
  const BallBelief& belief = before.step.belief;
  const double spread = std::sqrt(belief.covariance(0, 0) + belief.covariance(1, 1));
  const auto near = people_near(time_step, belief.location().head<2>(), options.reach + std::min(1.5, spread));
  const bool reached = !near.empty() && belief.location().z() - std::sqrt(belief.covariance(2, 2)) < kOverhead;
  const double kick = std::log(reached || before.step.mode == BallMode::held ? options.p_kick : options.p_kick_alone);
  std::vector<Continuation> all{{BallMode::lost, BallEvent::none, -1, std::log(options.p_lose)},
                                {BallMode::flying, BallEvent::kick, -1, kick},
                                {BallMode::rolling, BallEvent::kick, -1, kick}};
  if (reached) {
    for (const int person : near) {
      if (person != holder) all.push_back({BallMode::held, BallEvent::take, person, std::log(options.p_take)});
    }
  }
  const double sigma_z = std::sqrt(belief.covariance(2, 2));
  switch (before.step.mode) {
    case BallMode::rolling:
      all.push_back({BallMode::rolling, BallEvent::none, -1, 0});
      break;
    case BallMode::flying:
      all.push_back({BallMode::flying, BallEvent::none, -1, 0});
      if (belief.velocity().z() < 0 && belief.location().z() - 3 * sigma_z < 1) {
        all.push_back({BallMode::flying, BallEvent::bounce, -1, std::log(0.1)});
        all.push_back({BallMode::rolling, BallEvent::land, -1, std::log(0.05)});
      }
      break;
    case BallMode::held:
      if (holder >= 0) all.push_back({BallMode::held, BallEvent::none, holder, 0});
      break;
    case BallMode::lost:
      break;
  }
  return all;
}

bool on_person(const BallView& view, const Vector<2>& pixel) {
  const auto holds = [&](const Box& person) {
    const Box box = limbs_of(person);
    return pixel.x() > box.left && pixel.x() < box.right() && pixel.y() > box.top && pixel.y() < box.bottom();
  };
  return std::any_of(view.people.begin(), view.people.end(), holds);
}

double fraction_found(BallMode mode, const BallView& view, const Vector<2>& pixel, const BallSearchOptions& options) {
  if (on_person(view, pixel)) return options.found_hidden;
  return mode == BallMode::held ? options.found_held : options.found;
}

/// What a thing seen adds, whose density where it is would be `density` (a logarithm) if it were the ball. On people it may add
/// nothing, only cost: limbs continue as predictably as a ball does.
double weight(const BallSighting& sighting, double density, double found, double false_density) {
  const double ratio = sighting.score + density - false_density;
  return sighting.on_person ? -std::log1p(std::exp(-ratio)) : std::log(found) + ratio;
}

/// What is within the gate, the nearest first.
std::vector<int> gated(const BallView& view, const BallProjection& at, const BallSearchOptions& options) {
  std::vector<std::pair<double, int>> within;
  for (std::size_t i = 0; i < view.detected.size(); ++i) {
    const BallSighting& sighting = view.detected[i];
    const Vector<2> off = sighting.pixel - at.pixel;
    const Matrix<2> spread = at.spread + sighting.sigma * sighting.sigma * Matrix<2>::Identity();
    const double determinant = spread.determinant();
    const double squared =
        (spread(1, 1) * off.x() * off.x() - 2 * spread(0, 1) * off.x() * off.y() + spread(0, 0) * off.y() * off.y()) / determinant;
    if (squared < options.gate * options.gate) within.emplace_back(squared - 2 * sighting.score, static_cast<int>(i));
  }
  std::sort(within.begin(), within.end());
  std::vector<int> indices;
  for (std::size_t i = 0; i < std::min(within.size(), static_cast<std::size_t>(options.branches)); ++i)
    indices.push_back(within[i].second);
  return indices;
}

/// Each case in which one more camera may have seen it.
void inspect(const std::vector<BallNode>& all, const BallView& view, const GroundView& ground, const BallSearchOptions& options,
             std::vector<BallNode>& out) {
  for (const BallNode& node : all) {
    BallNode missed = node;
    missed.step.used.push_back(-1);
    const auto at = project(node.step.belief, ground);
    if (!at || !ground.camera()->in_image(at->pixel)) {
      out.push_back(std::move(missed));
      continue;
    }
    const double found = fraction_found(node.step.mode, view, at->pixel, options);
    for (const int i : gated(view, *at, options)) {
      const BallSighting& sighting = view.detected[static_cast<std::size_t>(i)];
      BallNode detected = node;
      detected.step.used.push_back(i);
      const double density = correct(detected.step.belief, *at, sighting);
      const double more = weight(sighting, density, found, false_density(sighting, view, ground, options));
      detected.score += more;
      if (!sighting.on_person && at->radius >= options.min_radius) detected.step.evidence += more;
      out.push_back(std::move(detected));
    }
    missed.score += std::log(1 - found);
    out.push_back(std::move(missed));
  }
}

bool is_possible(const Vector<3>& location, const BallSearchOptions& options) {
  return !options.possible || options.possible(location.head<2>());
}

BallStep lost_step(const BallObservations& time_step) {
  BallStep step;
  step.used.assign(time_step.views.size(), -1);
  return step;
}

bool same(const BallNode& a, const BallNode& b) {
  if (a.step.mode != b.step.mode || a.step.holder != b.step.holder) return false;
  if (a.step.mode == BallMode::lost) return true;
  constexpr double kSamePosition = 0.15, kSameVelocity = 0.7, kSameHeld = 0.3;  // m, m/s, m
  const double away = (a.step.belief.location() - b.step.belief.location()).norm();
  if (a.step.mode == BallMode::held) return away < kSameHeld;
  return away < kSamePosition && (a.step.belief.velocity() - b.step.belief.velocity()).norm() < kSameVelocity;
}

}  // namespace

std::vector<BallNode> successors(const std::shared_ptr<BallNode>& before, const BallObservations& time_step, double seconds,
                                 const GroundViews& views, const BallSearchOptions& options) {
  std::vector<BallNode> done;
  if (before->step.mode == BallMode::lost) {
    BallNode lost{before->step, before->score, before, 0};
    lost.step = lost_step(time_step);
    initiate(before, time_step, views, options, done);
    std::erase_if(done, [&](const BallNode& initiated) { return !is_possible(initiated.step.belief.location(), options); });
    done.push_back(std::move(lost));
    return done;
  }
  for (const Continuation& next : continuations(*before, time_step, options)) {
    BallNode node;
    node.parent = before;
    const BallPerson* holder = person_at(time_step, next.holder);
    node.step.mode = next.mode;
    node.step.event = next.event;
    if (holder != nullptr) node.step.holder = holder->id;
    node.score = before->score + next.log_prior;
    node.age = before->age + 1;
    if (next.mode == BallMode::lost) {
      node.step.used.assign(time_step.views.size(), -1);
      done.push_back(std::move(node));
      continue;
    }
    node.step.belief = predict(before->step.belief, next.mode, next.event, seconds, holder, options.motion).belief;
    const double settled = settle(node.step.belief, next.mode, next.event, seconds, holder, options.motion);
    if (settled < -0.5 * options.gate * options.gate || node.step.belief.location().z() < -0.5) continue;
    node.score += next.event == BallEvent::none ? 0 : settled;
    std::vector<BallNode> all{std::move(node)}, inspected;
    for (const BallView& view : time_step.views) {
      inspected.clear();
      inspect(all, view, views.view_at(view.camera, view.time), options, inspected);
      std::swap(all, inspected);
    }
    std::erase_if(all, [&](const BallNode& ball) { return !is_possible(ball.step.belief.location(), options); });
    std::move(all.begin(), all.end(), std::back_inserter(done));
  }
  return done;
}

BallSearch::BallSearch(std::shared_ptr<const GroundViews> views, const BallSearchOptions& options)
    : views_(std::move(views)), options_(options), leaves_{std::make_shared<BallNode>()} {}

void BallSearch::add(const BallObservations& time_step) {
  const double step = last_ ? seconds(time_step.time - *last_) : 0;
  last_ = time_step.time;
  open_.push_back(time_step.time);
  std::vector<BallNode> all;
  for (const auto& leaf : leaves_) {
    std::vector<BallNode> next = successors(leaf, time_step, step, *views_, options_);
    std::move(next.begin(), next.end(), std::back_inserter(all));
  }
  keep_best(std::move(all));
  std::size_t old = 0;
  while (old < open_.size() && seconds(time_step.time - open_[old]) > options_.decide_after) ++old;
  decide(old);
}

/// Half of the beam is for those that were born lately: what was followed long, rightly or not, is ahead of them by all that it
/// saw. So is the best one that is lost, of which others may be born.
void BallSearch::keep_best(std::vector<BallNode> all) {
  constexpr int kYoung = 10;  // instants
  std::stable_sort(all.begin(), all.end(), [](const BallNode& a, const BallNode& b) { return a.score > b.score; });
  leaves_.clear();
  int young = 0, old = 0;
  for (BallNode& node : all) {
    const bool lost = node.step.mode == BallMode::lost;
    int& count = node.age < kYoung ? young : old;
    if (!lost && 2 * count >= options_.beam) continue;
    const bool known = std::any_of(leaves_.begin(), leaves_.end(), [&](const auto& leaf) { return same(*leaf, node); });
    if (known) continue;
    if (!lost) ++count;
    leaves_.push_back(std::make_shared<BallNode>(std::move(node)));
  }
}

/// The first `moments` that are open are as the best leaf has them; others' leaves fall.
void BallSearch::decide(std::size_t time_steps) {
  if (time_steps == 0) return;
  const auto ancestor = [&](const std::shared_ptr<BallNode>& leaf, std::size_t back) {
    std::shared_ptr<BallNode> node = leaf;
    for (std::size_t i = 0; i < back; ++i) node = node->parent;
    return node;
  };
  const std::size_t back = open_.size() - time_steps;
  const auto root = ancestor(leaves_.front(), back);
  std::erase_if(leaves_, [&](const auto& leaf) { return ancestor(leaf, back) != root; });
  std::vector<BallStep> steps;
  std::shared_ptr<BallNode> node = root;
  for (std::size_t i = 0; i < time_steps; ++i, node = node->parent) steps.push_back(node->step);
  std::move(steps.rbegin(), steps.rend(), std::back_inserter(decided_));
  open_.erase(open_.begin(), open_.begin() + static_cast<std::ptrdiff_t>(time_steps));
  root->parent.reset();
}

void BallSearch::finish() {
  decide(open_.size());
}

std::vector<BallStep> BallSearch::take_decided() {
  return std::exchange(decided_, {});
}

}  // namespace marey::track::ball
