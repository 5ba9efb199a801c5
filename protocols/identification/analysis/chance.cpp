#include "protocols/identification/analysis/chance.hpp"

#include "analysis/statistics/common.hpp"
#include "analysis/statistics/paired_tests.hpp"
#include "core/random.hpp"
#include "protocols/identification/analysis/counted_trials.hpp"
#include "protocols/identification/analysis/report_parts.hpp"

#include <algorithm>
#include <map>
#include <numeric>
#include <span>
#include <utility>
#include <vector>

namespace touchtrial::analysis::identification {

namespace {

/// The number of orders that the study's rule can produce. Every rule treats all classes alike, so
/// each order also stands for its renamings.
constexpr int kOrders = 300;
constexpr int kRenamings = 120;
constexpr int kFewestDeals = 999;
constexpr int kMostBlockDeals = 1'000'000;  ///< takes at most one second

/// A block's counted trials, each with its place among the scored presentations of the method.
struct PlacedBlock {
  AnsweredBlock answers;
  std::vector<int> places;
};

/// The blocks with trials of one method, ordered by session and block. Voided trials have no place,
/// because their block was restarted.
std::vector<PlacedBlock> blocks_of(const Outcomes& outcomes, int method) {
  std::map<std::pair<int, int>, PlacedBlock> blocks;
  std::map<std::pair<int, int>, int> next_place;
  for (const TrialOutcome& trial : outcomes.trials) {
    const bool has_place = trial.scored && trial.stimulus.method == method &&
                           trial.row.state != store::TrialState::voided;
    if (!has_place) continue;
    const std::pair id(trial.row.session, trial.row.block);
    const int place = next_place[id]++;
    if (!trial.counted) continue;
    PlacedBlock& block = blocks[id];
    block.answers.presented.push_back(trial.stimulus.class_index);
    block.answers.answered.push_back(trial.response);
    block.places.push_back(place);
  }
  std::vector<PlacedBlock> all;
  for (auto& [id, block] : blocks) all.push_back(std::move(block));
  return all;
}

/// The classes of the scored presentations of one method, in the order of a schedule.
std::vector<int> order_in(const design::Schedule& schedule, int method) {
  std::vector<int> order;
  for (const design::Presentation& shown : schedule.presentations) {
    if (shown.kind == design::PresentationKind::scored && shown.stimulus.method == method) {
      order.push_back(shown.stimulus.class_index);
    }
  }
  return order;
}

/// Draws orders of a block by the study's rule: takes one of kOrders orders from the study's
/// schedules and one of kRenamings renamings of the classes.
class OrderDraws {
 public:
  OrderDraws(const design::Study& study, int method, std::size_t blocks, int deals)
      : blocks_(blocks), random_(0, "chance test", static_cast<std::uint64_t>(method)) {
    // A seed of its own keeps the participants' own orders out of the draws.
    SeededEntropy entropy(study.seed);
    for (int i = 1; i <= kOrders; ++i) {
      const design::ScheduleDraw draw{entropy.secret("chance test: order " + std::to_string(i)), i};
      orders_.push_back(order_in(design::make_schedule(study, draw), method));
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

  [[nodiscard]] std::size_t length() const { return orders_.front().size(); }

  /// \param places  the places in the order whose classes are returned, ascending
  [[nodiscard]] std::vector<int> drawn(std::size_t block, int deal,
                                       const std::vector<int>& places) const {
    const int pick = picks_[static_cast<std::size_t>(deal) * blocks_ + block];
    const std::vector<int>& order = orders_[pick / kRenamings];
    const std::vector<int>& names = renamings_[pick % kRenamings];
    std::vector<int> classes;
    classes.reserve(places.size());
    for (const int place : places) classes.push_back(names[order[place]]);
    return classes;
  }

 private:
  std::size_t blocks_;
  RandomStream random_;
  std::vector<std::vector<int>> orders_;
  std::vector<std::vector<int>> renamings_;
  std::vector<int> picks_;
};

/// The number of draws. Large studies need fewer, because the sum over many blocks varies little.
int deals_for(std::size_t blocks, int most_deals) {
  const auto affordable = kMostBlockDeals / static_cast<int>(std::max<std::size_t>(1, blocks));
  return std::clamp(affordable, std::min(kFewestDeals, most_deals), most_deals);
}

}  // namespace

DealtOrder dealt_order(const design::Study& study) {
  const design::TrialOptions& trials = study.trials;
  const bool limited = trials.max_run > 0;
  if (!limited && trials.order == design::TrialOrder::shuffled) return DealtOrder::permuted;
  if (!limited && trials.order == design::TrialOrder::uniform) return DealtOrder::independent;
  return DealtOrder::redrawn;
}

std::optional<ChanceTest> chance_of(const Outcomes& outcomes, int method, int most_deals) {
  const auto classes = static_cast<int>(outcomes.classes.size());
  const std::vector<PlacedBlock> placed = blocks_of(outcomes, method);
  std::vector<AnsweredBlock> blocks;
  for (const PlacedBlock& block : placed) blocks.push_back(block.answers);
  const DealtOrder order = dealt_order(outcomes.design);
  if (order != DealtOrder::redrawn || blocks.empty()) return chance_test(classes, blocks, order);
  const int deals = deals_for(blocks.size(), most_deals);
  const OrderDraws draws(outcomes.design, method, blocks.size(), deals);
  const auto fits = [&](const PlacedBlock& block) {
    return static_cast<std::size_t>(block.places.back()) < draws.length();
  };
  // If a block has places that the schedules do not have, the test permutes the block's classes
  // without the study's rule.
  if (!std::ranges::all_of(placed, fits)) {
    return chance_test(classes, blocks, DealtOrder::permuted);
  }
  const RedrawnBlock redraw = [&](std::size_t block, int deal) {
    return draws.drawn(block, deal, placed[block].places);
  };
  return chance_test(classes, blocks, order, redraw, deals);
}

ChanceFigures chance_figures(const Outcomes& outcomes, int method, int most_deals) {
  const CountedTrials counted = counted_by_method(outcomes);
  std::vector<double> shares;
  for (const OwnTrials& trials : counted.trials[method]) {
    if (!trials.empty()) shares.push_back(accuracy_of(trials).share().value_or(0.0));
  }
  return {participant_mean(shares), chance_of(outcomes, method, most_deals)};
}

PairFigures pair_figures(const Outcomes& outcomes, int first, int second, bool with_attainable) {
  std::vector<PairedAccuracy> accuracies;
  std::vector<double> differences;
  for (const auto& [a, b] : paired_proportions(counted_by_method(outcomes), first, second)) {
    accuracies.push_back({a.share().value_or(0.0), b.share().value_or(0.0)});
    differences.push_back(without_noise(accuracies.back().first - accuracies.back().second));
  }
  PairFigures numbers;
  numbers.overall = compare_methods(accuracies, 0, 1);
  numbers.overall.bootstrap.reset();
  if (with_attainable) {
    numbers.attainable = sign_flip_attainable(differences, kSignificanceLevel);
  }
  return numbers;
}

}  // namespace touchtrial::analysis::identification
