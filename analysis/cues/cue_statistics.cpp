#include "analysis/cues/cue_statistics.hpp"

#include "analysis/cues/answer_divergence.hpp"
#include "analysis/cues/jobs.hpp"
#include "analysis/statistics/cluster_bootstrap.hpp"
#include "core/random.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <vector>

namespace touchtrial::analysis {
namespace {

constexpr std::size_t kObservers = kCues.size();
constexpr double kNone = std::numeric_limits<double>::quiet_NaN();

/// All that the figures are made of, of one participant or summed over several: the participant's
/// and the observers' accuracies, then the answers to the trials with a response of the
/// participant, the observers, and the observers as unsure as participants.
class Sums {
 public:
  explicit Sums(int classes)
      : classes_(classes),
        cells_(static_cast<std::size_t>(classes) * static_cast<std::size_t>(classes)),
        values_(1 + kObservers + (1 + 2 * kObservers) * cells_, 0.0) {}

  explicit Sums(const ParticipantAnswers& one) : Sums(one.classes()) {
    participants_ = 1;
    values_[0] = one.human_accuracy();
    std::ranges::copy(one.human(), values_.begin() + answers_at(0));
    for (std::size_t i = 0; i < kObservers; ++i) {
      values_[1 + i] = one.available(i);
      std::ranges::copy(one.ideal_of_answered(i), values_.begin() + answers_at(1 + i));
      std::ranges::copy(one.matched_of_answered(i),
                        values_.begin() + answers_at(kFirstMatched + i));
    }
  }

  void add(const Sums& other) noexcept {
    participants_ += other.participants_;
    for (std::size_t i = 0; i < values_.size(); ++i) values_[i] += other.values_[i];
  }

  /// Not a number if the observer is never right.
  [[nodiscard]] double efficiency(std::size_t observer) const noexcept {
    const double available = values_[1 + observer];
    return available > 0.0 ? values_[0] / available : kNone;
  }

  /// Not a number unless the observer is above chance.
  [[nodiscard]] double corrected(std::size_t observer) const noexcept {
    const double by_chance = static_cast<double>(participants_) / classes_;
    const double available = values_[1 + observer] - by_chance;
    // What rounding leaves of nothing is nothing.
    return available > 1e-12 * participants_ ? (values_[0] - by_chance) / available : kNone;
  }

  /// Not a number without a trial with a response.
  [[nodiscard]] double divergence(std::size_t observer) const noexcept {
    return answer_divergence(answers(0), answers(1 + observer), classes_).value_or(kNone);
  }
  [[nodiscard]] double matched_divergence(std::size_t observer) const noexcept {
    return answer_divergence(answers(0), answers(kFirstMatched + observer), classes_)
        .value_or(kNone);
  }

 private:
  /// Whose answers come first among those of the matched observers.
  static constexpr std::size_t kFirstMatched = 1 + kObservers;

  [[nodiscard]] std::ptrdiff_t answers_at(std::size_t whose) const noexcept {
    return static_cast<std::ptrdiff_t>(1 + kObservers + whose * cells_);
  }
  [[nodiscard]] std::span<const double> answers(std::size_t whose) const noexcept {
    return std::span(values_).subspan(static_cast<std::size_t>(answers_at(whose)), cells_);
  }

  int classes_;
  int participants_ = 0;
  std::size_t cells_;
  std::vector<double> values_;
};

/// Indices into the figures of one draw: three a kind, then the difference of two matched
/// divergences.
enum : std::size_t {
  kEfficiencyAt = 0,
  kCorrectedAt = kObservers,
  kDivergenceAt = 2 * kObservers,
  kMatchedAt = 3 * kObservers,
  kDifferenceAt = 4 * kObservers,
  kFigures
};
using Figures = std::array<double, kFigures>;

/// The two observers whose answers come nearest, as unsure as participants.
struct Ranking {
  std::size_t best = 0;
  std::size_t second = 1;
};

Ranking ranking_of(const Figures& figures) {
  std::array<std::size_t, kObservers> order{};
  for (std::size_t i = 0; i < kObservers; ++i) order[i] = i;
  std::ranges::stable_sort(order, {}, [&](std::size_t i) { return figures[kMatchedAt + i]; });
  return {order[0], order[1]};
}

Figures figures_of(const Sums& sums) {
  Figures figures{};
  for (std::size_t i = 0; i < kObservers; ++i) {
    figures[kEfficiencyAt + i] = sums.efficiency(i);
    figures[kCorrectedAt + i] = sums.corrected(i);
    figures[kDivergenceAt + i] = sums.divergence(i);
    figures[kMatchedAt + i] = sums.matched_divergence(i);
  }
  return figures;
}

void put_difference(Figures& figures, const Ranking& ranking) {
  figures[kDifferenceAt] =
      figures[kMatchedAt + ranking.second] - figures[kMatchedAt + ranking.best];
}

/// What studies of as many participants, drawn from these, would have found.
struct Draws {
  std::size_t participants = 0;
  std::vector<Figures> figures{};  ///< none if there is but one participant
};

Draws drawn(const std::vector<Sums>& participants, int classes, const Ranking& ranking,
            std::uint64_t index, int jobs) {
  if (participants.size() < 2) return {participants.size()};
  std::vector<Figures> draws(kBootstrapDraws);
  const auto draw = [&](std::size_t i) {
    // A stream for each draw, so that it does not matter which thread makes it.
    RandomStream random(0, "cues: participants", (index << 32U) + i);
    Sums sums(classes);
    for (std::size_t p = 0; p < participants.size(); ++p) {
      sums.add(participants[random.below(participants.size())]);
    }
    draws[i] = figures_of(sums);
    put_difference(draws[i], ranking);
  };
  in_parallel(jobs, draws.size(), draw);
  return {participants.size(), std::move(draws)};
}

/// Nothing if a single draw leaves the figure undefined.
std::optional<Interval> interval_of(const Draws& draws, std::size_t figure) {
  std::vector<double> values;
  for (const Figures& one : draws.figures) {
    if (std::isnan(one[figure])) return std::nullopt;
    values.push_back(one[figure]);
  }
  if (values.empty()) return std::nullopt;
  return expanded_percentiles(std::move(values), draws.participants);
}

CueFigure figure_at(std::size_t at, const Figures& observed, const Draws& draws) {
  if (std::isnan(observed[at])) return {};
  return {observed[at], interval_of(draws, at)};
}

std::optional<CueMatch> match_of(const Ranking& ranking, const Figures& observed,
                                 const Draws& draws) {
  if (std::isnan(observed[kDifferenceAt])) return std::nullopt;
  CueMatch match;
  match.best = kCues[ranking.best];
  match.second = kCues[ranking.second];
  match.difference = figure_at(kDifferenceAt, observed, draws);
  match.told_apart = draws.participants >= kFewestForVerdict && match.difference.interval &&
                     match.difference.interval->low > 0.0;
  return match;
}

}  // namespace

CueStatistics cue_statistics(std::span<const ParticipantAnswers> participants, std::uint64_t index,
                             int jobs) {
  if (participants.empty()) return {};
  const int classes = participants.front().classes();
  std::vector<Sums> each;
  Sums together(classes);
  for (const ParticipantAnswers& one : participants) together.add(each.emplace_back(one));
  Figures observed = figures_of(together);
  const Ranking ranking = ranking_of(observed);
  put_difference(observed, ranking);
  const Draws draws = drawn(each, classes, ranking, index, jobs);
  CueStatistics statistics;
  for (std::size_t i = 0; i < kObservers; ++i) {
    statistics.efficiency[i] = figure_at(kEfficiencyAt + i, observed, draws);
    statistics.corrected[i] = figure_at(kCorrectedAt + i, observed, draws);
    statistics.divergence[i] = figure_at(kDivergenceAt + i, observed, draws);
    statistics.matched_divergence[i] = figure_at(kMatchedAt + i, observed, draws);
  }
  statistics.match = match_of(ranking, observed, draws);
  return statistics;
}

}  // namespace touchtrial::analysis
