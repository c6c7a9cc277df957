#include "marey/detect/network/model_file.h"

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <fstream>
#include <iterator>

#include <fmt/format.h>
#include <toml++/toml.h>

#include "marey/core/error.h"

namespace marey::detect::network {
namespace {

constexpr int kMinInput = 16, kMaxInput = 4096;  // px, format of the file (docs/network.md)
constexpr std::size_t kMaxFile = 1 << 16;        // bytes, format

[[noreturn]] void refuse(const std::string& path, const toml::node* node, const std::string& message_text) {
  throw Error("{}:{}: {}", path, node == nullptr ? 1 : std::max<unsigned>(1, node->source().begin.line), message_text);
}

class ModelTable {
 public:
  ModelTable(const toml::table& table, const std::string& path) : table_(table), path_(path) {}

  const toml::node* at(std::string_view key) const { return table_.get(key); }

  std::optional<double> number(std::string_view key, double low, double high) const {
    const toml::node* node = at(key);
    if (node == nullptr) return std::nullopt;
    return checked(*node, key, low, high);
  }

  template <std::size_t N>
  std::optional<std::array<double, N>> numbers(std::string_view key, double low, double high) const {
    const toml::node* node = at(key);
    if (node == nullptr) return std::nullopt;
    const toml::array* list = node->as_array();
    if (list == nullptr || list->size() != N) refuse(path_, node, fmt::format("{} must be a list of {} numbers", key, N));
    std::array<double, N> values{};
    for (std::size_t i = 0; i < N; ++i) values[i] = checked(*list->get(i), key, low, high);
    return values;
  }

  std::optional<std::string> text(std::string_view key) const {
    const toml::node* node = at(key);
    if (node == nullptr) return std::nullopt;
    const auto value = node->value<std::string>();
    if (!value || value->empty()) refuse(path_, node, fmt::format("{} must be a text", key));
    return value;
  }

  void knows_only(std::initializer_list<std::string_view> keys) const {
    for (const auto& [key, value] : table_) {
      if (std::find(keys.begin(), keys.end(), key.str()) == keys.end())
        refuse(path_, &value, fmt::format("{} is not a setting of a model; these are: {}", key.str(), fmt::join(keys, ", ")));
    }
  }

 private:
  double checked(const toml::node& node, std::string_view key, double low, double high) const {
    const auto value = node.value<double>();
    if (!value || !(*value >= low && *value <= high))
      refuse(path_, &node, fmt::format("{} must be a number in [{}, {}]", key, low, high));
    return *value;
  }

  const toml::table& table_;
  const std::string& path_;
};

std::optional<NetworkModel::Resize> resize_of(const ModelTable& table, const std::string& path) {
  const auto text = table.text("resize");
  if (!text) return std::nullopt;
  if (*text == "stretch") return NetworkModel::Resize::segment;
  if (*text == "letterbox") return NetworkModel::Resize::letterbox;
  if (*text == "corner") return NetworkModel::Resize::corner;
  refuse(path, table.at("resize"), "resize must be stretch, letterbox or corner");
}

NetworkModel model_of(const ModelTable& table, const std::string& path) {
  table.knows_only({"network", "input", "layout", "resize", "colours", "scale", "mean", "deviation", "person", "score"});
  NetworkModel model;
  model.path = path;
  const auto network = table.text("network");
  if (!network) refuse(path, nullptr, "network is missing: the ONNX file, beside this one");
  model.network = (std::filesystem::path(path).parent_path() / *network).string();
  const auto input = table.numbers<2>("input", kMinInput, kMaxInput);
  if (!input) refuse(path, nullptr, "input is missing: [width, height] in px of the image that the network wants");
  model.input = {static_cast<int>(std::lround((*input)[0])), static_cast<int>(std::lround((*input)[1]))};
  if (const auto layout = table.text("layout")) {
    model.layout = layout_named(*layout);
    if (!model.layout) refuse(path, table.at("layout"), fmt::format("layout must be one of {}", layout_names()));
  }
  model.resize = resize_of(table, path);
  if (const auto colours = table.text("colours")) {
    if (*colours != "rgb" && *colours != "bgr") refuse(path, table.at("colours"), "colours must be rgb or bgr");
    model.rgb = *colours == "rgb";
  }
  model.scale = table.number("scale", 1e-9, 1e3);
  model.mean = table.numbers<3>("mean", -1e3, 1e3);
  model.deviation = table.numbers<3>("deviation", 1e-6, 1e3);
  model.person = static_cast<int>(table.number("person", 0, 10000).value_or(0));
  model.score = table.number("score", 0.01, 0.99).value_or(model.score);
  return model;
}

}  // namespace

NetworkModel parse_network_model(const std::string& text, const std::string& path) {
  try {
    const toml::table table = toml::parse(text, path);
    return model_of(ModelTable(table, path), path);
  } catch (const toml::parse_error& error) {
    throw Error("{}:{}: {}", path, std::max<unsigned>(1, error.source().begin.line), error.description());
  }
}

NetworkModel read_network_model(const std::string& path) {
  std::ifstream in(path, std::ios::binary);
  std::string text(std::istreambuf_iterator<char>(in), {});
  if (!in) throw Error("{}: cannot be read; give the TOML file that describes a detection network (docs/network.md)", path);
  if (text.size() > kMaxFile || text.find('\0') != std::string::npos)
    throw Error("{}: is not a description of a detection network but something else; give the TOML file beside the network", path);
  return parse_network_model(text, path);
}

}  // namespace marey::detect::network
