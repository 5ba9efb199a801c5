/// \file Schedules of the identification protocols: blocks by method or mixed, the choice of
/// images, and catch trials. Private to protocols/identification.
#pragma once

#include "study/order.hpp"
#include "study/study.hpp"

#include <memory>
#include <string>

namespace touchtrial::study::identification {

/// Draws one participant's order.
/// \throws StudyError if the study's order is impossible
[[nodiscard]] std::unique_ptr<Order> identifying_order(const Study& study,
                                                       const ScheduleDraw& draw);
/// The name, version and parameters of the rule that draws orders.
[[nodiscard]] std::string rule_of_schedule(const Study& study);

}  // namespace touchtrial::study::identification
