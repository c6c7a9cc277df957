#include "marey/calibrate/solve.h"

#include "marey/core/stop.h"

namespace marey::calibrate {
namespace {

class EndWhenRequested final : public ceres::IterationCallback {
 public:
  ceres::CallbackReturnType operator()(const ceres::IterationSummary& /*step*/) override {
    return StopScope::current().stop_requested() ? ceres::SOLVER_ABORT : ceres::SOLVER_CONTINUE;
  }
};

}  // namespace

ceres::Solver::Summary solve(ceres::Solver::Options how, ceres::Problem& problem) {
  EndWhenRequested callback;
  how.callbacks.push_back(&callback);
  how.num_threads = 1;
  how.logging_type = ceres::SILENT;
  ceres::Solver::Summary summary;
  ceres::Solve(how, &problem, &summary);
  stop_point();
  return summary;
}

}  // namespace marey::calibrate
