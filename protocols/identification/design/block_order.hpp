/// \file What a block presents, in which order, before images are chosen; and which orders a study
/// can have. Private to protocols/identification.
#pragma once

#include "protocols/design/study.hpp"

#include <cstddef>
#include <optional>
#include <span>
#include <string>
#include <vector>

namespace touchtrial::design::identification {

/// Why an order is impossible.
struct OrderObstacle {
  std::string key;  ///< the offender in "trials", as a JSON pointer: "/repeats"
  std::string what;
};

/// \return nothing if every participant's schedule can be made
[[nodiscard]] std::optional<OrderObstacle> obstacle_to_order(const Study& study);

/// What a trial presents, before an image is chosen.
struct BlockItem {
  int class_index = 0;
  int method = 0;
};

/// A block's presentations; the first `lead_ins` are not scored.
struct BlockOrder {
  std::vector<BlockItem> items;
  std::size_t lead_ins = 0;
};

/// Draws the order of a block.
/// \param methods  that the block presents
/// \param purpose  of the block's random streams, after "schedule: order, " and the like
/// \pre obstacle_to_order(study) is nothing
[[nodiscard]] BlockOrder make_block_order(const Study& study, std::span<const int> methods,
                                          const std::string& purpose, int enrolment);

}  // namespace touchtrial::design::identification
