#include "analysis/choices/preferences.hpp"

#include "analysis/statistics/chance_test.hpp"
#include "analysis/statistics/paired_tests.hpp"
#include "core/answer.hpp"
#include "core/random.hpp"

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <iterator>
#include <map>
#include <numeric>
#include <utility>

namespace touchtrial::choices {
namespace {

using analysis::GlobalNullTest;
using analysis::ranked_p;

constexpr std::size_t kMaxDrawnAnswers = 20'000'000;  ///< takes about a third of a second
constexpr std::size_t kMinPreferenceDeals = 999;

int affordable_deals(std::size_t answers, std::size_t max_deals) {
  const std::size_t affordable = kMaxDrawnAnswers / std::max<std::size_t>(1, answers);
  return static_cast<int>(
      std::clamp<std::size_t>(affordable, std::min(kMinPreferenceDeals, max_deals), max_deals));
}

bool is_index(std::optional<int> choice, int choices) {
  return choice && *choice >= 0 && *choice < choices;
}

/// The trials of a person whose answer and right choice are both known.
PersonTrials answered_trials(const Person& person, int choices, const TrialFilter& is_included) {
  PersonTrials answered;
  std::ranges::copy_if(person.trials, std::back_inserter(answered), [&](const TrialOutcome* trial) {
    return is_included(*trial) && is_index(trial->response, choices) &&
           is_index(trial->right, choices);
  });
  return answered;
}

/// The place on the screen of the last answer that named a choice.
std::optional<int> last_place_of(const PersonTrials& trials, int choice) {
  for (auto trial = trials.rbegin(); trial != trials.rend(); ++trial) {
    if ((*trial)->response == choice) return position_of((*trial)->row.answer);
  }
  return std::nullopt;
}

/// A participant's preference, without its p.
/// \param excess_counts  by choice: named minus expected
Preference preference_of(const std::string& participant, const PersonTrials& trials,
                         std::span<const double> excess_counts) {
  Preference preference;
  preference.participant = participant;
  preference.choice =
      static_cast<int>(std::ranges::max_element(excess_counts) - excess_counts.begin());
  for (const TrialOutcome* trial : trials) {
    ++preference.answers;
    preference.named_count += *trial->response == preference.choice ? 1 : 0;
    (*trial->right == preference.choice ? preference.right_there : preference.right_elsewhere)
        .add(trial->correct());
  }
  return preference;
}

/// Sets the p of the people who were tested, and their adjusted p.
void store_p_values(const std::vector<std::size_t>& tested, const std::vector<double>& p,
                    std::vector<Preference>& people) {
  const std::vector<double> adjusted = analysis::holm_adjusted(p);
  for (std::size_t i = 0; i < tested.size(); ++i) {
    people[tested[i]].p = p[i];
    people[tested[i]].p_holm = adjusted[i];
  }
}

double sum_of_squares(std::span<const double> values) {
  return std::inner_product(values.begin(), values.end(), values.begin(), 0.0);
}

/// If all answers are right, or all wrong, accuracy cannot depend on the right choice.
bool has_right_and_wrong(const PersonTrials& trials) {
  const Proportion right = accuracy_of(trials);
  return right.correct > 0 && right.correct < right.n;
}

/// How often each choice was named and was right.
struct ChoiceTally {
  explicit ChoiceTally(int choices)
      : answer_counts(static_cast<std::size_t>(choices)), target_counts(answer_counts.size()) {}

  void add(std::uint64_t response, std::uint64_t target) {
    ++answer_counts[static_cast<std::size_t>(response)];
    ++target_counts[static_cast<std::size_t>(target)];
  }

  /// S_k of preferences_by_target.
  [[nodiscard]] std::vector<double> excess_counts(int n, int right) const {
    const double share = static_cast<double>(right) / n;
    const double other_share = (1.0 - share) / static_cast<double>(answer_counts.size() - 1);
    std::vector<double> all(answer_counts.size());
    for (std::size_t k = 0; k < all.size(); ++k) {
      all[k] = answer_counts[k] - share * target_counts[k] - other_share * (n - target_counts[k]);
    }
    return all;
  }

  std::vector<int> answer_counts;
  std::vector<int> target_counts;
};

/// Redraws choices without a preference, with the same numbers of right and wrong answers.
ChoiceTally redrawn_choices(int choices, int n, int right, RandomStream& random) {
  const auto m = static_cast<std::uint64_t>(choices);
  ChoiceTally tally(choices);
  for (int i = 0; i < n; ++i) {
    const std::uint64_t target = random.below(m);
    tally.add(i < right ? target : (target + 1 + random.below(m - 1)) % m, target);
  }
  return tally;
}

/// S_k of preferences_by_target for the observed answers.
std::vector<double> observed_excess(const PersonTrials& trials, int choices) {
  ChoiceTally tally(choices);
  for (const TrialOutcome* trial : trials) {
    tally.add(static_cast<std::uint64_t>(*trial->response),
              static_cast<std::uint64_t>(*trial->right));
  }
  const Proportion right = accuracy_of(trials);
  return tally.excess_counts(right.n, right.correct);
}

/// S_k of the observed answers, then of each deal.
std::vector<std::vector<double>> dealt_excess(const PersonTrials& trials, int choices, int deals,
                                              RandomStream& random) {
  const Proportion right = accuracy_of(trials);
  std::vector<std::vector<double>> excess_counts{observed_excess(trials, choices)};
  for (int deal = 0; deal < deals; ++deal) {
    excess_counts.push_back(redrawn_choices(choices, right.n, right.correct, random)
                                .excess_counts(right.n, right.correct));
  }
  return excess_counts;
}

std::vector<double> squares_of(const std::vector<std::vector<double>>& dealt) {
  std::vector<double> squares;
  squares.reserve(dealt.size());
  for (const std::vector<double>& values : dealt) squares.push_back(sum_of_squares(values));
  return squares;
}

/// A wrong answer that confuses a pair of stimuli.
struct Mistake {
  std::size_t person = 0;
  std::size_t session = 0;  ///< index over all people's sessions
  int first = 0;            ///< of the pair, the lower index
  int second = 1;
  bool named_second = true;
};

/// Wrong answers, grouped by pair of stimuli.
class Mistakes {
 public:
  Mistakes(std::span<const PersonTrials> people, int choices) : people_(people.size()) {
    choices_ = static_cast<std::size_t>(choices);
    std::map<int, std::size_t> sessions;
    for (std::size_t person = 0; person < people.size(); ++person) {
      for (const TrialOutcome* trial : people[person]) {
        if (trial->correct()) continue;
        const std::size_t session =
            sessions.try_emplace(trial->row.session, sessions.size()).first->second;
        const auto [low, high] = std::minmax({*trial->right, *trial->response});
        all_.push_back({person, session, low, high, *trial->response == high});
      }
    }
    std::ranges::stable_sort(
        all_, {}, [](const Mistake& mistake) { return std::pair(mistake.first, mistake.second); });
    person_of_.resize(sessions.size());
    for (const Mistake& mistake : all_) person_of_[mistake.session] = mistake.person;
    set_expected();
  }

  [[nodiscard]] std::size_t size() const { return all_.size(); }

  /// Named minus expected, by session and choice.
  [[nodiscard]] std::vector<double> excess_counts() const {
    std::vector<double> counts(expected_.size());
    for (std::size_t i = 0; i < counts.size(); ++i) counts[i] = -expected_[i];
    for (const Mistake& mistake : all_) add(mistake, mistake.named_second ? 1.0 : -1.0, counts);
    return counts;
  }

  /// Each participant's sum of squares over choices and sessions.
  [[nodiscard]] std::vector<double> squares() const {
    const std::vector<double> counts = excess_counts();
    std::vector<double> sums(people_);
    for (std::size_t i = 0; i < counts.size(); ++i) {
      sums[person_of_[i / choices_]] += counts[i] * counts[i];
    }
    return sums;
  }

  /// Named minus expected of one participant, by choice.
  [[nodiscard]] std::vector<double> excess_counts_of(std::size_t person) const {
    const std::vector<double> counts = excess_counts();
    std::vector<double> sums(choices_);
    for (std::size_t i = 0; i < counts.size(); ++i) {
      if (person_of_[i / choices_] == person) sums[i % choices_] += counts[i];
    }
    return sums;
  }

  /// Permutes the named stimuli among the mistakes of each pair.
  void deal(RandomStream& random) {
    for_each_pair([&](std::span<Mistake> pair) {
      for (std::size_t left = pair.size(); left > 1; --left) {
        std::swap(pair[left - 1].named_second,
                  pair[static_cast<std::size_t>(random.below(left))].named_second);
      }
    });
  }

 private:
  template <typename Action>
  void for_each_pair(Action action) {
    for (std::size_t first = 0; first < all_.size();) {
      std::size_t end = first + 1;
      while (end < all_.size() && all_[end].first == all_[first].first &&
             all_[end].second == all_[first].second) {
        ++end;
      }
      action(std::span(all_).subspan(first, end - first));
      first = end;
    }
  }

  void add(const Mistake& mistake, double toward_second, std::vector<double>& counts) const {
    counts[mistake.session * choices_ + static_cast<std::size_t>(mistake.second)] += toward_second;
    counts[mistake.session * choices_ + static_cast<std::size_t>(mistake.first)] -= toward_second;
  }

  void set_expected() {
    expected_.assign(person_of_.size() * choices_, 0.0);
    for_each_pair([&](std::span<Mistake> pair) {
      const auto second = std::ranges::count_if(pair, &Mistake::named_second);
      const double mean =
          2.0 * static_cast<double>(second) / static_cast<double>(pair.size()) - 1.0;
      for (const Mistake& mistake : pair) add(mistake, mean, expected_);
    });
  }

  std::size_t people_;
  std::size_t choices_ = 0;
  std::vector<Mistake> all_;
  std::vector<std::size_t> person_of_;  ///< by session
  std::vector<double> expected_;        ///< by session and choice
};

/// The shares of places in answers, by participant. Leaves out people whose answers have no place.
/// \param named_counts  are incremented by place
std::vector<std::vector<double>> shares_of_places(std::span<const Person> people, int places,
                                                  std::vector<int>& named_counts) {
  std::vector<std::vector<double>> shares;
  for (const Person& person : people) {
    std::vector<double> by_place(static_cast<std::size_t>(places));
    int n = 0;
    for (const TrialOutcome* trial : person.trials) {
      const std::optional<int> place = position_of(trial->row.answer);
      if (!is_index(place, places)) continue;
      ++by_place[static_cast<std::size_t>(*place)];
      ++named_counts[static_cast<std::size_t>(*place)];
      ++n;
    }
    if (n == 0) continue;
    for (double& share : by_place) share /= n;
    shares.push_back(std::move(by_place));
  }
  return shares;
}

/// Sums over people the shares minus 1 / places, and over places the squares of these sums.
double squared_deviation(const std::vector<std::vector<double>>& shares) {
  std::vector<double> sums(shares.front().size(), 0.0);
  for (const std::vector<double>& by_place : shares) {
    for (std::size_t i = 0; i < sums.size(); ++i) {
      sums[i] += by_place[i] - 1.0 / static_cast<double>(sums.size());
    }
  }
  return sum_of_squares(sums);
}

double layout_p(std::vector<std::vector<double>> shares, int deals) {
  RandomStream random(0, "answers by place: layouts");
  std::vector<double> squares{squared_deviation(shares)};
  for (int deal = 0; deal < deals; ++deal) {
    for (std::vector<double>& by_place : shares) shuffle(std::span(by_place), random);
    squares.push_back(squared_deviation(shares));
  }
  return ranked_p(squares).front();
}

}  // namespace

std::vector<const Preference*> Preferences::people_with_preference() const {
  std::vector<const Preference*> preferring_people;
  if (!global_null.found()) return preferring_people;
  for (const Preference& preference : people) {
    if (preference.p <= analysis::kSignificanceLevel) preferring_people.push_back(&preference);
  }
  return preferring_people;
}

Preferences preferences_by_target(std::span<const Person> people, int choices,
                                  const TrialFilter& is_included, int max_deals) {
  Preferences all;
  if (choices < 2) return all;
  std::vector<PersonTrials> tested;
  std::vector<std::size_t> person_indices;
  std::size_t answers = 0;
  for (const Person& person : people) {
    PersonTrials trials = answered_trials(person, choices, is_included);
    if (trials.empty()) continue;
    all.people.push_back(preference_of(person.name, trials, observed_excess(trials, choices)));
    if (!has_right_and_wrong(trials)) continue;
    person_indices.push_back(all.people.size() - 1);
    answers += trials.size();
    tested.push_back(std::move(trials));
  }
  const int deals = affordable_deals(answers, static_cast<std::size_t>(max_deals));
  GlobalNullTest test(static_cast<int>(tested.size()), deals);
  std::vector<std::vector<double>> sums(static_cast<std::size_t>(deals) + 1,
                                        std::vector<double>(static_cast<std::size_t>(choices)));
  std::vector<double> observed_p;
  for (std::size_t i = 0; i < tested.size(); ++i) {
    RandomStream random(0, "preferences by target", i);
    const std::vector<std::vector<double>> dealt = dealt_excess(tested[i], choices, deals, random);
    const std::vector<double> p = ranked_p(squares_of(dealt));
    test.add(p);
    observed_p.push_back(p.front());
    for (std::size_t deal = 0; deal < sums.size(); ++deal) {
      std::ranges::transform(sums[deal], dealt[deal], sums[deal].begin(), std::plus<>());
    }
  }
  store_p_values(person_indices, observed_p, all.people);
  all.global_null = test.result(squares_of(sums));
  return all;
}

Preferences preferences_among_errors(std::span<const Person> people, int choices, int max_deals) {
  Preferences all;
  if (choices < 2) return all;
  std::vector<PersonTrials> answered;
  std::vector<std::string> names;
  for (const Person& person : people) {
    PersonTrials trials =
        answered_trials(person, choices, [](const TrialOutcome&) { return true; });
    if (trials.empty()) continue;
    answered.push_back(std::move(trials));
    names.push_back(person.name);
  }
  Mistakes mistakes(answered, choices);
  std::vector<std::size_t> person_indices;
  for (std::size_t i = 0; i < answered.size(); ++i) {
    all.people.push_back(preference_of(names[i], answered[i], mistakes.excess_counts_of(i)));
    all.people.back().place = last_place_of(answered[i], all.people.back().choice);
    const Proportion right = accuracy_of(answered[i]);
    if (right.correct < right.n) person_indices.push_back(i);
  }
  const int deals = affordable_deals(mistakes.size(), static_cast<std::size_t>(max_deals));
  std::vector<std::vector<double>> squares(answered.size());  // by person, then deal
  RandomStream random(0, "preferences among errors");
  for (int deal = 0; deal <= deals; ++deal) {
    if (deal > 0) mistakes.deal(random);
    const std::vector<double> deal_squares = mistakes.squares();
    for (std::size_t i = 0; i < deal_squares.size(); ++i) squares[i].push_back(deal_squares[i]);
  }
  GlobalNullTest test(static_cast<int>(person_indices.size()), deals);
  std::vector<double> pooled(static_cast<std::size_t>(deals) + 1);
  std::vector<double> observed_p;
  for (const std::size_t person : person_indices) {
    const std::vector<double> p = ranked_p(squares[person]);
    test.add(p);
    observed_p.push_back(p.front());
    std::ranges::transform(pooled, squares[person], pooled.begin(), std::plus<>());
  }
  store_p_values(person_indices, observed_p, all.people);
  all.global_null = test.result(pooled);
  return all;
}

std::optional<AnswersByPlace> answers_by_place(std::span<const Person> people, int choices) {
  if (choices < 2) return std::nullopt;
  std::vector<int> named_counts(static_cast<std::size_t>(choices));
  const std::vector<std::vector<double>> shares = shares_of_places(people, choices, named_counts);
  if (shares.empty()) return std::nullopt;
  AnswersByPlace all;
  for (std::size_t place = 0; place < named_counts.size(); ++place) {
    std::vector<double> excess;
    for (const std::vector<double>& row : shares) excess.push_back(row[place] - 1.0 / choices);
    all.places.push_back({named_counts[place], group_test(excess)});
  }
  all.deals = affordable_deals(shares.size() * named_counts.size(), analysis::kGlobalNullDeals);
  all.p = layout_p(shares, all.deals);
  all.preferences = preferences_among_errors(people, choices);
  return all;
}

}  // namespace touchtrial::choices
