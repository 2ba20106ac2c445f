// SPDX-License-Identifier: MIT
#include "least_cut.hpp"

#include <algorithm>
#include <cmath>

// GCC takes the iterators' boost::optional for read before it is set.
#pragma GCC diagnostic push
#pragma GCC diagnostic ignored "-Wmaybe-uninitialized"
#include <boost/graph/adjacency_list.hpp>
#include <boost/graph/boykov_kolmogorov_max_flow.hpp>
#pragma GCC diagnostic pop

namespace papilla::param_detail {
namespace {

using Traits = boost::adjacency_list_traits<boost::vecS, boost::vecS, boost::directedS>;
using Network = boost::adjacency_list<
    boost::vecS, boost::vecS, boost::directedS,
    boost::property<
        boost::vertex_index_t, long,
        boost::property<boost::vertex_color_t, boost::default_color_type,
                        boost::property<boost::vertex_distance_t, long,
                                        boost::property<boost::vertex_predecessor_t, Traits::edge_descriptor>>>>,
    boost::property<boost::edge_capacity_t, double,
                    boost::property<boost::edge_residual_capacity_t, double,
                                    boost::property<boost::edge_reverse_t, Traits::edge_descriptor>>>>;

/// More than all finite costs together: what no cut goes through.
double beyond_all(const std::vector<LabelCost>& items, const std::vector<LabelPair>& pairs) {
  double sum = 1;
  const auto add = [&](double cost) { sum += std::isfinite(cost) ? std::abs(cost) : 0; };
  for (const LabelCost& item : items) add(item.first), add(item.second);
  for (const LabelPair& pair : pairs) add(pair.cost);
  return 2 * sum;
}

}  // namespace

std::vector<char> least_cut(const std::vector<LabelCost>& items, const std::vector<LabelPair>& pairs) {
  const std::size_t source = items.size(), sink = source + 1;
  Network network(sink + 1);
  const auto capacity = boost::get(boost::edge_capacity, network);
  const auto reverse = boost::get(boost::edge_reverse, network);
  const auto connect = [&](std::size_t a, std::size_t b, double there, double back) {
    const auto out = boost::add_edge(a, b, network).first, in = boost::add_edge(b, a, network).first;
    capacity[out] = there, capacity[in] = back;
    reverse[out] = in, reverse[in] = out;
  };
  const double most = beyond_all(items, pairs);
  for (std::size_t i = 0; i < items.size(); ++i) {
    const double dearer = std::clamp(items[i].second - items[i].first, -most, most);
    dearer > 0 ? connect(source, i, dearer, 0) : connect(i, sink, -dearer, 0);
  }
  for (const LabelPair& pair : pairs) connect(pair.a, pair.b, pair.cost, pair.cost);
  boost::boykov_kolmogorov_max_flow(network, source, sink);
  const auto colour = boost::get(boost::vertex_color, network);
  std::vector<char> second(items.size());
  for (std::size_t i = 0; i < items.size(); ++i) second[i] = colour[i] != colour[source];
  return second;
}

}  // namespace papilla::param_detail
