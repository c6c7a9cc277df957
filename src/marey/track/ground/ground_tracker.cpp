#include "marey/track/ground/ground_tracker.h"

#include "marey/core/error.h"
#include "marey/track/ground/ground_gnn.h"
#include "marey/track/ground/ground_jpda.h"
#include "marey/track/ground/mht/ground_mht.h"

namespace marey::track::ground {
namespace {

void check(bool good, const char* name, double value, const char* domain) {
  if (!good) throw Error("the ground tracker's {} is {}; it must be {}", name, value, domain);
}

void check(const GroundTrackerOptions& o) {
  check(o.gate_probability > 0 && o.gate_probability < 1, "gate_probability", o.gate_probability, "between 0 and 1");
  check(o.max_speed > 0, "max_speed", o.max_speed, "positive");
  check(o.detected > 0 && o.detected < 1, "detected", o.detected, "between 0 and 1");
  check(o.clutter > 0, "clutter", o.clutter, "positive");
  check(o.births > 0, "births", o.births, "positive");
  check(o.disagreement >= 0, "disagreement", o.disagreement, "0 or more");
  check(o.patience >= 0, "patience", o.patience, "0 or more");
  check(o.hypotheses > 0, "hypotheses", o.hypotheses, "positive");
  check(o.window >= 0, "window", o.window, "0 or more");
}

}  // namespace

GroundAssociation ground_association_named(std::string_view name) {
  if (name == "gnn") return GroundAssociation::gnn;
  if (name == "jpda") return GroundAssociation::jpda;
  if (name == "mht") return GroundAssociation::mht;
  throw Error("association \"{}\" is not known; choose one of gnn, jpda, mht", name);
}

std::unique_ptr<GroundTracker> make_ground_tracker(const GroundTrackerOptions& options, std::shared_ptr<const GroundViews> views) {
  check(options);
  if (views == nullptr || views->cameras() == 0) throw Error("no camera sees the ground; calibrate one over it");
  switch (options.associate) {
    case GroundAssociation::mht:
      return mht::make_ground_mht(options, std::move(views));
    case GroundAssociation::jpda:
      return make_ground_jpda(options, std::move(views));
    case GroundAssociation::gnn:
      break;
  }
  return make_ground_gnn(options, std::move(views));
}

}  // namespace marey::track::ground
