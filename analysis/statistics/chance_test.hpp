/// \file A randomisation test of whether participants did better than chance. In a balanced order
/// trials are not independent, so a binomial test is invalid; instead, stimuli are reassigned to
/// trials as the design allows. Sources: docs/statistics.md, "At least one participant"; Phipson,
/// Smyth 2010; Riordan 1958, chapters 7 and 8 (rook polynomials, matching with multiplicities).
#pragma once

#include <cstdint>
#include <functional>
#include <map>
#include <optional>
#include <span>
#include <utility>
#include <vector>

namespace touchtrial::analysis {

/// One participant's trials within one block, in order.
struct AnsweredBlock {
  std::vector<int> presented;                ///< class indices
  std::vector<std::optional<int>> answered;  ///< class indices; nothing: no response
};

/// How a block's order was drawn, which determines the other possible orders.
enum class OrderRule {
  permuted,     ///< any order of these presentations; exact, by counting
  independent,  ///< every presentation drawn independently; exact, binomial
  redrawn,      ///< orders that `redraw` draws by the study's rule; Monte Carlo
};

/// Draws the classes of one block anew by the study's rule. The result depends only on the block's
/// index and on the number of the deal, both from 0.
using BlockRedraw = std::function<std::vector<int>(std::size_t block, int deal)>;

/// The level of `ChanceTest::attainable`.
inline constexpr double kSignificanceLevel = 0.05;

struct ChanceTest {
  int correct = 0;
  int trials = 0;
  double expected = 0.0;  ///< right answers under the null hypothesis
  double p = 1.0;         ///< one-sided; never below 1e-280
  bool exact = true;      ///< otherwise p is (b + 1) / (deals + 1)
  int deals = 0;          ///< random orders drawn by a Monte Carlo test
  /// The largest possible p within kSignificanceLevel, given these answers: the true type I error
  /// rate. It is below the level because the number of right answers is discrete.
  double attainable = 0.0;
};

/// For every class, how often it was presented and how often it was answered.
using ClassCounts = std::vector<std::pair<int, int>>;

/// A cache of match_probabilities, which several tests can share.
using MatchCache = std::map<ClassCounts, std::vector<double>>;

/// Upper-tail probability of the number of right answers in all blocks together. `permuted` counts
/// orders exactly with match_probabilities and convolves blocks; the error is below 1e-12.
/// \param redraw  needed only for `redrawn`
/// \param cache  a cache that is used and extended, if not null
/// \return nothing without trials
/// \throws std::invalid_argument if a class is out of range, lengths differ, or `redraw` is missing
[[nodiscard]] std::optional<ChanceTest> chance_test(int classes,
                                                    std::span<const AnsweredBlock> blocks,
                                                    OrderRule order, const BlockRedraw& redraw = {},
                                                    int deals = 9999, MatchCache* cache = nullptr);

/// \param counts  each >= 0
/// \param trials  presentations of all classes; answers may be fewer
/// \return the probabilities of 0, 1, .. right answers if every order of the presentations is
///   equally likely; the relative error of each is below 1e-14, as orders are counted in exact
///   integers
/// \throws std::invalid_argument if the counts do not fit the trials
/// Cost grows with the third power of trials: 25 take 20 us, 300 take 20 ms.
[[nodiscard]] std::vector<double> match_probabilities(const ClassCounts& counts, int trials);

}  // namespace touchtrial::analysis
