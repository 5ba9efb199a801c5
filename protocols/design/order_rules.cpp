#include "protocols/design/order_rules.hpp"

namespace touchtrial {

std::optional<OrderObstacle> obstacle_to_order(const Study& study) {
  if (study.trials.order != TrialOrder::de_bruijn) return std::nullopt;
  const auto classes = static_cast<int>(study.classes.size());
  if (study.trials.repeats != classes) {
    return OrderObstacle{
        "/repeats",
        "is " + std::to_string(study.trials.repeats) +
            "; the order de-bruijn needs as many repeats as classes: " + std::to_string(classes)};
  }
  if (study.trials.lead_in != 0) {
    return OrderObstacle{"/lead_in",
                         "must be 0: the order de-bruijn has one lead-in presentation of its own"};
  }
  if (study.trials.blocks == Blocks::mixed && study.presented_methods() > 1) {
    return OrderObstacle{"/blocks",
                         "must be \"by-method\": the order de-bruijn balances classes within one "
                         "method"};
  }
  return std::nullopt;
}

}  // namespace touchtrial
