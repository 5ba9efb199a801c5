/// \file Whether participants did better than answers that have nothing to do with what was
/// presented. Trials of a balanced order are not independent, so a binomial test does not hold:
/// stimuli are dealt anew over the design that was used. Source: docs/statistics.md, "Above
/// chance"; Phipson, Smyth 2010.
#pragma once

#include <cstdint>
#include <functional>
#include <optional>
#include <span>
#include <vector>

namespace touchtrial::analysis {

/// Answers that a participant gave within one block, in order (class indices; nothing: no
/// response), and the classes that were presented.
struct AnsweredBlock {
  std::vector<int> presented;
  std::vector<std::optional<int>> answered;
};

/// How the classes of a block could as well have come.
enum class DealtOrder {
  permuted,     ///< any order of these presentations: exact, by counting
  independent,  ///< every presentation drawn on its own: exact, binomial
  redrawn,      ///< by a rule of its own: Monte Carlo over `redraw`
};

/// Makes the classes of one block anew by the study's rule. Called with the block's index and the
/// number of the deal, from 0; a function of these alone.
using RedrawnBlock = std::function<std::vector<int>(std::size_t block, int deal)>;

/// The level of `ChanceTest::attainable`.
inline constexpr double kSignificanceLevel = 0.05;

struct ChanceTest {
  int correct = 0;
  int trials = 0;
  double expected = 0.0;  ///< right answers under the null
  double p = 1.0;         ///< one-sided: as many right answers or more; 1e-280 stands for less
  bool exact = true;      ///< else (b + 1) / (deals + 1)
  int deals = 0;          ///< of a Monte Carlo
  /// The largest p that these answers could have had without passing kSignificanceLevel: right
  /// answers are whole numbers, so that under the null p is below the level this often, and not as
  /// often as the level says.
  double attainable = 0.0;
};

/// Upper-tail probability of the number of right answers, all blocks together.
/// `permuted` counts orders exactly (matching with multiplicities, by rook polynomials in exact
/// integers) and convolves blocks; error below 1e-12.
/// \param redraw  needed for `redrawn` alone
/// \return nothing without trials
/// \throws std::invalid_argument if a class is out of range, lengths differ, or `redraw` is missing
[[nodiscard]] std::optional<ChanceTest> chance_test(int classes,
                                                    std::span<const AnsweredBlock> blocks,
                                                    DealtOrder order,
                                                    const RedrawnBlock& redraw = {},
                                                    int deals = 9999);

}  // namespace touchtrial::analysis
