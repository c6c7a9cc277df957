// The k best assignments, not the best alone. A row may be given a column or stay without; the worth of an answer is
// the sum of the gains of its pairs; the k answers of greatest worth are found in order, over one problem or several at once (the
// children of several parent hypotheses).
//
// Murty 1968: the best answer is found; all others differ from it in at least one row, and are split by the first row, in some
// order, in which they do: each part is again an assignment problem, with some rows settled and one choice forbidden. The best
// of all parts is the next answer, whose part is split in turn. The speed-ups are those of Miller, Stone & Cox, "Optimizing Murty's
// ranked assignment method", IEEE Trans. AES 33 (1997):
//   - a part inherits choices and prices of the answer it was split from, and is solved by one shortest path, not from scratch;
//   - before that it waits in the queue under an upper bound, read off the prices, and most never reach the head;
//   - rows are ordered so that the parts with poor bounds are the large ones and those with good bounds have most rows settled.
// Deviation: no rows or columns are invented to make the matrix square. A flow network says the same with one node more: unit flow
// goes from each row, through a column or past all of them, to a sink; a path may pass through the sink, where a column falls
// free on one side and another is taken on the other. So pairs stay sparse.
// Cost: an answer splits into one part a row, each costing a bound (its pairs) and, if it gets to the head of the queue, one
// Dijkstra over the pairs of the rows not settled. Deterministic: draws are settled by problem, then by age in the queue.
#pragma once

#include <limits>
#include <span>
#include <utility>
#include <vector>

#include "marey/assign/gated_assignment.h"
#include "marey/assign/no_index.h"

namespace marey::assign {

/// Allowed pairs. Unlike for the best answer alone, pairs with a gain ≤ 0 count too: they are in answers that are less worth.
struct AssignmentProblem {
  int rows = 0;
  int columns = 0;
  std::span<const GatedPair> pairs = {};  ///< in any order, each once; gains finite
  double gain = 0;                        ///< what each answer to this problem is worth beyond its pairs
};

class KBestAssigner {
 public:
  struct Answer {
    int problem = 0;                     ///< index into the problems given
    double gain = 0;                     ///< the problem's plus those of the pairs
    std::span<const int> column_of_row;  ///< or `kNoIndex`
  };

  /// The `most` best answers to all problems together, the best first, omitting those whose gain is less than the best's by
  /// more than `within`. All answers are different. Valid until the next call, as is what it points to; the problems' pairs are
  /// not needed any longer. Allocates only where a call needs more than all before.
  std::span<const Answer> find(std::span<const AssignmentProblem> problems, int maximum,
                               double within = std::numeric_limits<double>::infinity());

 private:
  struct Arc {
    int column = 0;
    double cost = 0;
  };
  /// A problem's pairs by row: those of row r are arcs_[row_begin_[rows_at + r]] up to the next row's.
  struct Table {
    int rows = 0, columns = 0;
    std::size_t rows_at = 0;
    double gain = 0;
  };
  /// A part of a problem's answers. Where it is solved it has its best answer, with prices; else it was split from another.
  struct Part {
    int problem = 0;
    double gain = 0;  ///< of its best answer, or no less
    bool solved = false;
    int from = kNoIndex;    ///< the part it was split from; kNoIndex: the whole problem
    int banned = kNoIndex;  ///< into bans_: the choices that are forbidden, the last of them that of the first free row
    std::size_t free = 0;   ///< into free_rows_: the rows that are not settled
    int free_count = 0;
    std::size_t choices = 0;  ///< into choices_: for every row an arc, or kNoIndex
    std::size_t prices = 0;   ///< into prices_: for every row, every column and the sink
    int age = 0;              ///< of its place in the queue
  };
  /// A link in a chain of choices that are forbidden.
  struct Ban {
    int row = 0;
    int choice = kNoIndex;
    int next = kNoIndex;
  };

  void clear();
  void tabulate(const AssignmentProblem& problem);
  void push(const Part& part);
  Part pop();
  static bool is_later(const Part& a, const Part& b);
  bool solve(Part& part);
  void solve_whole(Part& part);
  void settle_gain(Part& part) const;
  void give_answer(const Part& part);
  void split(int index, double limit);
  double min_loss(const Part& part, int row) const;
  void open(const Part& part);
  void ban(const Part& part, char value);
  bool reroute(const Part& part, int from, int to);
  void reach(int node, int by, int arc, double loss);
  void leave_row(const Part& part, int row, bool anew);
  void leave_sink(const Part& part, int left);
  void track_path(const Part& part, int from, int to);
  double price(const Part& part, int node) const { return prices_[part.prices + node]; }

  std::vector<Table> tables_;
  std::vector<Arc> arcs_;
  std::vector<int> row_begin_, fill_;
  std::vector<Part> parts_;  // whose best answers were given, in that order
  std::vector<Part> queue_;  // a heap
  int age_ = 0;
  std::vector<int> choices_, free_rows_;
  std::vector<double> prices_;
  std::vector<Ban> bans_;
  std::vector<Answer> answers_;
  std::vector<int> answer_columns_;
  std::vector<std::size_t> answer_at_;
  std::vector<std::pair<double, int>> order_;  // of a part's free rows
  // The network of the part at hand. Nodes are its rows, its columns and the sink, in this order.
  std::vector<char> row_free_, none_banned_, arc_banned_, column_open_;
  std::vector<int> owner_;  // the row that has the column, or kNoIndex
  std::vector<double> distance_;
  std::vector<char> settled_;
  std::vector<int> by_, by_arc_;                 // the node, and the arc of a row, that each was reached by
  std::vector<std::pair<double, int>> reached_;  // a heap of nodes
};

}  // namespace marey::assign
