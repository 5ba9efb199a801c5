/// \file The order of a block's presentations before images are chosen, and a check whether the
/// study's order is possible. Private to protocols/identification.
#pragma once

#include "core/cipher.hpp"
#include "study/study.hpp"

#include <cstddef>
#include <optional>
#include <span>
#include <string>
#include <vector>

namespace touchtrial::study::identification {

/// Why an order is impossible.
struct OrderObstacle {
  std::string key;   ///< the offending key of "trials", as a JSON pointer: "/repeats"
  std::string what;  ///< fault and remedy, printed after the key
};

/// \return why the study's order is impossible; empty if it is possible for every participant
[[nodiscard]] std::optional<OrderObstacle> obstacle_to_order(const Study& study);

/// The class and method of a trial, before an image is chosen.
struct BlockItem {
  int class_index = 0;
  int method = 0;
};

/// A block's presentations in order; the first `lead_ins` are not scored.
struct BlockOrder {
  std::vector<BlockItem> items;
  std::size_t lead_ins = 0;
};

/// Draws the order of a block.
/// \param methods  methods that the block presents
/// \param purpose  suffix of the names of the block's random streams
/// \param secret  the participant's secret, see ScheduleDraw
/// \pre obstacle_to_order(study) is empty
[[nodiscard]] BlockOrder make_block_order(const Study& study, std::span<const int> methods,
                                          const std::string& purpose, const SecretKey& secret);

}  // namespace touchtrial::study::identification
