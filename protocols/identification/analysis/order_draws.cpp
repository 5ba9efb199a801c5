#include "protocols/identification/analysis/order_draws.hpp"

#include "study/protocol.hpp"
#include "study/schedule.hpp"

#include <cstdint>
#include <numeric>
#include <span>
#include <string>

namespace touchtrial::analysis::identification {
namespace {

constexpr int kOrders = 300;
constexpr int kRenamings = 120;

/// The classes of the scored presentations of one method, in the order of a schedule.
std::vector<int> order_in(const study::Schedule& schedule, int method) {
  std::vector<int> order;
  for (const study::Presentation& shown : schedule.presentations) {
    if (shown.role == study::Role::scored && shown.stimulus.method == method) {
      order.push_back(shown.stimulus.class_index);
    }
  }
  return order;
}

}  // namespace

DealtOrder dealt_order(const study::Study& study) {
  const study::TrialOptions& trials = study.trials;
  const bool limited = trials.max_run > 0;
  if (!limited && trials.order == study::TrialOrder::shuffled) return DealtOrder::permuted;
  if (!limited && trials.order == study::TrialOrder::uniform) return DealtOrder::independent;
  return DealtOrder::redrawn;
}

OrderDraws::OrderDraws(const study::Study& study, int method, std::size_t blocks, int deals,
                       std::string_view purpose)
    : blocks_(blocks), random_(0, purpose, static_cast<std::uint64_t>(method)) {
  // A seed of its own keeps the participants' own orders out of the draws.
  SeededEntropy entropy(study.seed);
  for (int i = 1; i <= kOrders; ++i) {
    const study::ScheduleDraw draw{entropy.secret("chance test: order " + std::to_string(i)), i};
    orders_.push_back(order_in(study::make_schedule(study, draw), method));
  }
  std::vector<int> names(study.classes.size());
  std::iota(names.begin(), names.end(), 0);
  for (int i = 0; i < kRenamings; ++i) {
    shuffle(std::span(names), random_);
    renamings_.push_back(names);
  }
  picks_.resize(blocks * static_cast<std::size_t>(deals));
  for (auto& pick : picks_) pick = static_cast<int>(random_.below(kOrders * kRenamings));
}

std::vector<int> OrderDraws::drawn(std::size_t block, int deal,
                                   const std::vector<int>& places) const {
  const int pick = picks_[static_cast<std::size_t>(deal) * blocks_ + block];
  const std::vector<int>& order = orders_[pick / kRenamings];
  const std::vector<int>& names = renamings_[pick % kRenamings];
  std::vector<int> classes;
  classes.reserve(places.size());
  for (const int place : places) classes.push_back(names[order[place]]);
  return classes;
}

}  // namespace touchtrial::analysis::identification
