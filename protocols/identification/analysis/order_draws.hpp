/// \file The orders of classes that a study's design could have produced. Private to
/// protocols/identification.
#pragma once

#include "analysis/statistics/chance_test.hpp"
#include "core/random.hpp"
#include "study/study.hpp"

#include <cstddef>
#include <string_view>
#include <vector>

namespace touchtrial::analysis::identification {

/// How the study's rule draws the order of classes in a block.
[[nodiscard]] DealtOrder dealt_order(const study::Study& study);

/// Draws orders of a block by the study's rule: takes one of 300 orders from the study's schedules
/// and one of 120 renamings of the classes, because every rule treats all classes alike.
class OrderDraws {
 public:
  /// \param blocks  for which orders are drawn, each on its own
  /// \param deals  how often
  /// \param purpose  of the random numbers
  OrderDraws(const study::Study& study, int method, std::size_t blocks, int deals,
             std::string_view purpose);

  /// The number of a block's scored presentations of the method.
  [[nodiscard]] std::size_t length() const { return orders_.front().size(); }

  /// \param block  in [0, blocks)
  /// \param deal  in [0, deals)
  /// \param places  the places in the order whose classes are returned, ascending, below length()
  [[nodiscard]] std::vector<int> drawn(std::size_t block, int deal,
                                       const std::vector<int>& places) const;

 private:
  std::size_t blocks_;
  RandomStream random_;
  std::vector<std::vector<int>> orders_;
  std::vector<std::vector<int>> renamings_;
  std::vector<int> picks_;
};

}  // namespace touchtrial::analysis::identification
