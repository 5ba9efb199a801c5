#include "protocols/identification/analysis/cues/cue_statistics.hpp"

#include "analysis/statistics/cluster_bootstrap.hpp"
#include "core/parallel.hpp"
#include "core/random.hpp"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <limits>
#include <numeric>
#include <utility>
#include <vector>

namespace touchtrial::analysis::identification {

namespace {

double total(std::span<const double> counts) noexcept {
  return std::accumulate(counts.begin(), counts.end(), 0.0);
}

/// p log2 (p / middle), which is 0 where p is 0.
double information(double p, double middle) noexcept {
  return p > 0.0 ? p * std::log2(p / middle) : 0.0;
}

constexpr std::size_t kObservers = kCues.size();
constexpr double kUndefined = std::numeric_limits<double>::quiet_NaN();

/// The sums behind all numbers, for one participant or several. The first group of values holds the
/// accuracies of the participant and of the observers. The second group holds the answers to trials
/// with a response: those of the participant, of the ideal observers and of the matched observers.
class Sums {
 public:
  explicit Sums(int classes)
      : classes_(classes),
        cells_(static_cast<std::size_t>(classes) * static_cast<std::size_t>(classes)),
        values_(1 + kObservers + (1 + 2 * kObservers) * cells_, 0.0) {}

  explicit Sums(const ParticipantAnswers& one) : Sums(one.classes) {
    participants_ = 1;
    values_[0] = one.human_accuracy();
    std::ranges::copy(one.human, values_.begin() + answers_at(0));
    for (std::size_t i = 0; i < kObservers; ++i) {
      values_[1 + i] = one.available(i);
      std::ranges::copy(one.ideal_of_answered[i], values_.begin() + answers_at(1 + i));
      std::ranges::copy(one.matched_of_answered[i],
                        values_.begin() + answers_at(kFirstMatched + i));
    }
  }

  void add(const Sums& other) noexcept {
    participants_ += other.participants_;
    for (std::size_t i = 0; i < values_.size(); ++i) values_[i] += other.values_[i];
  }

  /// The efficiency; NaN if the observer is never right.
  [[nodiscard]] double efficiency(std::size_t observer) const noexcept {
    const double available = values_[1 + observer];
    return available > 0.0 ? values_[0] / available : kUndefined;
  }

  /// The efficiency above chance; NaN unless the observer is above chance.
  [[nodiscard]] double corrected(std::size_t observer) const noexcept {
    const double by_chance = static_cast<double>(participants_) / classes_;
    const double available = values_[1 + observer] - by_chance;
    // A difference within rounding counts as 0.
    return available > 1e-12 * participants_ ? (values_[0] - by_chance) / available : kUndefined;
  }

  /// The divergence in bits; NaN without a trial with a response.
  [[nodiscard]] double divergence(std::size_t observer) const noexcept {
    return answer_divergence(answers(0), answers(1 + observer), classes_).value_or(kUndefined);
  }
  [[nodiscard]] double matched_divergence(std::size_t observer) const noexcept {
    return answer_divergence(answers(0), answers(kFirstMatched + observer), classes_)
        .value_or(kUndefined);
  }

 private:
  /// Index of the first matched observer's answers.
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

Sums sum_of(const std::vector<Sums>& each, int classes) {
  Sums together(classes);
  for (const Sums& one : each) together.add(one);
  return together;
}

/// Indices into the numbers of a study: kObservers of each kind.
enum : std::size_t {
  kEfficiencyAt = 0,
  kCorrectedAt = kObservers,
  kDivergenceAt = 2 * kObservers,
  kMatchedAt = 3 * kObservers,
  kNumbers = 4 * kObservers
};
using Numbers = std::array<double, kNumbers>;

Numbers efficiencies_of(const Sums& sums) {
  Numbers numbers{};
  for (std::size_t i = 0; i < kObservers; ++i) {
    numbers[kEfficiencyAt + i] = sums.efficiency(i);
    numbers[kCorrectedAt + i] = sums.corrected(i);
  }
  return numbers;
}

Numbers divergences_of(const Sums& sums) {
  Numbers numbers = efficiencies_of(sums);
  for (std::size_t i = 0; i < kObservers; ++i) {
    numbers[kDivergenceAt + i] = sums.divergence(i);
    numbers[kMatchedAt + i] = sums.matched_divergence(i);
  }
  return numbers;
}

/// The numbers of resampled studies. A resampled study draws as many participants as there are,
/// with replacement.
struct Draws {
  std::size_t participants = 0;
  std::vector<Numbers> numbers{};  ///< empty with fewer than two participants
};

/// Draws only efficiencies; divergences of bootstrap samples are biased upward.
Draws drawn(const std::vector<Sums>& participants, int classes, std::uint64_t index, int jobs) {
  if (participants.size() < 2) return {participants.size()};
  std::vector<Numbers> draws(kBootstrapDraws);
  const auto draw = [&](std::size_t i) {
    // Each draw has its own stream, so the result does not depend on the threads.
    RandomStream random(0, "cues: participants", (index << 32U) + i);
    Sums sums(classes);
    for (std::size_t p = 0; p < participants.size(); ++p) {
      sums.add(participants[random.below(participants.size())]);
    }
    draws[i] = efficiencies_of(sums);
  };
  in_parallel(jobs, draws.size(), draw);
  return {participants.size(), std::move(draws)};
}

/// The interval of a number; nothing if the number is undefined in any draw.
std::optional<Interval> interval_of(const Draws& draws, std::size_t number) {
  std::vector<double> values;
  for (const Numbers& one : draws.numbers) {
    if (std::isnan(one[number])) return std::nullopt;
    values.push_back(one[number]);
  }
  if (values.empty()) return std::nullopt;
  return expanded_percentiles(std::move(values), draws.participants);
}

CueFigure number_at(std::size_t at, const Numbers& observed, const Draws& draws) {
  if (std::isnan(observed[at])) return {};
  return {observed[at], interval_of(draws, at)};
}

/// The numbers without each participant, by sums from both ends of the list.
std::vector<Numbers> without_each(const std::vector<Sums>& participants, int classes) {
  std::vector<Sums> after(participants.size(), Sums(classes));
  for (std::size_t i = participants.size() - 1; i > 0; --i) {
    after[i - 1] = after[i];
    after[i - 1].add(participants[i]);
  }
  std::vector<Numbers> numbers;
  Sums before(classes);
  for (std::size_t i = 0; i < participants.size(); ++i) {
    after[i].add(before);
    numbers.push_back(divergences_of(after[i]));
    before.add(participants[i]);
  }
  return numbers;
}

constexpr Interval kBits{0.0, 1.0};
/// The range for differences and for numbers to rank, which are not cut at 0.
constexpr Interval kAnySign{-2.0, 2.0};

/// The jackknife estimate of a number, or of the difference of two.
/// \param without  the same numbers without each participant
CueFigure jackknifed(const Numbers& observed, const std::vector<Numbers>& without,
                     const Interval& range, std::size_t at, std::optional<std::size_t> less = {}) {
  const auto number_of = [&](const Numbers& numbers) {
    return less ? numbers[at] - numbers[*less] : numbers[at];
  };
  const double all = number_of(observed);
  if (std::isnan(all)) return {};
  std::vector<double> values;
  for (const Numbers& one : without) values.push_back(number_of(one));
  if (values.size() < 2 || std::ranges::any_of(values, [](double v) { return std::isnan(v); })) {
    return {all, std::nullopt};
  }
  const JackknifeEstimate found = jackknife(all, values, range);
  return {found.value, found.interval};
}

/// The two matched observers with the smallest divergences.
std::optional<CueMatch> cue_match_of(const Numbers& observed, const std::vector<Numbers>& without) {
  std::array<std::size_t, kObservers> order{};
  std::array<double, kObservers> divergence{};
  for (std::size_t i = 0; i < kObservers; ++i) {
    const CueFigure found = jackknifed(observed, without, kAnySign, kMatchedAt + i);
    if (!found.value) return std::nullopt;
    divergence[i] = *found.value;
    order[i] = i;
  }
  std::ranges::stable_sort(order, {}, [&](std::size_t i) { return divergence[i]; });
  CueMatch match;
  match.best = kCues[order[0]];
  match.second = kCues[order[1]];
  match.difference =
      jackknifed(observed, without, kAnySign, kMatchedAt + order[1], kMatchedAt + order[0]);
  match.is_distinct = without.size() >= kMinForVerdict && match.difference.interval &&
                      match.difference.interval->low > 0.0;
  return match;
}

}  // namespace

double jensen_shannon_bits(std::span<const double> a, std::span<const double> b) noexcept {
  const double all_a = total(a);
  const double all_b = total(b);
  double bits = 0.0;
  for (std::size_t i = 0; i < a.size(); ++i) {
    const double p = a[i] / all_a;
    const double q = b[i] / all_b;
    const double middle = 0.5 * (p + q);
    bits += 0.5 * (information(p, middle) + information(q, middle));
  }
  // Rounding may lead out of the range of the divergence.
  return std::clamp(bits, 0.0, 1.0);
}

std::optional<double> answer_divergence(std::span<const double> a, std::span<const double> b,
                                        int classes) noexcept {
  const auto side = static_cast<std::size_t>(classes);
  double sum = 0.0;
  int presented = 0;
  for (std::size_t row = 0; row < side; ++row) {
    const std::span<const double> row_a = a.subspan(row * side, side);
    const std::span<const double> row_b = b.subspan(row * side, side);
    if (total(row_a) <= 0.0 || total(row_b) <= 0.0) continue;
    sum += jensen_shannon_bits(row_a, row_b);
    ++presented;
  }
  if (presented == 0) return std::nullopt;
  return sum / presented;
}

CueStatistics cue_divergences(std::span<const ParticipantAnswers> participants) {
  if (participants.empty()) return {};
  const std::vector<Sums> each(participants.begin(), participants.end());
  const int classes = participants.front().classes;
  const Numbers observed = divergences_of(sum_of(each, classes));
  const std::vector<Numbers> without = without_each(each, classes);
  CueStatistics statistics;
  for (std::size_t i = 0; i < kObservers; ++i) {
    statistics.divergence[i] = jackknifed(observed, without, kBits, kDivergenceAt + i);
    statistics.matched_divergence[i] = jackknifed(observed, without, kBits, kMatchedAt + i);
  }
  statistics.match = cue_match_of(observed, without);
  return statistics;
}

CueStatistics cue_statistics(std::span<const ParticipantAnswers> participants, std::uint64_t index,
                             int jobs) {
  CueStatistics statistics = cue_divergences(participants);
  if (participants.empty()) return statistics;
  const std::vector<Sums> each(participants.begin(), participants.end());
  const int classes = participants.front().classes;
  const Numbers observed = efficiencies_of(sum_of(each, classes));
  const Draws draws = drawn(each, classes, index, jobs);
  for (std::size_t i = 0; i < kObservers; ++i) {
    statistics.efficiency[i] = number_at(kEfficiencyAt + i, observed, draws);
    statistics.corrected[i] = number_at(kCorrectedAt + i, observed, draws);
  }
  return statistics;
}

ParticipantAnswers::ParticipantAnswers(std::string name, int class_count)
    : participant(std::move(name)),
      classes(class_count),
      presented(static_cast<std::size_t>(class_count), 0),
      no_response(presented),
      human(presented.size() * presented.size(), 0.0) {
  for (auto* counts : {&ideal, &matched, &ideal_of_answered, &matched_of_answered}) {
    counts->fill(human);
  }
}

void ParticipantAnswers::add(const JudgedTrial& trial) {
  const int row = trial.presented * classes;
  ++trials;
  ++presented[trial.presented];
  if (trial.response) {
    human[row + *trial.response] += 1.0;
    human_right += *trial.response == trial.presented ? 1.0 : 0.0;
  } else {
    ++no_response[trial.presented];
  }
  const auto add_shares = [&](FlatCounts& counts, const AnswerShares& shares) {
    for (int answer = 0; answer < classes; ++answer) counts[row + answer] += shares[answer];
  };
  for (std::size_t observer = 0; observer < kCues.size(); ++observer) {
    right[observer] += trial.ideal[observer][trial.presented];
    add_shares(ideal[observer], trial.ideal[observer]);
    add_shares(matched[observer], trial.matched[observer]);
    if (!trial.response) continue;
    add_shares(ideal_of_answered[observer], trial.ideal[observer]);
    add_shares(matched_of_answered[observer], trial.matched[observer]);
  }
}

}  // namespace touchtrial::analysis::identification
