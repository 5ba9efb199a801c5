#include "protocols/identification/analysis/chance.hpp"

#include "analysis/statistics/common.hpp"
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

constexpr int kFewestDeals = 999;
constexpr int kMostBlockDeals = 1'000'000;  ///< takes at most one second

/// A block's counted trials, each with its place among the scored presentations of the method.
struct PlacedBlock {
  int person = 0;  ///< see People
  AnsweredBlock answers;
  std::vector<int> places;
};

/// The blocks with trials of one method, ordered by participant, session and block. Voided trials
/// have no place, because their block was restarted.
std::vector<PlacedBlock> blocks_of(const Outcomes& outcomes, int method) {
  const People people(outcomes);
  std::map<std::tuple<int, int, int>, PlacedBlock> blocks;
  std::map<std::tuple<int, int, int>, int> next_place;
  for (const TrialOutcome& trial : outcomes.trials) {
    const bool has_place = trial.scored && trial.stimulus.method == method &&
                           trial.row.state != record::TrialState::voided;
    if (!has_place) continue;
    const int person = people.of(trial.row.session);
    const std::tuple id(person, trial.row.session, trial.row.block);
    const int place = next_place[id]++;
    if (!trial.counted) continue;
    PlacedBlock& block = blocks[id];
    block.person = person;
    block.answers.presented.push_back(trial.stimulus.class_index);
    block.answers.answered.push_back(trial.response);
    block.places.push_back(place);
  }
  std::vector<PlacedBlock> all;
  for (auto& [id, block] : blocks) all.push_back(std::move(block));
  return all;
}

/// The number of draws. Large studies need fewer, because the sum over many blocks varies little.
int deals_for(std::size_t blocks, int most_deals) {
  const auto affordable = kMostBlockDeals / static_cast<int>(std::max<std::size_t>(1, blocks));
  return std::clamp(affordable, std::min(kFewestDeals, most_deals), most_deals);
}

/// The number of draws of one participant's test; level * (draws + 1) is whole.
int own_deals_for(std::size_t blocks) {
  constexpr std::array kDeals = {999, 199};
  for (const int deals : kDeals) {
    if (blocks * static_cast<std::size_t>(deals) <= std::size_t{kMostBlockDeals}) return deals;
  }
  return 99;
}

/// The chance tests of some of a study's blocks, over the same drawn orders.
class BlockTests {
 public:
  /// \param placed,known  must outlive this; `known` may be null
  BlockTests(const Outcomes& outcomes, int method, const std::vector<PlacedBlock>& placed,
             int deals, KnownMatches* known)
      : classes_(static_cast<int>(outcomes.classes.size())),
        placed_(placed),
        order_(dealt_order(outcomes.design)),
        deals_(deals),
        known_(known) {
    if (order_ != DealtOrder::redrawn || placed.empty()) return;
    draws_.emplace(outcomes.design, method, placed.size(), deals, "chance test");
    const auto fits = [&](const PlacedBlock& block) {
      return static_cast<std::size_t>(block.places.back()) < draws_->length();
    };
    // If a block has places that the schedules do not have, the test permutes the block's classes
    // without the study's rule.
    if (!std::ranges::all_of(placed, fits)) order_ = DealtOrder::permuted;
  }

  /// \param first,last  blocks
  [[nodiscard]] std::optional<ChanceTest> of(std::size_t first, std::size_t last) {
    std::vector<AnsweredBlock> blocks;
    for (std::size_t i = first; i < last; ++i) blocks.push_back(placed_[i].answers);
    RedrawnBlock redraw;
    if (order_ == DealtOrder::redrawn && draws_) {
      redraw = [this, first](std::size_t block, int deal) {
        return draws_->drawn(first + block, deal, placed_[first + block].places);
      };
    } else if (order_ == DealtOrder::redrawn) {
      return std::nullopt;  // without blocks
    }
    return chance_test(classes_, blocks, order_, redraw, deals_, known_);
  }

 private:
  int classes_;
  const std::vector<PlacedBlock>& placed_;
  DealtOrder order_;
  int deals_;
  KnownMatches* known_;
  std::optional<OrderDraws> draws_;
};

}  // namespace

std::optional<ChanceTest> chance_of(const Outcomes& outcomes, int method, int most_deals,
                                    KnownMatches* known) {
  const std::vector<PlacedBlock> placed = blocks_of(outcomes, method);
  const bool redrawn = dealt_order(outcomes.design) == DealtOrder::redrawn;
  const int deals = redrawn ? deals_for(placed.size(), most_deals) : kMostChanceDeals;
  return BlockTests(outcomes, method, placed, deals, known).of(0, placed.size());
}

std::optional<Prevalence> own_prevalence(const Outcomes& outcomes, int method,
                                         KnownMatches* known) {
  const std::vector<PlacedBlock> placed = blocks_of(outcomes, method);
  BlockTests tests(outcomes, method, placed, own_deals_for(placed.size()), known);
  Proportion passed;
  double level = 0.0;
  for (std::size_t first = 0; first < placed.size();) {
    std::size_t last = first + 1;
    while (last < placed.size() && placed[last].person == placed[first].person) ++last;
    if (const auto test = tests.of(first, last)) {
      ++passed.n;
      if (test->p <= kSignificanceLevel) ++passed.correct;
      level += test->attainable;
    }
    first = last;
  }
  if (passed.n == 0) return std::nullopt;
  return prevalence_of(passed, level / passed.n);
}

}  // namespace touchtrial::analysis::identification
