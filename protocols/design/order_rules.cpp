#include "protocols/design/order_rules.hpp"

#include "protocols/design/limited_orders.hpp"
#include "protocols/design/williams_order.hpp"

namespace touchtrial::design {
namespace {

int classes_of(const Study& study) {
  return static_cast<int>(study.classes.size());
}

/// Presentations of a class in one block.
int copies_in_block(const Study& study) {
  const int methods = study.trials.blocks == Blocks::mixed ? study.presented_methods() : 1;
  return study.trials.repeats * methods;
}

bool mixes_methods(const Study& study) {
  return study.trials.blocks == Blocks::mixed && study.presented_methods() > 1;
}

std::optional<OrderObstacle> obstacle_to_de_bruijn(const Study& study) {
  const int classes = classes_of(study);
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
  if (mixes_methods(study)) {
    return OrderObstacle{"/blocks",
                         "must be \"by-method\": the order de-bruijn balances classes within one "
                         "method"};
  }
  if (study.trials.max_run == 1) {
    return OrderObstacle{"/max_run",
                         "is 1, but in the order de-bruijn every class follows itself once; give 2 "
                         "or more, which it keeps by itself, or choose the order shuffled"};
  }
  return std::nullopt;
}

std::optional<OrderObstacle> obstacle_to_williams(const Study& study) {
  const TrialOptions& trials = study.trials;
  if (mixes_methods(study)) {
    return OrderObstacle{"/blocks",
                         "must be \"by-method\": the order williams balances classes within one "
                         "method"};
  }
  if (trials.max_run > 0 &&
      !williams_order_exists(classes_of(study), trials.repeats, trials.max_run)) {
    return OrderObstacle{"/max_run",
                         "is 1, which no order williams of 2 classes keeps: its two rows are each "
                         "other's mirror image; give 2 or more, or choose the order shuffled"};
  }
  return std::nullopt;
}

std::optional<OrderObstacle> obstacle_to_limit(const Study& study) {
  if (study.trials.order != TrialOrder::shuffled || !max_run_matters(study)) return std::nullopt;
  const std::vector<int> counts(study.classes.size(), copies_in_block(study));
  const std::string limit = "is " + std::to_string(study.trials.max_run);
  if (!limited_order_exists(counts, study.trials.max_run)) {
    return OrderObstacle{"/max_run", limit + ", which no order keeps; raise it"};
  }
  if (!limited_orders_are_countable(counts, study.trials.max_run)) {
    return OrderObstacle{
        "/max_run", limit + ", but the orders of " + std::to_string(counts.size()) +
                        " classes presented " + std::to_string(counts.front()) +
                        " times in a block are too many to count; give fewer classes or repeats, "
                        "blocks by method, another order, or 0"};
  }
  return std::nullopt;
}

}  // namespace

bool max_run_matters(const Study& study) {
  const TrialOptions& trials = study.trials;
  if (trials.max_run == 0) return false;
  const int copies = trials.order == TrialOrder::uniform
                         ? classes_of(study) * copies_in_block(study)
                         : copies_in_block(study);
  return trials.max_run < copies + trials.lead_in;
}

std::optional<OrderObstacle> obstacle_to_order(const Study& study) {
  if (study.trials.order == TrialOrder::de_bruijn) return obstacle_to_de_bruijn(study);
  if (study.trials.order == TrialOrder::williams) return obstacle_to_williams(study);
  return obstacle_to_limit(study);
}

}  // namespace touchtrial::design
