#pragma once

#include <string>
#include <string_view>

namespace marey::detect::keypoints {

/// Where a network that script/model makes lies: in the folder that the environment variable MAREY_MODELS names, else in `models`
/// or `share/marey/models` beside or above the program or library that holds this. Throws Error, naming script/model, where it is
/// not there.
std::string model_file(std::string_view name);

/// The landmark network "lite", "full" or "heavy"; what ends in .onnx is a file.
std::string landmark_model(std::string_view name);

}  // namespace marey::detect::keypoints
