#include "marey/assign/k_best_assignments.h"

#include <algorithm>
#include <functional>
#include <tuple>

namespace marey::assign {
namespace {

constexpr double infinity = std::numeric_limits<double>::infinity();

}  // namespace

std::span<const KBestAssigner::Answer> KBestAssigner::find(std::span<const AssignmentProblem> problems, int maximum,
                                                           double within) {
  clear();
  for (const AssignmentProblem& problem : problems) tabulate(problem);
  answers_.reserve(maximum);
  double limit = -infinity;
  while (!queue_.empty() && static_cast<int>(answers_.size()) < maximum) {
    Part part = pop();
    if (part.gain < limit) break;
    if (!part.solved) {
      if (solve(part)) push(part);
      continue;
    }
    if (answers_.empty()) limit = part.gain - within;
    give_answer(part);
    parts_.push_back(part);
    if (static_cast<int>(answers_.size()) < maximum) split(static_cast<int>(parts_.size()) - 1, limit);
  }
  for (Answer& answer : answers_) {
    const Table& table = tables_[answer.problem];
    answer.column_of_row = std::span(answer_columns_).subspan(answer_at_[&answer - answers_.data()], table.rows);
  }
  return answers_;
}

void KBestAssigner::clear() {
  tables_.clear();
  arcs_.clear();
  row_begin_.clear();
  parts_.clear();
  queue_.clear();
  choices_.clear();
  free_rows_.clear();
  prices_.clear();
  bans_.clear();
  answers_.clear();
  answer_columns_.clear();
  answer_at_.clear();
  arc_banned_.clear();
  age_ = 0;
}

/// Sorts the pairs by row, and puts the whole problem in the queue under the bound that each row has the best of its pairs.
void KBestAssigner::tabulate(const AssignmentProblem& problem) {
  const Table table{problem.rows, problem.columns, row_begin_.size(), problem.gain};
  row_begin_.resize(row_begin_.size() + problem.rows + 1, 0);
  int* begin = row_begin_.data() + table.rows_at;
  for (const GatedPair& pair : problem.pairs) ++begin[pair.row + 1];
  begin[0] = static_cast<int>(arcs_.size());
  for (int row = 0; row < problem.rows; ++row) begin[row + 1] += begin[row];
  arcs_.resize(arcs_.size() + problem.pairs.size());
  fill_.assign(begin, begin + problem.rows);
  for (const GatedPair& pair : problem.pairs) arcs_[fill_[pair.row]++] = {pair.column, -pair.gain};
  double gain = problem.gain;
  for (int row = 0; row < problem.rows; ++row) {
    std::sort(arcs_.begin() + begin[row], arcs_.begin() + begin[row + 1],
              [](const Arc& a, const Arc& b) { return a.column < b.column; });
    double best = 0;
    for (int arc = begin[row]; arc < begin[row + 1]; ++arc) best = std::max(best, -arcs_[arc].cost);
    gain += best;
  }
  arc_banned_.resize(arcs_.size(), 0);
  tables_.push_back(table);
  push({.problem = static_cast<int>(tables_.size()) - 1, .gain = gain});
}

void KBestAssigner::push(const Part& part) {
  queue_.push_back(part);
  queue_.back().age = age_++;
  std::push_heap(queue_.begin(), queue_.end(), is_later);
}

KBestAssigner::Part KBestAssigner::pop() {
  std::pop_heap(queue_.begin(), queue_.end(), is_later);
  const Part part = queue_.back();
  queue_.pop_back();
  return part;
}

/// The next to split is the one of greatest gain.
bool KBestAssigner::is_later(const Part& a, const Part& b) {
  return a.gain != b.gain ? a.gain < b.gain : std::tuple(a.problem, a.age) > std::tuple(b.problem, b.age);
}

/// Finds the part's best answer; false where it has none.
bool KBestAssigner::solve(Part& part) {
  const Table& table = tables_[part.problem];
  const std::size_t nodes = static_cast<std::size_t>(table.rows) + table.columns + 1;
  part.choices = choices_.size();
  part.prices = prices_.size();
  choices_.resize(choices_.size() + table.rows, kNoIndex);
  prices_.resize(prices_.size() + nodes, 0);
  part.solved = true;
  if (part.from == kNoIndex) {
    solve_whole(part);
    return true;
  }
  const Part& whole = parts_[part.from];
  std::copy_n(choices_.begin() + static_cast<std::ptrdiff_t>(whole.choices), table.rows,
              choices_.begin() + static_cast<std::ptrdiff_t>(part.choices));
  std::copy_n(prices_.begin() + static_cast<std::ptrdiff_t>(whole.prices), nodes,
              prices_.begin() + static_cast<std::ptrdiff_t>(part.prices));
  open(part);
  ban(part, 1);
  const int row = free_rows_[part.free];
  const int choice = choices_[part.choices + row];
  const int left = choice == kNoIndex ? table.rows + table.columns : table.rows + arcs_[choice].column;
  if (choice != kNoIndex) owner_[arcs_[choice].column] = kNoIndex;
  const bool found = reroute(part, row, left);
  ban(part, 0);
  if (found) settle_gain(part);
  return found;
}

/// Rows come in one by one, each by the shortest path to the sink.
void KBestAssigner::solve_whole(Part& part) {
  const Table& table = tables_[part.problem];
  part.free = free_rows_.size();
  part.free_count = table.rows;
  for (int row = 0; row < table.rows; ++row) free_rows_.push_back(row);
  open(part);
  row_free_.assign(table.rows, 0);
  double* price = prices_.data() + part.prices;
  const int sink = table.rows + table.columns;
  for (int row = 0; row < table.rows; ++row) {
    row_free_[row] = 1;
    price[row] = price[sink];
    for (int arc = row_begin_[table.rows_at + row]; arc < row_begin_[table.rows_at + row + 1]; ++arc) {
      price[row] = std::max(price[row], price[table.rows + arcs_[arc].column] - arcs_[arc].cost);
    }
    reroute(part, row, sink);
  }
  settle_gain(part);
}

/// Sums in the order of rows, so that rounding does not depend on how an answer was found.
void KBestAssigner::settle_gain(Part& part) const {
  const Table& table = tables_[part.problem];
  part.gain = table.gain;
  for (int row = 0; row < table.rows; ++row) {
    const int choice = choices_[part.choices + row];
    if (choice != kNoIndex) part.gain -= arcs_[choice].cost;
  }
}

void KBestAssigner::give_answer(const Part& part) {
  const Table& table = tables_[part.problem];
  answers_.push_back({part.problem, part.gain, {}});
  answer_at_.push_back(answer_columns_.size());
  for (int row = 0; row < table.rows; ++row) {
    const int choice = choices_[part.choices + row];
    answer_columns_.push_back(choice == kNoIndex ? kNoIndex : arcs_[choice].column);
  }
}

/// All answers of a solved part but its best: those that keep its choice in the first rows and differ in the next.
void KBestAssigner::split(int index, double limit) {
  Part& part = parts_[index];
  open(part);
  ban(part, 1);
  order_.clear();
  for (int i = 0; i < part.free_count; ++i) {
    const int row = free_rows_[part.free + i];
    order_.emplace_back(-min_loss(part, row), row);
  }
  ban(part, 0);
  std::sort(order_.begin(), order_.end());
  part.free = free_rows_.size();
  for (const auto& [loss, row] : order_) free_rows_.push_back(row);
  for (int i = 0; i < part.free_count; ++i) {
    const double gain = part.gain + order_[i].first;
    if (gain == -infinity || gain < limit) continue;
    const int row = order_[i].second;
    bans_.push_back({row, choices_[part.choices + row], part.banned});
    push({.problem = part.problem,
          .gain = gain,
          .from = index,
          .banned = static_cast<int>(bans_.size()) - 1,
          .free = part.free + i,
          .free_count = part.free_count - i});
  }
}

/// What an answer costs more, at the least, where this row's choice is forbidden.
double KBestAssigner::min_loss(const Part& part, int row) const {
  const Table& table = tables_[part.problem];
  const double* price = prices_.data() + part.prices;
  const int choice = choices_[part.choices + row];
  double minimum = infinity;
  for (int arc = row_begin_[table.rows_at + row]; arc < row_begin_[table.rows_at + row + 1]; ++arc) {
    const int column = arcs_[arc].column;
    if (arc == choice || arc_banned_[arc] || !column_open_[column]) continue;
    minimum = std::min(minimum, arcs_[arc].cost + price[row] - price[table.rows + column]);
  }
  if (choice != kNoIndex && !none_banned_[row]) minimum = std::min(minimum, price[row] - price[table.rows + table.columns]);
  return std::max(0.0, minimum);
}

/// Lays out the network of a part: the rows that are free, the columns that no settled row has, and who has those.
void KBestAssigner::open(const Part& part) {
  const Table& table = tables_[part.problem];
  row_free_.assign(table.rows, 0);
  none_banned_.assign(table.rows, 0);
  column_open_.assign(table.columns, 1);
  owner_.assign(table.columns, kNoIndex);
  for (int i = 0; i < part.free_count; ++i) row_free_[free_rows_[part.free + i]] = 1;
  for (int row = 0; row < table.rows; ++row) {
    const int choice = choices_[part.choices + row];
    if (choice == kNoIndex) continue;
    owner_[arcs_[choice].column] = row;
    if (!row_free_[row]) column_open_[arcs_[choice].column] = 0;
  }
}

void KBestAssigner::ban(const Part& part, char value) {
  for (int i = part.banned; i != kNoIndex; i = bans_[i].next) {
    if (bans_[i].choice == kNoIndex) {
      none_banned_[bans_[i].row] = value;
    } else {
      arc_banned_[bans_[i].choice] = value;
    }
  }
}

/// Dijkstra from the row `from`, which has nothing, to the node `to`, which would be left without it; then choices and prices
/// follow the path. False, with nothing changed, if no path exists.
bool KBestAssigner::reroute(const Part& part, int from, int to) {
  const Table& table = tables_[part.problem];
  const int sink = table.rows + table.columns;
  distance_.assign(sink + 1, infinity);
  settled_.assign(sink + 1, 0);
  by_.assign(sink + 1, kNoIndex);
  by_arc_.assign(sink + 1, kNoIndex);
  reached_.assign(1, {0, from});
  distance_[from] = 0;
  while (!reached_.empty() && !settled_[to]) {
    std::pop_heap(reached_.begin(), reached_.end(), std::greater<>());
    const int node = reached_.back().second;
    reached_.pop_back();
    if (settled_[node]) continue;
    settled_[node] = 1;
    if (node == to) break;
    if (node < table.rows) {
      leave_row(part, node, node == from);
    } else if (node < sink) {
      const int owner = owner_[node - table.rows];
      reach(owner != kNoIndex ? owner : sink, node, kNoIndex, owner != kNoIndex ? 0 : price(part, node) - price(part, sink));
    } else {
      leave_sink(part, to);
    }
  }
  if (!settled_[to]) return false;
  double* prices = prices_.data() + part.prices;
  for (int node = 0; node <= sink; ++node) prices[node] += std::min(distance_[node], distance_[to]);
  track_path(part, from, to);
  return true;
}

void KBestAssigner::reach(int node, int by, int arc, double loss) {
  const double distance = distance_[by] + std::max(0.0, loss);
  if (!(distance < distance_[node])) return;
  distance_[node] = distance;
  by_[node] = by;
  by_arc_[node] = arc;
  reached_.emplace_back(distance, node);
  std::push_heap(reached_.begin(), reached_.end(), std::greater<>());
}

/// `anew`: the row is searching for another choice than it had, or for its first.
void KBestAssigner::leave_row(const Part& part, int row, bool anew) {
  const Table& table = tables_[part.problem];
  const int choice = choices_[part.choices + row];
  for (int arc = row_begin_[table.rows_at + row]; arc < row_begin_[table.rows_at + row + 1]; ++arc) {
    const int column = arcs_[arc].column;
    if (arc == choice || arc_banned_[arc] || !column_open_[column]) continue;
    const int node = table.rows + column;
    reach(node, row, arc, arcs_[arc].cost + price(part, row) - price(part, node));
  }
  const int sink = table.rows + table.columns;
  if ((choice != kNoIndex || anew) && !none_banned_[row]) reach(sink, row, kNoIndex, price(part, row) - price(part, sink));
}

/// From the sink flow is taken back: from a row that has nothing, or from a column that is taken. `left` is a column that was taken
/// by the row that the path began with.
void KBestAssigner::leave_sink(const Part& part, int left) {
  const Table& table = tables_[part.problem];
  const int sink = table.rows + table.columns;
  for (int row = 0; row < table.rows; ++row) {
    if (row_free_[row] && choices_[part.choices + row] == kNoIndex) reach(row, sink, kNoIndex, 0);
  }
  for (int column = 0; column < table.columns; ++column) {
    const int node = table.rows + column;
    const bool taken = owner_[column] != kNoIndex || node == left;
    if (column_open_[column] && taken) reach(node, sink, kNoIndex, price(part, sink) - price(part, node));
  }
}

void KBestAssigner::track_path(const Part& part, int from, int to) {
  const Table& table = tables_[part.problem];
  int* choices = choices_.data() + part.choices;
  for (int node = to; node != from; node = by_[node]) {
    const int row = by_[node];
    if (row < table.rows && choices[row] != kNoIndex) owner_[arcs_[choices[row]].column] = kNoIndex;
  }
  for (int node = to; node != from; node = by_[node]) {
    const int row = by_[node];
    if (row >= table.rows) continue;
    choices[row] = by_arc_[node];
    if (choices[row] != kNoIndex) owner_[arcs_[choices[row]].column] = row;
  }
}

}  // namespace marey::assign
