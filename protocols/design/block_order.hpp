/// \file What a block presents, in which order, before images are chosen. Private to
/// protocols/design.
#pragma once

#include "protocols/design/study.hpp"

#include <cstddef>
#include <span>
#include <string>
#include <vector>

namespace touchtrial::design {

/// What a trial presents before an image is chosen.
struct BlockItem {
  int class_index = 0;
  int method = 0;
};

/// A block's presentations; the first `lead_ins` are not scored.
struct BlockOrder {
  std::vector<BlockItem> items;
  std::size_t lead_ins = 0;
};

/// \param methods  that the block presents
/// \param purpose  of the block's random streams, after "schedule: order, " and the like
/// \pre obstacle_to_order(study) is nothing
[[nodiscard]] BlockOrder make_block_order(const Study& study, std::span<const int> methods,
                                          const std::string& purpose, int enrolment);

}  // namespace touchtrial::design
