#include "protocols/identification/analysis/order.hpp"

#include "protocols/identification/analysis/counted_trials.hpp"
#include "protocols/identification/analysis/order_draws.hpp"

#include <algorithm>
#include <array>
#include <map>
#include <tuple>
#include <utility>
#include <vector>

namespace touchtrial::analysis::identification {
namespace {

constexpr std::size_t kMostMovedTrials = 5'000'000;  ///< takes about a tenth of a second

/// The number of draws; level * (draws + 1) is whole.
int order_draws_for(std::size_t trials) {
  constexpr std::array kDraws = {1999, 999, 199};
  for (const int draws : kDraws) {
    if (trials * static_cast<std::size_t>(draws) <= kMostMovedTrials) return draws;
  }
  return 99;
}

/// A block as it was felt.
struct OrderedBlock {
  FeltBlock felt;
  std::vector<int> places;  ///< of its moving trials, in the schedule's order of the method
};

/// The place of each scored trial of a method within its block's schedule. A repeated trial keeps
/// it.
std::map<const TrialOutcome*, int> scheduled_places(const Outcomes& outcomes, int method) {
  std::map<std::pair<int, int>, std::vector<const TrialOutcome*>> blocks;
  for (const TrialOutcome& trial : outcomes.trials) {
    const bool has_place = trial.scored && trial.stimulus.method == method &&
                           trial.row.state != record::TrialState::voided;
    if (has_place) blocks[{trial.row.session, trial.row.block}].push_back(&trial);
  }
  std::map<const TrialOutcome*, int> places;
  for (auto& [id, trials] : blocks) {
    int place = 0;
    std::ranges::stable_sort(trials, {}, [](const TrialOutcome* one) { return one->row.trial; });
    for (const TrialOutcome* trial : trials) places.emplace(trial, place++);
  }
  return places;
}

FeltTrial felt_trial(const TrialOutcome& trial, const TrialOutcome* before) {
  FeltTrial felt;
  if (trial.role != study::Role::catch_trial) {
    felt.presented = trial.stimulus.class_index;
    felt.answered = trial.response;
  }
  felt.follows = before != nullptr && before->row.session == trial.row.session &&
                 before->row.block == trial.row.block;
  felt.moves = false;
  return felt;
}

/// By session and block.
using OwnBlocks = std::map<std::pair<int, int>, OrderedBlock>;

/// The blocks of every participant that have a moving trial.
std::map<int, OwnBlocks> ordered_blocks(const Outcomes& outcomes, int method) {
  const std::map<const TrialOutcome*, int> places = scheduled_places(outcomes, method);
  const People whose(outcomes);
  std::map<int, OwnBlocks> people;
  const TrialOutcome* before = nullptr;
  int place = 0;
  for (const TrialOutcome* trial : as_felt(outcomes)) {
    if (before == nullptr || before->row.session != trial->row.session) place = 0;
    OrderedBlock& block =
        people[whose.of(trial->row.session)][{trial->row.session, trial->row.block}];
    FeltTrial& felt = block.felt.emplace_back(felt_trial(*trial, before));
    before = trial;
    if (!trial->scored || trial->stimulus.method != method) continue;
    ++place;
    if (!trial->counted) continue;
    felt.moves = true;
    felt.place = place;
    block.places.push_back(places.at(trial));
  }
  for (auto& [person, blocks] : people) {
    std::erase_if(blocks, [](const auto& one) { return one.second.places.empty(); });
  }
  return people;
}

}  // namespace

std::optional<OrderEffects> order_of(const Outcomes& outcomes, int method) {
  std::vector<std::vector<FeltBlock>> participants;
  std::vector<std::vector<int>> places;  // of each block
  std::size_t trials = 0;
  for (auto& [person, blocks] : ordered_blocks(outcomes, method)) {
    if (blocks.empty()) continue;
    std::vector<FeltBlock>& own = participants.emplace_back();
    for (auto& [number, block] : blocks) {
      trials += block.places.size();
      own.push_back(block.felt);
      places.push_back(block.places);
    }
  }
  const int draws = order_draws_for(trials);
  std::optional<OrderDraws> orders;
  RedrawnClasses redraw;
  if (dealt_order(outcomes.design) == DealtOrder::redrawn && !places.empty()) {
    orders.emplace(outcomes.design, method, places.size(), draws, "order effects");
    const auto fits = [&](const std::vector<int>& block) {
      return static_cast<std::size_t>(std::ranges::max(block)) < orders->length();
    };
    // If a block has places that the schedules do not have, any order stands for those of the rule.
    if (std::ranges::all_of(places, fits)) {
      redraw = [&](std::size_t block, int deal) {
        return orders->drawn(block, deal, places[block]);
      };
    }
  }
  return order_effects(participants, redraw, draws, static_cast<std::uint64_t>(method));
}

}  // namespace touchtrial::analysis::identification
