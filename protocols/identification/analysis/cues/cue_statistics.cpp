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

/// p log2 (p / middle); 0 for p = 0.
double information(double p, double middle) noexcept {
  return p > 0.0 ? p * std::log2(p / middle) : 0.0;
}

constexpr std::size_t kObservers = kCues.size();
constexpr double kUndefined = std::numeric_limits<double>::quiet_NaN();

/// The sums over participants from which all numbers follow. The values are the accuracies of the
/// participant and of the observers, then the counts of answers to trials with a response: of the
/// participant, of the ideal observers and of the matched observers.
class Sums {
 public:
  explicit Sums(int classes)
      : classes_(classes),
        cells_(static_cast<std::size_t>(classes) * static_cast<std::size_t>(classes)),
        values_(1 + kObservers + (1 + 2 * kObservers) * cells_, 0.0) {}

  explicit Sums(const ParticipantAnswers& participant) : Sums(participant.classes) {
    participants_ = 1;
    values_[0] = participant.human_accuracy();
    std::ranges::copy(participant.human, values_.begin() + answers_at(0));
    for (std::size_t i = 0; i < kObservers; ++i) {
      values_[1 + i] = participant.observer_accuracy(i);
      std::ranges::copy(participant.answered_ideal[i], values_.begin() + answers_at(1 + i));
      std::ranges::copy(participant.answered_matched[i],
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
  [[nodiscard]] double corrected_efficiency(std::size_t observer) const noexcept {
    const double chance = static_cast<double>(participants_) / classes_;
    const double available = values_[1 + observer] - chance;
    // 1e-12 allows for rounding.
    return available > 1e-12 * participants_ ? (values_[0] - chance) / available : kUndefined;
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

  [[nodiscard]] std::ptrdiff_t answers_at(std::size_t observer) const noexcept {
    return static_cast<std::ptrdiff_t>(1 + kObservers + observer * cells_);
  }
  [[nodiscard]] std::span<const double> answers(std::size_t observer) const noexcept {
    return std::span(values_).subspan(static_cast<std::size_t>(answers_at(observer)), cells_);
  }

  int classes_;
  int participants_ = 0;
  std::size_t cells_;
  std::vector<double> values_;
};

Sums sum_of(const std::vector<Sums>& participants, int classes) {
  Sums sum(classes);
  for (const Sums& participant : participants) sum.add(participant);
  return sum;
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
    numbers[kCorrectedAt + i] = sums.corrected_efficiency(i);
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

/// The numbers of bootstrap samples.
struct Draws {
  std::size_t participants = 0;
  std::vector<Numbers> numbers{};  ///< empty with fewer than two participants
};

/// Draws only efficiencies; divergences of bootstrap samples are biased upward.
Draws bootstrap_draws(const std::vector<Sums>& participants, int classes, std::uint64_t index,
                      int jobs) {
  if (participants.size() < 2) return {participants.size()};
  std::vector<Numbers> draws(kBootstrapDraws);
  const auto draw = [&](std::size_t i) {
    // One stream per draw, so that the result does not depend on the threads.
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
  for (const Numbers& numbers : draws.numbers) {
    if (std::isnan(numbers[number])) return std::nullopt;
    values.push_back(numbers[number]);
  }
  if (values.empty()) return std::nullopt;
  return expanded_percentiles(std::move(values), draws.participants);
}

CueFigure number_at(std::size_t index, const Numbers& observed, const Draws& draws) {
  if (std::isnan(observed[index])) return {};
  return {observed[index], interval_of(draws, index)};
}

/// The numbers without each participant, from sums over both ends of the list.
std::vector<Numbers> leave_one_out_numbers(const std::vector<Sums>& participants, int classes) {
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
/// For differences and for ranks, which are not truncated at 0.
constexpr Interval kAnySign{-2.0, 2.0};

/// The jackknife estimate of a number, or of the difference of two.
/// \param leave_one_out  the numbers without each participant
CueFigure jackknife_figure(const Numbers& observed, const std::vector<Numbers>& leave_one_out,
                           const Interval& range, std::size_t index,
                           std::optional<std::size_t> subtracted = {}) {
  const auto number_of = [&](const Numbers& numbers) {
    return subtracted ? numbers[index] - numbers[*subtracted] : numbers[index];
  };
  const double value = number_of(observed);
  if (std::isnan(value)) return {};
  std::vector<double> values;
  for (const Numbers& numbers : leave_one_out) values.push_back(number_of(numbers));
  if (values.size() < 2 || std::ranges::any_of(values, [](double v) { return std::isnan(v); })) {
    return {value, std::nullopt};
  }
  const JackknifeEstimate estimate = jackknife(value, values, range);
  return {estimate.value, estimate.interval};
}

/// The two matched observers with the smallest divergences.
std::optional<CueMatch> cue_match_of(const Numbers& observed,
                                     const std::vector<Numbers>& leave_one_out) {
  std::array<std::size_t, kObservers> order{};
  std::array<double, kObservers> divergence{};
  for (std::size_t i = 0; i < kObservers; ++i) {
    const CueFigure estimate = jackknife_figure(observed, leave_one_out, kAnySign, kMatchedAt + i);
    if (!estimate.value) return std::nullopt;
    divergence[i] = *estimate.value;
    order[i] = i;
  }
  std::ranges::stable_sort(order, {}, [&](std::size_t i) { return divergence[i]; });
  CueMatch match;
  match.best = kCues[order[0]];
  match.second = kCues[order[1]];
  match.difference = jackknife_figure(observed, leave_one_out, kAnySign, kMatchedAt + order[1],
                                      kMatchedAt + order[0]);
  match.is_distinct = leave_one_out.size() >= kMinForVerdict && match.difference.interval &&
                      match.difference.interval->low > 0.0;
  return match;
}

}  // namespace

double jensen_shannon_bits(std::span<const double> a, std::span<const double> b) noexcept {
  const double total_a = total(a);
  const double total_b = total(b);
  double bits = 0.0;
  for (std::size_t i = 0; i < a.size(); ++i) {
    const double p = a[i] / total_a;
    const double q = b[i] / total_b;
    const double middle = 0.5 * (p + q);
    bits += 0.5 * (information(p, middle) + information(q, middle));
  }
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
  const std::vector<Sums> sums(participants.begin(), participants.end());
  const int classes = participants.front().classes;
  const Numbers observed = divergences_of(sum_of(sums, classes));
  const std::vector<Numbers> leave_one_out = leave_one_out_numbers(sums, classes);
  CueStatistics statistics;
  for (std::size_t i = 0; i < kObservers; ++i) {
    statistics.divergence[i] = jackknife_figure(observed, leave_one_out, kBits, kDivergenceAt + i);
    statistics.matched_divergence[i] =
        jackknife_figure(observed, leave_one_out, kBits, kMatchedAt + i);
  }
  statistics.match = cue_match_of(observed, leave_one_out);
  return statistics;
}

CueStatistics cue_statistics(std::span<const ParticipantAnswers> participants, std::uint64_t index,
                             int jobs) {
  CueStatistics statistics = cue_divergences(participants);
  if (participants.empty()) return statistics;
  const std::vector<Sums> sums(participants.begin(), participants.end());
  const int classes = participants.front().classes;
  const Numbers observed = efficiencies_of(sum_of(sums, classes));
  const Draws draws = bootstrap_draws(sums, classes, index, jobs);
  for (std::size_t i = 0; i < kObservers; ++i) {
    statistics.efficiency[i] = number_at(kEfficiencyAt + i, observed, draws);
    statistics.corrected_efficiency[i] = number_at(kCorrectedAt + i, observed, draws);
  }
  return statistics;
}

ParticipantAnswers::ParticipantAnswers(std::string name, int class_count)
    : participant(std::move(name)),
      classes(class_count),
      presented(static_cast<std::size_t>(class_count), 0),
      no_response(presented),
      human(presented.size() * presented.size(), 0.0) {
  for (auto* counts : {&ideal, &matched, &answered_ideal, &answered_matched}) {
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
    add_shares(answered_ideal[observer], trial.ideal[observer]);
    add_shares(answered_matched[observer], trial.matched[observer]);
  }
}

}  // namespace touchtrial::analysis::identification
