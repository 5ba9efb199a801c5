#include "protocols/session/answer_summary.hpp"

#include <algorithm>
#include <cmath>
#include <map>
#include <vector>

namespace touchtrial::session {
namespace {

/// To tenths of a second: an exact time would tell more than how quickly somebody answers.
double median_s(std::span<const GivenAnswer> answers) {
  std::vector<double> times_s;
  for (const GivenAnswer& answer : answers) {
    times_s.push_back(std::chrono::duration<double>(answer.took).count());
  }
  std::ranges::sort(times_s);
  const std::size_t half = times_s.size() / 2;
  const bool is_odd = times_s.size() % 2 == 1;
  const double median = is_odd ? times_s[half] : (times_s[half - 1] + times_s[half]) / 2.0;
  return std::round(10.0 * median) / 10.0;
}

int longest_run(std::span<const GivenAnswer> answers) {
  int longest = 0;
  int run = 0;
  for (std::size_t i = 0; i < answers.size(); ++i) {
    const bool goes_on = i > 0 && answers[i].position == answers[i - 1].position;
    run = goes_on ? run + 1 : 1;
    longest = std::max(longest, run);
  }
  return longest;
}

}  // namespace

std::optional<store::AnswerSummary> summary_of(std::span<const GivenAnswer> answers) {
  if (answers.empty()) return std::nullopt;
  std::map<int, int> counts;
  int most = 0;
  for (const GivenAnswer& answer : answers) most = std::max(most, ++counts[answer.position]);
  const auto n = static_cast<int>(answers.size());
  return store::AnswerSummary{.n = n,
                              .different = static_cast<int>(counts.size()),
                              .largest_share = static_cast<double>(most) / n,
                              .longest_run = longest_run(answers),
                              .median_s = median_s(answers)};
}

}  // namespace touchtrial::session
