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
using analysis::BlockRedraw;
using analysis::ChanceTest;
using analysis::ClassRedraw;
using analysis::FeltBlock;
using analysis::FeltTrial;
using analysis::MatchCache;
using analysis::OrderEffects;
using analysis::OrderRule;
using analysis::Prevalence;

constexpr int kMinDeals = 999;
constexpr int kMaxBlockDeals = 1'000'000;  ///< takes at most one second

/// The place of each scored trial of a method within its block's schedule. A repetition keeps the
/// place.
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
    std::ranges::stable_sort(trials, {},
                             [](const TrialOutcome* trial) { return trial->row.trial; });
    for (const TrialOutcome* trial : trials) places.emplace(trial, place++);
  }
  return places;
}

/// Counted trials by block, each with its place among the scored presentations of the method.
struct PlacedBlocks {
  std::vector<int> people;  ///< of each block, by FirstSessions
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
    auto& [answers, positions] =
        blocks[{people.first_of(trial.row.session), trial.row.session, trial.row.block}];
    answers.presented.push_back(trial.stimulus.class_index);
    answers.answered.push_back(trial.response);
    positions.push_back(place->second);
  }
  PlacedBlocks all;
  for (auto& [id, block] : blocks) {
    all.people.push_back(std::get<0>(id));
    all.answers.push_back(std::move(block.first));
    all.places.push_back(std::move(block.second));
  }
  return all;
}

/// Large studies need fewer draws, because the sum over many blocks varies little.
int deals_for(std::size_t blocks, int max_deals) {
  const auto affordable = kMaxBlockDeals / static_cast<int>(std::max<std::size_t>(1, blocks));
  return std::clamp(affordable, std::min(kMinDeals, max_deals), max_deals);
}

/// \param choices  numbers of draws for which level * (draws + 1) is an integer, descending
/// \param budget  the maximum of draws * items
int affordable_draws(std::size_t items, std::initializer_list<int> choices, std::size_t budget) {
  for (const int draws : choices) {
    if (items * static_cast<std::size_t>(draws) <= budget) return draws;
  }
  return 99;
}

/// \param places  of each block
/// \return nothing if the rule allows any order, or a block has places beyond the schedules
std::optional<OrderDraws> schedule_draws(const study::Study& study, int method,
                                         std::span<const std::vector<int>> places, int deals,
                                         std::string_view purpose) {
  if (order_rule_of(study) != OrderRule::redrawn || places.empty()) return std::nullopt;
  OrderDraws draws(study, method, places.size(), deals, purpose);
  const bool all_fit = std::ranges::all_of(places, [&](const std::vector<int>& block) {
    return static_cast<std::size_t>(std::ranges::max(block)) < draws.length();
  });
  return all_fit ? std::optional(std::move(draws)) : std::nullopt;
}

/// The chance tests of ranges of a study's blocks, over the same drawn orders.
class BlockTests {
 public:
  /// \param placed_blocks,cache  must outlive this; `cache` may be null
  BlockTests(const Outcomes& outcomes, int method, const PlacedBlocks& placed_blocks, int deals,
             MatchCache* cache)
      : classes_(static_cast<int>(outcomes.classes.size())),
        placed_(placed_blocks),
        order_(order_rule_of(outcomes.design)),
        deals_(deals),
        cache_(cache),
        draws_(
            schedule_draws(outcomes.design, method, placed_blocks.places, deals, "chance test")) {
    // Without draws from schedules, any order is allowed.
    if (order_ == OrderRule::redrawn && !draws_) order_ = OrderRule::permuted;
  }

  /// \param begin,end  the range of blocks
  /// \return nothing without blocks
  [[nodiscard]] std::optional<ChanceTest> test(std::size_t begin, std::size_t end) {
    const std::span blocks = std::span(placed_.answers).subspan(begin, end - begin);
    BlockRedraw redraw;
    if (draws_) {
      redraw = [this, begin](std::size_t block, int deal) {
        return draws_->classes_at(begin + block, deal, placed_.places[begin + block]);
      };
    }
    return chance_test(classes_, blocks, order_, redraw, deals_, cache_);
  }

 private:
  int classes_;
  const PlacedBlocks& placed_;
  OrderRule order_;
  int deals_;
  MatchCache* cache_;
  std::optional<OrderDraws> draws_;
};

constexpr std::size_t kMaxMovedTrials = 5'000'000;  ///< takes about a tenth of a second

/// A block as it was felt.
struct OrderedBlock {
  FeltBlock felt;
  std::vector<int> places;  ///< of its moving trials among the method's scheduled trials
};

FeltTrial felt_trial(const TrialOutcome& trial, const TrialOutcome* previous) {
  FeltTrial felt;
  if (trial.role != study::Role::catch_trial) {
    felt.presented = trial.stimulus.class_index;
    felt.answered = trial.response;
  }
  felt.follows = previous != nullptr && previous->row.session == trial.row.session &&
                 previous->row.block == trial.row.block;
  felt.moves = false;
  return felt;
}

using BlocksBySession = std::map<std::pair<int, int>, OrderedBlock>;  ///< by session and block

/// The blocks of every participant that have a moving trial.
std::map<int, BlocksBySession> ordered_blocks(const Outcomes& outcomes, int method) {
  const std::map<const TrialOutcome*, int> places = scheduled_places(outcomes, method);
  const FirstSessions first_sessions(outcomes);
  std::map<int, BlocksBySession> people;
  const TrialOutcome* previous = nullptr;
  int place = 0;
  for (const TrialOutcome* trial : trials_in_felt_order(outcomes)) {
    if (previous == nullptr || previous->row.session != trial->row.session) place = 0;
    OrderedBlock& block =
        people[first_sessions.first_of(trial->row.session)][{trial->row.session, trial->row.block}];
    FeltTrial& felt = block.felt.emplace_back(felt_trial(*trial, previous));
    previous = trial;
    if (!trial->scored || trial->stimulus.method != method) continue;
    ++place;
    if (!trial->counted) continue;
    felt.moves = true;
    felt.place = place;
    block.places.push_back(places.at(trial));
  }
  for (auto& [person, blocks] : people) {
    std::erase_if(blocks, [](const auto& entry) { return entry.second.places.empty(); });
  }
  return people;
}

constexpr int kOrders = 300;
constexpr int kPermutations = 120;

/// The classes of the scored presentations of one method, in the order of a schedule.
std::vector<int> scored_order_of(const study::Schedule& schedule, int method) {
  std::vector<int> order;
  for (const study::Trial& trial : schedule.trials) {
    if (trial.role == study::Role::scored && trial.field().method == method) {
      order.push_back(trial.field().class_index);
    }
  }
  return order;
}

}  // namespace

std::optional<ChanceTest> chance_test_of(const Outcomes& outcomes, int method, int max_deals,
                                         MatchCache* cache) {
  const PlacedBlocks placed_blocks = blocks_of(outcomes, method);
  const std::size_t blocks = placed_blocks.answers.size();
  const bool is_redrawn = order_rule_of(outcomes.design) == OrderRule::redrawn;
  const int deals = is_redrawn ? deals_for(blocks, max_deals) : kMaxChanceDeals;
  return BlockTests(outcomes, method, placed_blocks, deals, cache).test(0, blocks);
}

std::optional<Prevalence> prevalence_above_chance(const Outcomes& outcomes, int method,
                                                  MatchCache* cache) {
  const PlacedBlocks placed_blocks = blocks_of(outcomes, method);
  const std::vector<int>& people = placed_blocks.people;
  const int deals = affordable_draws(people.size(), {999, 199}, kMaxBlockDeals);
  BlockTests tests(outcomes, method, placed_blocks, deals, cache);
  Proportion passed;
  double level = 0.0;
  for (std::size_t begin = 0; begin < people.size();) {
    std::size_t end = begin + 1;
    while (end < people.size() && people[end] == people[begin]) ++end;
    if (const auto test = tests.test(begin, end)) {
      passed.add(test->p <= analysis::kSignificanceLevel);
      level += test->attainable;
    }
    begin = end;
  }
  if (passed.n == 0) return std::nullopt;
  return prevalence_of(passed, level / passed.n);
}

std::optional<OrderEffects> order_effects_of(const Outcomes& outcomes, int method) {
  std::vector<std::vector<FeltBlock>> participants;
  std::vector<std::vector<int>> places;  // of each block
  std::size_t trials = 0;
  for (auto& [person, blocks] : ordered_blocks(outcomes, method)) {
    if (blocks.empty()) continue;
    std::vector<FeltBlock>& felt_blocks = participants.emplace_back();
    for (auto& [number, block] : blocks) {
      trials += block.places.size();
      felt_blocks.push_back(block.felt);
      places.push_back(block.places);
    }
  }
  const int draws = affordable_draws(trials, {1999, 999, 199}, kMaxMovedTrials);
  const auto orders = schedule_draws(outcomes.design, method, places, draws, "order effects");
  ClassRedraw redraw;  // if empty, any order is allowed
  if (orders) {
    redraw = [&](std::size_t block, int deal) {
      return orders->classes_at(block, deal, places[block]);
    };
  }
  return order_effects(participants, redraw, draws, static_cast<std::uint64_t>(method));
}

OrderRule order_rule_of(const study::Study& study) {
  const study::TrialOptions& trials = study.trials;
  const bool has_run_limit = trials.max_run > 0;
  if (!has_run_limit && trials.order == study::TrialOrder::shuffled) return OrderRule::permuted;
  if (!has_run_limit && trials.order == study::TrialOrder::uniform) return OrderRule::independent;
  return OrderRule::redrawn;
}

OrderDraws::OrderDraws(const study::Study& study, int method, std::size_t blocks, int deals,
                       std::string_view purpose)
    : blocks_(blocks), random_(0, purpose, static_cast<std::uint64_t>(method)) {
  // A separate seed, so that participants' actual orders are not among the draws.
  SeededEntropy entropy(study.seed);
  for (int i = 1; i <= kOrders; ++i) {
    const study::ScheduleDraw draw{entropy.secret("chance test: order " + std::to_string(i)), i};
    orders_.push_back(scored_order_of(study::make_schedule(study, draw), method));
  }
  std::vector<int> names(study.classes.size());
  std::iota(names.begin(), names.end(), 0);
  for (int i = 0; i < kPermutations; ++i) {
    shuffle(std::span(names), random_);
    permutations_.push_back(names);
  }
  picks_.resize(blocks * static_cast<std::size_t>(deals));
  for (auto& pick : picks_) pick = static_cast<int>(random_.below(kOrders * kPermutations));
}

std::vector<int> OrderDraws::classes_at(std::size_t block, int deal,
                                        const std::vector<int>& places) const {
  const int pick = picks_[static_cast<std::size_t>(deal) * blocks_ + block];
  const std::vector<int>& order = orders_[pick / kPermutations];
  const std::vector<int>& names = permutations_[pick % kPermutations];
  std::vector<int> classes;
  classes.reserve(places.size());
  for (const int place : places) classes.push_back(names[order[place]]);
  return classes;
}

}  // namespace touchtrial::choices
