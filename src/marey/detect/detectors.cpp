#include "marey/detect/detectors.h"

#include <array>
#include <optional>
#include <utility>

#include "marey/core/error.h"
#include "marey/detect/network/network_detector.h"

namespace marey::detect {
namespace {

std::unique_ptr<Detector> make(const people::PeopleDetectorOptions& options) {
  return std::make_unique<people::PeopleDetector>(background::make_background(options.background), options.people);
}

std::unique_ptr<Detector> make(const markers::MarkerOptions& options) {
  return std::make_unique<markers::MarkerDetector>(options);
}

std::unique_ptr<Detector> make(const network::NetworkDetectorOptions& options) {
  return std::make_unique<network::NetworkDetector>(options);
}

template <std::size_t... I>
std::array<DetectorOptions, sizeof...(I)> defaults(std::index_sequence<I...>) {
  return {std::variant_alternative_t<I, DetectorOptions>{}...};
}

auto all_defaults() {
  return defaults(std::make_index_sequence<std::variant_size_v<DetectorOptions>>());
}

}  // namespace

std::unique_ptr<Detector> make_detector(const DetectorOptions& options) {
  return std::visit([](const auto& chosen) { return make(chosen); }, options);
}

std::string detector_names() {
  std::string names;
  for (const DetectorOptions& options : all_defaults()) {
    if (!names.empty()) names += ", ";
    names += name_of(options);
  }
  return names;
}

DetectorOptions detector_named(std::string_view name) {
  for (DetectorOptions& options : all_defaults()) {
    if (name_of(options) == name) return std::move(options);
  }
  throw Error("detector \"{}\" is not known; choose one of {}", name, detector_names());
}

std::string_view name_of(const DetectorOptions& options) {
  return std::visit([](const auto& chosen) { return std::string_view(chosen.name); }, options);
}

people::PeopleOptions* people_options_of(DetectorOptions& options) {
  if (auto* people = std::get_if<people::PeopleDetectorOptions>(&options)) return &people->people;
  if (auto* network = std::get_if<network::NetworkDetectorOptions>(&options)) return &network->people.people;
  return nullptr;
}

}  // namespace marey::detect
