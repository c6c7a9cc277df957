#include "marey/pipeline/jobs/augment.h"

namespace marey::pipeline::jobs {

Table table_of(Augment& job) {
  Table table;
  table.number("height", job.height_m, "m", {0.5, 2.6}, "the person's height; always wanted");
  table.number("mass", job.mass_kg, "kg", {2, 500}, "the person's mass; always wanted");
  table
      .output_file("angles", job.angles,
                   "angles of hips, knees, ankles, ... at every instant with one standard deviation, degrees: .csv")
      .ending_in({".csv"});
  table.text("person", job.options.person, "of several people whose body keypoints RECORDING has the one: P2; omitted: the first");
  table.choice("hips", job.hips, {"keypoints", "joints"},
               "what RECORDING's hips are: as networks for keypoints have them, or the joints' centres, as a simulation or a "
               "marker-based model has them");
  table.choice("up", job.up, {"y", "z"}, "the axis that is up in RECORDING; omitted: as it states, else z");
  return table;
}

bodies::AugmentOptions resolved(const Augment& job) {
  bodies::AugmentOptions options = job.options;
  if (!job.height_m || !job.mass_kg)
    throw WrongOption("--{}: is wanted; the networks take the person's height and mass", job.height_m ? "mass" : "height");
  options.height_m = *job.height_m;
  options.mass_kg = *job.mass_kg;
  options.hips = job.hips == "joints" ? keypoints::HipPoints::joint_centres : keypoints::HipPoints::as_networks;
  if (!job.up.empty()) options.up = job.up == "y" ? format::UpAxis::y : format::UpAxis::z;
  return options;
}

}  // namespace marey::pipeline::jobs
