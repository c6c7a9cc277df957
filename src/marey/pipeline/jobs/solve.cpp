#include "marey/pipeline/jobs/solve.h"

#include <fmt/format.h>

#include "marey/analyse/gait/body_marker_sets.h"
#include "marey/format/skeleton/rig_names.h"

namespace marey::pipeline::jobs {
namespace {

format::UpAxis axis_of(const std::string& name) {
  return name == "y" ? format::UpAxis::y : format::UpAxis::z;
}

void add_skeleton_rows(Table& table, Solve& job) {
  bodies::SolveOptions& how = job.options;
  table.input_file("skeleton", job.skeleton,
                   "OpenSim's .osim, Vicon's .vsk, .bvh, .asf, or a skeleton.toml (docs/skeleton.md); omitted: the human skeleton");
  table.input_file("static-trial", how.static_trial,
                   "the person standing still. With a marker set of the field it makes the human skeleton, where no --skeleton is "
                   "given; beside --skeleton and --calibrate it says where joints are straight; without either it is made from "
                   "RECORDING alone: from its body keypoints, or, less surely, from its "
                   "markers");
  table
      .text("marker-set", how.marker_set,
            "whose labels --static-trial, or RECORDING without one, has: plug-in-gait, cmu-41, helen-hayes or cleveland-clinic; "
            "omitted: found by the labels")
      .checked([](const std::string& name) { analyse::gait::body_marker_set(name); });
  table
      .input_file("rom-trial", how.motion,
                  "beside --static-trial: the same person moving hips, knees and elbows through their range; states where the "
                  "joints are")
      .needing("static-trial");
  table.text("person", how.person, "of several people whose body keypoints RECORDING has the one to solve: P2; omitted: the first");
  table.flag("calibrate", how.calibrate,
             "first fit the skeleton's sizes and its markers' places to the person, from RECORDING itself");
  table.flag("smooth", how.smooth, "a second pass over the whole motion: what was hidden is bent to both ends");
  table
      .texts("calibration-take", how.calibration_takes,
             "another recording of the same person with the same markers, for --calibrate; may be given often")
      .needing("calibrate");
  table.number("mass", how.mass_kg, "kg", {1, 500}, "the person's mass, for the masses of --write-skeleton's .osim");
  table
      .output_file(
          "write-skeleton", how.write_skeleton,
          "the skeleton that was used: skeleton.toml, or, of an OpenSim model, .osim with its bodies scaled and markers moved")
      .ending_in({".toml", ".osim"});
  table.texts("exclude", how.exclude, "a marker that is not used, by its label; may be given often");
  table.choice("up", job.up, {"y", "z"},
               "the axis that is up in RECORDING; omitted: y for a TRC file beside an OpenSim model, else as it states, else z");
}

void add_bvh_rows(Table& table, Solve& job) {
  bodies::SolveOptions& how = job.options;
  table.group("BVH");
  table.number("unit", how.read_skeleton.unit_m, "m", above(0, 1000),
               "one unit of a BVH skeleton that is read, in metres: 0.01 is cm, 0.0254 inches");
  table.choice("skeleton-up", job.skeleton_up, {"y", "z"}, "the axis that is up in a BVH, ASF or VSK skeleton");
  format::skeleton::BoneOutput& bones = how.bones;
  table.number("bvh-unit", bones.bvh_unit_m, "m", above(0, 1000),
               "one unit of a BVH file that is written; omitted: 0.01, or as --rig-names has it");
  table.choice("bvh-up", job.bvh_up, {"y", "z"},
               "the axis that is up in a BVH file that is written; omitted: y, or as --rig-names has it");
  table.choice("bvh-order", bones.bvh_order, {"ZXY", "ZYX", "XYZ", "XZY", "YXZ", "YZX"},
               "the order of its rotations; omitted: ZXY, or as --rig-names has it");
  table.group("");
  table
      .text("rig-names", bones.rig_names,
            fmt::format("whose bones .bvh and .glb have (names, rest pose, BVH's unit, axis and rotation order): {}; omitted: the "
                        "skeleton's own",
                        format::skeleton::rig_scheme_names()))
      .checked([](const std::string& name) { format::skeleton::rig_scheme(name); });
}

}  // namespace

Table table_of(Solve& job) {
  Table table;
  add_skeleton_rows(table, job);
  add_bvh_rows(table, job);
  return table;
}

bodies::SolveOptions resolved(const Solve& job) {
  bodies::SolveOptions options = job.options;
  if (!job.skeleton.empty() && !options.static_trial.empty() && !options.calibrate)
    throw WrongOption("{}", "--static-trial: makes a skeleton, and --skeleton is one; give one of the two, or --calibrate too");
  if (!job.skeleton.empty() && !options.static_trial.empty() && !job.skeleton.ends_with(".osim"))
    throw WrongOption("{}", "--static-trial: beside --skeleton it is for an OpenSim model (.osim); omit one of the two");
  if (!job.skeleton.empty() && !options.motion.empty())
    throw WrongOption("{}", "--rom-trial: is for the human skeleton, and --skeleton is one; give it as --calibration-take");
  if (options.mass_kg && !options.write_skeleton.ends_with(".osim"))
    throw WrongOption("{}", "--mass: is for --write-skeleton FILE.osim");
  if (!options.marker_set.empty() && !job.skeleton.empty())
    throw WrongOption("{}", "--marker-set: is for the human skeleton, and --skeleton is one; give one of the two");
  if (!job.up.empty()) options.up = axis_of(job.up);
  options.read_skeleton.up = axis_of(job.skeleton_up);
  if (!job.bvh_up.empty()) options.bones.bvh_up = axis_of(job.bvh_up);
  return options;
}

}  // namespace marey::pipeline::jobs
