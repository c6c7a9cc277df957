#pragma once

#include <memory>
#include <string>
#include <string_view>
#include <variant>

#include "marey/detect/detector.h"
#include "marey/detect/markers/marker_detector.h"
#include "marey/detect/network/network_options.h"
#include "marey/detect/people/people.h"

namespace marey::detect {

/// The register of detectors that process images: which one, with its parameters. A new one is named here and made in
/// detectors.cpp, which does not compile before. Detections that another program found come through a source (pipeline).
using DetectorOptions = std::variant<people::PeopleDetectorOptions, markers::MarkerOptions, network::NetworkDetectorOptions>;

std::unique_ptr<Detector> make_detector(const DetectorOptions& options);

/// The detectors' names with commas between, in the order of the register.
std::string detector_names();

/// The default options of the detector called `name`. Throws Error with the list of names if it does not exist.
DetectorOptions detector_named(std::string_view name);

std::string_view name_of(const DetectorOptions& options);

/// What a detector of people takes their sizes from; nothing of one that finds something else.
people::PeopleOptions* people_options_of(DetectorOptions& options);

}  // namespace marey::detect
