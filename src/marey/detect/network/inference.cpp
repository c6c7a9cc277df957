#include "marey/detect/network/inference.h"

#include <algorithm>
#include <atomic>
#include <exception>
#include <fstream>
#include <iterator>
#include <optional>
#include <utility>

#include <opencv2/core/utils/logger.hpp>
#include <opencv2/dnn.hpp>

#include "marey/core/error.h"
#include "marey/detect/network/half_weights.h"
#include "marey/detect/network/onnx_graph.h"
#include "marey/detect/network/own_network.h"

namespace marey::detect::network {
namespace {

constexpr int kMaxThreads = 16;  // numerical, memory alone: each holds the network once

/// OpenCV writes to standard error what it also throws: not while this lives.
class QuietOpenCv {
 public:
  QuietOpenCv() : before_(cv::utils::logging::setLogLevel(cv::utils::logging::LOG_LEVEL_SILENT)) {}
  ~QuietOpenCv() { cv::utils::logging::setLogLevel(before_); }
  QuietOpenCv(const QuietOpenCv&) = delete;
  QuietOpenCv& operator=(const QuietOpenCv&) = delete;

 private:
  cv::utils::logging::LogLevel before_;
};

Tensor tensor_of(const cv::Mat& values, const std::string& name) {
  Tensor tensor;
  tensor.name = name;
  for (int i = 0; i < values.dims; ++i) tensor.shape.push_back(values.size[i]);
  cv::Mat numbers;
  values.convertTo(numbers, CV_32F);
  tensor.values.assign(numbers.ptr<float>(), numbers.ptr<float>() + numbers.total());
  return tensor;
}

std::string content_of(const std::string& path) {
  std::ifstream file(path, std::ios::binary);
  if (!file) throw Error("{}: cannot be read", path);
  return {std::istreambuf_iterator<char>(file), std::istreambuf_iterator<char>()};
}

}  // namespace

/// Own loops where they have all of the network's layers, else OpenCV's.
struct Inference::Engine::Net {
  std::string content;
  std::optional<OnnxGraph> graph;
  std::optional<OwnNetwork> own;
  std::vector<int> sizes;             // of the input that `own` is for, and ...
  std::vector<std::string> required;  // ... its outputs
  std::optional<cv::dnn::Net> net;
  std::vector<std::string> outputs;

  void load() {
    net = cv::dnn::readNetFromONNX(content.data(), content.size());
    net->setPreferableBackend(cv::dnn::DNN_BACKEND_OPENCV);
    outputs = net->getUnconnectedOutLayersNames();
  }

  /// Whether own loops do it.
  bool prepare(const cv::Mat& blob, std::span<const std::string> names) {
    if (!graph || names.empty()) return false;
    const std::vector<int> now(blob.size.p, blob.size.p + blob.dims);
    if (now == sizes && std::equal(names.begin(), names.end(), required.begin(), required.end())) return own.has_value();
    sizes = now;
    required.assign(names.begin(), names.end());
    own.reset();
    if (auto plan = layer_plan(*graph, now, names)) own.emplace(std::move(*plan));
    return own.has_value();
  }
};

Inference::Engine::Engine(const std::string& onnx) : net_(std::make_unique<Net>()) {
  net_->content = with_full_weights(content_of(onnx));
  net_->graph = onnx_graph(net_->content);
  if (net_->graph && has_known_layers(*net_->graph)) {
    net_->outputs = net_->graph->outputs;
  } else {
    net_->load();
  }
}

Inference::Engine::~Engine() = default;

std::vector<Tensor> Inference::Engine::run(const cv::Mat& blob, std::span<const std::string> required) {
  const std::vector<std::string> names =
      required.empty() ? net_->outputs : std::vector<std::string>(required.begin(), required.end());
  if (net_->prepare(blob, names)) return net_->own->run(blob.ptr<float>());
  if (!net_->net) net_->load();
  net_->net->setInput(blob);
  std::vector<cv::Mat> outputs;
  net_->net->forward(outputs, required.empty() ? net_->outputs : names);
  std::vector<Tensor> tensors;
  for (std::size_t i = 0; i < outputs.size(); ++i) tensors.push_back(tensor_of(outputs[i], names[i]));
  return tensors;
}

std::unique_ptr<Inference::Engine> Inference::load() const {
  try {
    return std::make_unique<Engine>(onnx_);
  } catch (const cv::Exception& error) {
    throw Error("{}: cannot be loaded as an ONNX network ({}); {}", onnx_, reason_of(error), remedy_);
  }
}

Inference::Inference(std::string onnx, std::string remedy) : onnx_(std::move(onnx)), remedy_(std::move(remedy)) {
  const QuietOpenCv quiet;
  engines_.push_back(load());
}

Inference::~Inference() = default;
Inference::Inference(Inference&&) noexcept = default;

void Inference::each(std::size_t count, const std::function<void(Engine&, std::size_t)>& work) {
  const QuietOpenCv quiet;
  const auto threads = std::min<std::size_t>(count, static_cast<std::size_t>(std::clamp(cv::getNumThreads(), 1, kMaxThreads)));
  while (engines_.size() < threads) engines_.push_back(load());
  std::vector<std::exception_ptr> failed(threads);
  std::atomic<std::size_t> next = 0;
  const auto fraction_of = [&](std::size_t thread) {
    try {
      for (std::size_t i = next++; i < count; i = next++) work(*engines_[thread], i);
    } catch (...) {
      failed[thread] = std::current_exception();
    }
  };
  if (threads == 1) {
    fraction_of(0);
  } else if (threads > 1) {  // within it OpenCV computes each network on one thread
    cv::parallel_for_(
        cv::Range(0, static_cast<int>(threads)),
        [&](const cv::Range& range) {
          for (int i = range.start; i < range.end; ++i) fraction_of(static_cast<std::size_t>(i));
        },
        static_cast<double>(threads));
  }
  for (const std::exception_ptr& error : failed) {
    if (error) std::rethrow_exception(error);
  }
}

std::string reason_of(const cv::Exception& error) {
  std::string text = error.err.empty() ? error.what() : error.err;
  return text.substr(0, std::min<std::size_t>(text.find('\n'), 160));
}

}  // namespace marey::detect::network
