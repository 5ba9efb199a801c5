#include "analysis/choices/orders.hpp"

#include "analysis/choices/people.hpp"
#include "analysis/statistics/common.hpp"
#include "study/protocol.hpp"
#include "study/schedule.hpp"

#include <algorithm>
#include <cstdint>
#include <initializer_list>
#include <map>
#include <numeric>
#include <span>
#include <string>
#include <tuple>
#include <utility>
#include <vector>

namespace touchtrial::choices {
namespace {

using analysis::AnsweredBlock;
using analysis::ChanceTest;
using analysis::FeltBlock;
using analysis::FeltTrial;
using analysis::KnownMatches;
using analysis::OrderEffects;
using analysis::OrderRule;
using analysis::Prevalence;
using analysis::RedrawnBlock;
using analysis::RedrawnClasses;

constexpr int kMinDeals = 999;
constexpr int kMaxBlockDeals = 1'000'000;  ///< takes at most one second

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

/// Counted trials by block, each with its place among the scored presentations of the method.
struct PlacedBlocks {
  std::vector<int> people;  ///< of each block: see FirstSessions
  std::vector<AnsweredBlock> answers;
  std::vector<std::vector<int>> places;
};

/// The blocks with trials of one method, ordered by participant, session and block. Voided trials
/// have no place, because their block was restarted.
PlacedBlocks blocks_of(const Outcomes& outcomes, int method) {
  const FirstSessions people(outcomes);
  const std::map<const TrialOutcome*, int> places = scheduled_places(outcomes, method);
  std::map<std::tuple<int, int, int>, std::pair<AnsweredBlock, std::vector<int>>> blocks;
  for (const TrialOutcome& trial : outcomes.trials) {
    const auto place = places.find(&trial);
    if (place == places.end() || !trial.counted) continue;
    auto& [answers, own] =
        blocks[{people.of(trial.row.session), trial.row.session, trial.row.block}];
    answers.presented.push_back(trial.stimulus.class_index);
    answers.answered.push_back(trial.response);
    own.push_back(place->second);
  }
  PlacedBlocks all;
  for (auto& [id, block] : blocks) {
    all.people.push_back(std::get<0>(id));
    all.answers.push_back(std::move(block.first));
    all.places.push_back(std::move(block.second));
  }
  return all;
}

/// The number of draws. Large studies need fewer, because the sum over many blocks varies little.
int deals_for(std::size_t blocks, int most_deals) {
  const auto affordable = kMaxBlockDeals / static_cast<int>(std::max<std::size_t>(1, blocks));
  return std::clamp(affordable, std::min(kMinDeals, most_deals), most_deals);
}

/// The most draws that are affordable; level * (draws + 1) is whole.
/// \param choices  descending
/// \param most  of draws times things to draw for
int draws_for(std::size_t things, std::initializer_list<int> choices, std::size_t most) {
  for (const int draws : choices) {
    if (things * static_cast<std::size_t>(draws) <= most) return draws;
  }
  return 99;
}

/// Draws of orders by the study's schedules.
/// \param places  of each block \return nothing if the rule allows any order, or a block has places
///   that are not in the schedules
std::optional<OrderDraws> schedule_draws(const study::Study& study, int method,
                                         std::span<const std::vector<int>> places, int deals,
                                         std::string_view purpose) {
  if (dealt_order(study) != OrderRule::redrawn || places.empty()) return std::nullopt;
  OrderDraws draws(study, method, places.size(), deals, purpose);
  const bool fit = std::ranges::all_of(places, [&](const std::vector<int>& block) {
    return static_cast<std::size_t>(std::ranges::max(block)) < draws.length();
  });
  return fit ? std::optional(std::move(draws)) : std::nullopt;
}

/// The chance tests of some of a study's blocks, over the same drawn orders.
class BlockTests {
 public:
  /// \param placed,known  must outlive this; `known` may be null
  BlockTests(const Outcomes& outcomes, int method, const PlacedBlocks& placed, int deals,
             KnownMatches* known)
      : classes_(static_cast<int>(outcomes.classes.size())),
        placed_(placed),
        order_(dealt_order(outcomes.design)),
        deals_(deals),
        known_(known),
        draws_(schedule_draws(outcomes.design, method, placed.places, deals, "chance test")) {
    // Falls back to any order.
    if (order_ == OrderRule::redrawn && !draws_) order_ = OrderRule::permuted;
  }

  /// \param first,last  blocks
  /// \return nothing without blocks
  [[nodiscard]] std::optional<ChanceTest> of(std::size_t first, std::size_t last) {
    const std::span blocks = std::span(placed_.answers).subspan(first, last - first);
    RedrawnBlock redraw;
    if (draws_) {
      redraw = [this, first](std::size_t block, int deal) {
        return draws_->drawn(first + block, deal, placed_.places[first + block]);
      };
    }
    return chance_test(classes_, blocks, order_, redraw, deals_, known_);
  }

 private:
  int classes_;
  const PlacedBlocks& placed_;
  OrderRule order_;
  int deals_;
  KnownMatches* known_;
  std::optional<OrderDraws> draws_;
};

constexpr std::size_t kMaxMovedTrials = 5'000'000;  ///< takes about a tenth of a second

/// A block as it was felt.
struct OrderedBlock {
  FeltBlock felt;
  std::vector<int> places;  ///< of its moving trials, in the schedule's order of the method
};

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
  const FirstSessions whose(outcomes);
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

constexpr int kOrders = 300;
constexpr int kRenamings = 120;

/// The classes of the scored presentations of one method, in the order of a schedule.
std::vector<int> order_in(const study::Schedule& schedule, int method) {
  std::vector<int> order;
  for (const study::Trial& shown : schedule.trials) {
    if (shown.role == study::Role::scored && shown.field().method == method) {
      order.push_back(shown.field().class_index);
    }
  }
  return order;
}

}  // namespace

std::optional<ChanceTest> chance_of(const Outcomes& outcomes, int method, int most_deals,
                                    KnownMatches* known) {
  const PlacedBlocks placed = blocks_of(outcomes, method);
  const std::size_t blocks = placed.answers.size();
  const bool redrawn = dealt_order(outcomes.design) == OrderRule::redrawn;
  const int deals = redrawn ? deals_for(blocks, most_deals) : kMaxChanceDeals;
  return BlockTests(outcomes, method, placed, deals, known).of(0, blocks);
}

std::optional<Prevalence> own_prevalence(const Outcomes& outcomes, int method,
                                         KnownMatches* known) {
  const PlacedBlocks placed = blocks_of(outcomes, method);
  const std::vector<int>& people = placed.people;
  const int deals = draws_for(people.size(), {999, 199}, kMaxBlockDeals);
  BlockTests tests(outcomes, method, placed, deals, known);
  Proportion passed;
  double level = 0.0;
  for (std::size_t first = 0; first < people.size();) {
    std::size_t last = first + 1;
    while (last < people.size() && people[last] == people[first]) ++last;
    if (const auto test = tests.of(first, last)) {
      passed.add(test->p <= analysis::kSignificanceLevel);
      level += test->attainable;
    }
    first = last;
  }
  if (passed.n == 0) return std::nullopt;
  return prevalence_of(passed, level / passed.n);
}

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
  const int draws = draws_for(trials, {1999, 999, 199}, kMaxMovedTrials);
  const auto orders = schedule_draws(outcomes.design, method, places, draws, "order effects");
  RedrawnClasses redraw;  // if empty, any order is allowed
  if (orders) {
    redraw = [&](std::size_t block, int deal) { return orders->drawn(block, deal, places[block]); };
  }
  return order_effects(participants, redraw, draws, static_cast<std::uint64_t>(method));
}

OrderRule dealt_order(const study::Study& study) {
  const study::TrialOptions& trials = study.trials;
  const bool limited = trials.max_run > 0;
  if (!limited && trials.order == study::TrialOrder::shuffled) return OrderRule::permuted;
  if (!limited && trials.order == study::TrialOrder::uniform) return OrderRule::independent;
  return OrderRule::redrawn;
}

OrderDraws::OrderDraws(const study::Study& study, int method, std::size_t blocks, int deals,
                       std::string_view purpose)
    : blocks_(blocks), random_(0, purpose, static_cast<std::uint64_t>(method)) {
  // A separate seed, so that participants' actual orders are not among the draws.
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

}  // namespace touchtrial::choices
