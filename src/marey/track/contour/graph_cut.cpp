// Alpha expansion (Boykov, Veksler & Zabih, "Fast approximate energy minimization via graph cuts", 2001): every cell keeps its
// label or takes α, whichever cut is the cheapest; one label after the other until none helps. The maximum flow is Boykov &
// Kolmogorov's, of Boost.Graph. The terms of two neighbours become edges as in Kolmogorov & Zabih, "What energy functions can be
// minimized via graph cuts?", 2004.
#include "marey/track/contour/graph_cut.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <vector>

#include <boost/graph/adjacency_list.hpp>
#include <boost/graph/boykov_kolmogorov_max_flow.hpp>

namespace marey::track::contour {
namespace {

constexpr int kMaxRounds = 4;    // numerical
constexpr double kUnits = 1000;  // of a cost: numerical, flows are whole numbers, so that the result is the same everywhere

std::int64_t units(float cost) {
  return std::llround(kUnits * static_cast<double>(cost));
}

/// A directed graph with capacities, as Boost's maximum flow wants it.
class FlowNetwork {
 public:
  explicit FlowNetwork(std::size_t nodes) : graph_(nodes + 2), source_(nodes), sink_(nodes + 1) {}

  void add(std::size_t from, std::size_t to, std::int64_t there, std::int64_t back) {
    const Edge forth = boost::add_edge(from, to, Link{.capacity = there}, graph_).first;
    const Edge reverse = boost::add_edge(to, from, Link{.capacity = back}, graph_).first;
    graph_[forth].reverse = reverse;
    graph_[reverse].reverse = forth;
  }
  /// `kept` is paid where the node stays with the source, `changed` where it goes to the sink.
  void add_terminal(std::size_t node, std::int64_t kept, std::int64_t changed) {
    const std::int64_t least = std::min(kept, changed);
    add(source_, node, changed - least, 0);
    add(node, sink_, kept - least, 0);
  }

  /// Which nodes are the sink's after the cheapest cut.
  std::vector<bool> cut() {
    const std::size_t count = boost::num_vertices(graph_);
    std::vector<boost::default_color_type> colours(count);
    std::vector<Edge> predecessors(count);
    std::vector<std::size_t> distances(count);
    const auto index = boost::get(boost::vertex_index, graph_);
    boost::boykov_kolmogorov_max_flow(
        graph_, boost::get(&Link::capacity, graph_), boost::get(&Link::residual, graph_), boost::get(&Link::reverse, graph_),
        boost::make_iterator_property_map(predecessors.begin(), index), boost::make_iterator_property_map(colours.begin(), index),
        boost::make_iterator_property_map(distances.begin(), index), index, source_, sink_);
    std::vector<bool> at_sink(count - 2);
    for (std::size_t i = 0; i < at_sink.size(); ++i) at_sink[i] = colours[i] == boost::white_color;
    return at_sink;
  }

 private:
  using Traits = boost::adjacency_list_traits<boost::vecS, boost::vecS, boost::directedS>;
  using Edge = Traits::edge_descriptor;
  struct Link {
    std::int64_t capacity = 0, residual = 0;
    Edge reverse = {};
  };
  boost::adjacency_list<boost::vecS, boost::vecS, boost::directedS, boost::no_property, Link> graph_;
  std::size_t source_, sink_;
};

/// One expansion of a label; whether the energy fell.
bool expand(std::span<const cv::Mat> costs, const NeighbourVotes& neighbours, float smoothness, int label, cv::Mat& labels) {
  const auto columns = static_cast<std::size_t>(labels.cols);
  const auto node = [&](const cv::Point& at) { return static_cast<std::size_t>(at.y) * columns + static_cast<std::size_t>(at.x); };
  std::vector<std::int64_t> kept(labels.total()), changed(labels.total());
  for (int y = 0; y < labels.rows; ++y) {
    for (int x = 0; x < labels.cols; ++x) {
      kept[node({x, y})] = units(costs[labels.at<std::uint8_t>(y, x)].at<float>(y, x));
      changed[node({x, y})] = units(costs[static_cast<std::size_t>(label)].at<float>(y, x));
    }
  }
  FlowNetwork network(labels.total());
  neighbours.for_pairs([&](const cv::Point& a, const cv::Point& b, float weight) {
    const int from = labels.at<std::uint8_t>(a), to = labels.at<std::uint8_t>(b);
    if (from == label && to == label) return;
    const std::int64_t one = units(smoothness * weight);
    // What the pair costs if both keep their labels, if only the second does, if only the first does.
    const std::int64_t both = from != to ? one : 0, second = to != label ? one : 0, first = from != label ? one : 0;
    changed[node(a)] += second - both;
    changed[node(b)] -= second;
    network.add(node(a), node(b), first + second - both, 0);
  });
  for (std::size_t i = 0; i < kept.size(); ++i) network.add_terminal(i, kept[i], changed[i]);
  const std::vector<bool> at_sink = network.cut();
  const cv::Mat before = labels.clone();
  for (std::size_t i = 0; i < at_sink.size(); ++i) {
    if (at_sink[i])
      labels.at<std::uint8_t>(static_cast<int>(i / columns), static_cast<int>(i % columns)) = static_cast<std::uint8_t>(label);
  }
  constexpr double kFalls = 0.01;  // numerical: the rounding of flows
  if (label_energy(costs, neighbours, smoothness, labels) < label_energy(costs, neighbours, smoothness, before) - kFalls)
    return true;
  before.copyTo(labels);
  return false;
}

}  // namespace

double label_energy(std::span<const cv::Mat> costs, const NeighbourVotes& neighbours, float smoothness, const cv::Mat& labels) {
  double sum = 0;
  for (int y = 0; y < labels.rows; ++y) {
    for (int x = 0; x < labels.cols; ++x) sum += costs[labels.at<std::uint8_t>(y, x)].at<float>(y, x);
  }
  neighbours.for_pairs([&](const cv::Point& a, const cv::Point& b, float weight) {
    if (labels.at<std::uint8_t>(a) != labels.at<std::uint8_t>(b)) sum += smoothness * weight;
  });
  return sum;
}

cv::Mat cut_labels(std::span<const cv::Mat> costs, const NeighbourVotes& neighbours, float smoothness) {
  cv::Mat labels(costs.front().size(), CV_8UC1, cv::Scalar(0)), least = costs.front().clone();
  for (std::size_t l = 1; l < costs.size(); ++l) {
    labels.setTo(static_cast<double>(l), costs[l] < least);
    cv::min(least, costs[l], least);
  }
  for (int round = 0; round < kMaxRounds; ++round) {
    bool fell = false;
    for (int l = 0; l < static_cast<int>(costs.size()); ++l) fell = expand(costs, neighbours, smoothness, l, labels) || fell;
    if (!fell) break;
  }
  return labels;
}

}  // namespace marey::track::contour
