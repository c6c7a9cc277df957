#include "marey/pipeline/calibrate/calibrate_wand.h"

#include "job.h"

namespace marey::python {
namespace {

nb::dict dict_of(const calibrate::FitQuality& fit) {
  nb::dict dict;
  dict["mean_px"] = fit.mean_px;
  dict["rms_px"] = fit.rms_px;
  dict["inliers"] = fit.inliers;
  dict["observations"] = fit.observations;
  return dict;
}

nb::tuple calibrate_wand(nb::dict given) {
  const Options options(std::move(given));
  const Rig rig = rig_of(options);
  pipeline::calibrate::CalibrateWandOptions how;
  how.observations = options.get<std::string>("observations", {});
  how.wand.distances = options.get<std::vector<double>>("distances", {});
  how.synced = options.get("synced", false);
  how.how.seed = options.get<std::uint64_t>("seed", 1);
  how.markers.threshold = options.find<double>("threshold");
  how.markers.dark = options.get("dark", false);
  const auto found =
      run_job(listening_of(options), [&](const Hooks& hooks) { return pipeline::calibrate::calibrate_wand(rig, how, hooks); });
  const calibrate::RigReport& report = found.found.report;
  nb::dict dict, cameras;
  dict["all"] = dict_of(report.all);
  dict["noise_px"] = report.noise_px;
  for (const calibrate::CameraReport& camera : report.cameras) cameras[camera.name.c_str()] = dict_of(camera.fit);
  dict["cameras"] = cameras;
  dict["grade"] = report.grade;
  dict["grade_text"] = report.meaning;
  dict["notes"] = found.found.notes;
  dict["warnings"] = found.warnings;
  return nb::make_tuple(found.found.rig, dict);
}

}  // namespace

void bind_calibrations(nb::module_& module) {
  module.def("calibrate_wand", &calibrate_wand, nb::arg("options"));
}

}  // namespace marey::python
