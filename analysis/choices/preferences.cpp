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

int affordable_deals(std::size_t answers, std::size_t most_deals) {
  const std::size_t affordable = kMaxDrawnAnswers / std::max<std::size_t>(1, answers);
  return static_cast<int>(
      std::clamp<std::size_t>(affordable, std::min(kMinPreferenceDeals, most_deals), most_deals));
}

bool is_one_of(std::optional<int> choice, int choices) {
  return choice && *choice >= 0 && *choice < choices;
}

/// The trials of a person whose answer and right choice are both known.
OwnTrials answered_trials(const Person& person, int choices, const Which& which) {
  OwnTrials answered;
  std::ranges::copy_if(person.trials, std::back_inserter(answered), [&](const TrialOutcome* trial) {
    return which(*trial) && is_one_of(trial->response, choices) && is_one_of(trial->right, choices);
  });
  return answered;
}

/// The position of the last answer that named a choice.
std::optional<int> place_of(const OwnTrials& trials, int choice) {
  for (auto trial = trials.rbegin(); trial != trials.rend(); ++trial) {
    if ((*trial)->response == choice) return position_of((*trial)->row.answer);
  }
  return std::nullopt;
}

/// A participant's preference, without its p.
/// \param beyond  for each choice, how much more often than expected it was named
Preference preference_of(const std::string& participant, const OwnTrials& trials,
                         std::span<const double> beyond) {
  Preference one;
  one.participant = participant;
  one.choice = static_cast<int>(std::ranges::max_element(beyond) - beyond.begin());
  for (const TrialOutcome* trial : trials) {
    ++one.answers;
    one.named += *trial->response == one.choice ? 1 : 0;
    (*trial->right == one.choice ? one.right_there : one.right_elsewhere).add(trial->correct());
  }
  return one;
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

/// Whether a person has right and wrong answers; otherwise accuracy cannot depend on the right
/// choice.
bool has_both(const OwnTrials& trials) {
  const Proportion right = accuracy_of(trials);
  return right.correct > 0 && right.correct < right.n;
}

/// How often each choice was named and was right.
struct NamedAndRight {
  explicit NamedAndRight(int choices)
      : named(static_cast<std::size_t>(choices)), targets(named.size()) {}

  void add(std::uint64_t response, std::uint64_t target) {
    ++named[static_cast<std::size_t>(response)];
    ++targets[static_cast<std::size_t>(target)];
  }

  /// S_k of preferences_by_target.
  [[nodiscard]] std::vector<double> beyond(int n, int right) const {
    const double share = static_cast<double>(right) / n;
    const double other = (1.0 - share) / static_cast<double>(named.size() - 1);
    std::vector<double> all(named.size());
    for (std::size_t k = 0; k < all.size(); ++k) {
      all[k] = named[k] - share * targets[k] - other * (n - targets[k]);
    }
    return all;
  }

  std::vector<int> named;
  std::vector<int> targets;
};

/// The same numbers of right and wrong answers with redrawn choices, without a preference.
NamedAndRight redrawn_choices(int choices, int n, int right, RandomStream& random) {
  const auto m = static_cast<std::uint64_t>(choices);
  NamedAndRight drawn(choices);
  for (int i = 0; i < n; ++i) {
    const std::uint64_t target = random.below(m);
    drawn.add(i < right ? target : (target + 1 + random.below(m - 1)) % m, target);
  }
  return drawn;
}

/// S_k of preferences_by_target for the observed answers.
std::vector<double> beyond_targets(const OwnTrials& trials, int choices) {
  NamedAndRight own(choices);
  for (const TrialOutcome* trial : trials) {
    own.add(static_cast<std::uint64_t>(*trial->response),
            static_cast<std::uint64_t>(*trial->right));
  }
  const Proportion right = accuracy_of(trials);
  return own.beyond(right.n, right.correct);
}

/// S_k of the observed answers, then of each deal.
std::vector<std::vector<double>> dealt_beyond(const OwnTrials& trials, int choices, int deals,
                                              RandomStream& random) {
  const Proportion right = accuracy_of(trials);
  std::vector<std::vector<double>> beyond{beyond_targets(trials, choices)};
  for (int deal = 0; deal < deals; ++deal) {
    beyond.push_back(
        redrawn_choices(choices, right.n, right.correct, random).beyond(right.n, right.correct));
  }
  return beyond;
}

std::vector<double> squares_of(const std::vector<std::vector<double>>& dealt) {
  std::vector<double> squares;
  squares.reserve(dealt.size());
  for (const std::vector<double>& one : dealt) squares.push_back(sum_of_squares(one));
  return squares;
}

/// A wrong answer that confuses a pair of stimuli.
struct Mistake {
  std::size_t person = 0;
  std::size_t session = 0;  ///< of all people, counted from 0
  int first = 0;            ///< of the pair, the lower index
  int second = 1;
  bool named_second = true;
};

/// Wrong answers, grouped by pair of stimuli.
class Mistakes {
 public:
  Mistakes(std::span<const OwnTrials> people, int choices) : people_(people.size()) {
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
    std::ranges::stable_sort(all_, {},
                             [](const Mistake& one) { return std::pair(one.first, one.second); });
    person_of_.resize(sessions.size());
    for (const Mistake& one : all_) person_of_[one.session] = one.person;
    expect();
  }

  [[nodiscard]] std::size_t size() const { return all_.size(); }

  /// How much more often than expected each choice was named, by session.
  [[nodiscard]] std::vector<double> beyond() const {
    std::vector<double> counts(expected_.size());
    for (std::size_t i = 0; i < counts.size(); ++i) counts[i] = -expected_[i];
    for (const Mistake& one : all_) add(one, one.named_second ? 1.0 : -1.0, counts);
    return counts;
  }

  /// Each participant's sum of squares over choices and sessions.
  [[nodiscard]] std::vector<double> squares() const {
    const std::vector<double> counts = beyond();
    std::vector<double> sums(people_);
    for (std::size_t i = 0; i < counts.size(); ++i) {
      sums[person_of_[i / choices_]] += counts[i] * counts[i];
    }
    return sums;
  }

  /// The sum over sessions.
  [[nodiscard]] std::vector<double> beyond_of(std::size_t person) const {
    const std::vector<double> counts = beyond();
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
  template <typename Do>
  void for_each_pair(Do act) {
    for (std::size_t first = 0; first < all_.size();) {
      std::size_t last = first + 1;
      while (last < all_.size() && all_[last].first == all_[first].first &&
             all_[last].second == all_[first].second) {
        ++last;
      }
      act(std::span(all_).subspan(first, last - first));
      first = last;
    }
  }

  void add(const Mistake& one, double toward_second, std::vector<double>& counts) const {
    counts[one.session * choices_ + static_cast<std::size_t>(one.second)] += toward_second;
    counts[one.session * choices_ + static_cast<std::size_t>(one.first)] -= toward_second;
  }

  void expect() {
    expected_.assign(person_of_.size() * choices_, 0.0);
    for_each_pair([&](std::span<Mistake> pair) {
      const auto second = std::ranges::count_if(pair, &Mistake::named_second);
      const double mean =
          2.0 * static_cast<double>(second) / static_cast<double>(pair.size()) - 1.0;
      for (const Mistake& one : pair) add(one, mean, expected_);
    });
  }

  std::size_t people_;
  std::size_t choices_ = 0;
  std::vector<Mistake> all_;
  std::vector<std::size_t> person_of_;  ///< by session
  std::vector<double> expected_;        ///< by session and choice
};

/// The share of each place in a participant's answers, for people with a place in every answer.
std::vector<std::vector<double>> shares_of_places(std::span<const Person> people, int places,
                                                  std::vector<int>& named) {
  std::vector<std::vector<double>> shares;
  for (const Person& person : people) {
    std::vector<double> own(static_cast<std::size_t>(places));
    int n = 0;
    for (const TrialOutcome* trial : person.trials) {
      const std::optional<int> place = position_of(trial->row.answer);
      if (!is_one_of(place, places)) continue;
      ++own[static_cast<std::size_t>(*place)];
      ++named[static_cast<std::size_t>(*place)];
      ++n;
    }
    if (n == 0) continue;
    for (double& one : own) one /= n;
    shares.push_back(std::move(own));
  }
  return shares;
}

/// The sum over places of the squared sum over people of share less 1 / places.
double square_of_all(const std::vector<std::vector<double>>& shares) {
  std::vector<double> sums(shares.front().size(), 0.0);
  for (const std::vector<double>& own : shares) {
    for (std::size_t i = 0; i < sums.size(); ++i) {
      sums[i] += own[i] - 1.0 / static_cast<double>(sums.size());
    }
  }
  return sum_of_squares(sums);
}

double p_of_layouts(std::vector<std::vector<double>> shares, int deals) {
  RandomStream random(0, "answers by place: layouts");
  std::vector<double> squares{square_of_all(shares)};
  for (int deal = 0; deal < deals; ++deal) {
    for (std::vector<double>& own : shares) shuffle(std::span(own), random);
    squares.push_back(square_of_all(shares));
  }
  return ranked_p(squares).front();
}

}  // namespace

std::vector<const Preference*> Preferences::of_those_who_prefer() const {
  std::vector<const Preference*> found;
  if (!anybody.found()) return found;
  for (const Preference& one : people) {
    if (one.p <= analysis::kSignificanceLevel) found.push_back(&one);
  }
  return found;
}

Preferences preferences_by_target(std::span<const Person> people, int choices, const Which& which,
                                  int most_deals) {
  Preferences all;
  if (choices < 2) return all;
  std::vector<OwnTrials> tested;
  std::vector<std::size_t> places;
  std::size_t answers = 0;
  for (const Person& person : people) {
    OwnTrials trials = answered_trials(person, choices, which);
    if (trials.empty()) continue;
    all.people.push_back(preference_of(person.name, trials, beyond_targets(trials, choices)));
    if (!has_both(trials)) continue;
    places.push_back(all.people.size() - 1);
    answers += trials.size();
    tested.push_back(std::move(trials));
  }
  const int deals = affordable_deals(answers, static_cast<std::size_t>(most_deals));
  GlobalNullTest test(static_cast<int>(tested.size()), deals);
  std::vector<std::vector<double>> sums(static_cast<std::size_t>(deals) + 1,
                                        std::vector<double>(static_cast<std::size_t>(choices)));
  std::vector<double> own_p;
  for (std::size_t i = 0; i < tested.size(); ++i) {
    RandomStream random(0, "preferences by target", i);
    const std::vector<std::vector<double>> dealt = dealt_beyond(tested[i], choices, deals, random);
    const std::vector<double> p = ranked_p(squares_of(dealt));
    test.add(p);
    own_p.push_back(p.front());
    for (std::size_t deal = 0; deal < sums.size(); ++deal) {
      std::ranges::transform(sums[deal], dealt[deal], sums[deal].begin(), std::plus<>());
    }
  }
  store_p_values(places, own_p, all.people);
  all.anybody = test.result(squares_of(sums));
  return all;
}

Preferences preferences_among_errors(std::span<const Person> people, int choices, int most_deals) {
  Preferences all;
  if (choices < 2) return all;
  std::vector<OwnTrials> answered;
  std::vector<std::string> names;
  for (const Person& person : people) {
    OwnTrials trials = answered_trials(person, choices, [](const TrialOutcome&) { return true; });
    if (trials.empty()) continue;
    answered.push_back(std::move(trials));
    names.push_back(person.name);
  }
  Mistakes mistakes(answered, choices);
  std::vector<std::size_t> places;
  for (std::size_t i = 0; i < answered.size(); ++i) {
    all.people.push_back(preference_of(names[i], answered[i], mistakes.beyond_of(i)));
    all.people.back().place = place_of(answered[i], all.people.back().choice);
    const Proportion right = accuracy_of(answered[i]);
    if (right.correct < right.n) places.push_back(i);
  }
  const int deals = affordable_deals(mistakes.size(), static_cast<std::size_t>(most_deals));
  std::vector<std::vector<double>> squares(answered.size());  // by person, then deal
  RandomStream random(0, "preferences among errors");
  for (int deal = 0; deal <= deals; ++deal) {
    if (deal > 0) mistakes.deal(random);
    const std::vector<double> own = mistakes.squares();
    for (std::size_t i = 0; i < own.size(); ++i) squares[i].push_back(own[i]);
  }
  GlobalNullTest test(static_cast<int>(places.size()), deals);
  std::vector<double> together(static_cast<std::size_t>(deals) + 1);
  std::vector<double> own_p;
  for (const std::size_t place : places) {
    const std::vector<double> p = ranked_p(squares[place]);
    test.add(p);
    own_p.push_back(p.front());
    std::ranges::transform(together, squares[place], together.begin(), std::plus<>());
  }
  store_p_values(places, own_p, all.people);
  all.anybody = test.result(together);
  return all;
}

std::optional<AnswersByPlace> answers_by_place(std::span<const Person> people, int choices) {
  if (choices < 2) return std::nullopt;
  std::vector<int> named(static_cast<std::size_t>(choices));
  const std::vector<std::vector<double>> shares = shares_of_places(people, choices, named);
  if (shares.empty()) return std::nullopt;
  AnswersByPlace all;
  for (std::size_t place = 0; place < named.size(); ++place) {
    std::vector<double> excess;
    for (const std::vector<double>& own : shares) excess.push_back(own[place] - 1.0 / choices);
    all.places.push_back({named[place], group_test(excess)});
  }
  all.deals = affordable_deals(shares.size() * named.size(), analysis::kGlobalNullDeals);
  all.p = p_of_layouts(shares, all.deals);
  all.own = preferences_among_errors(people, choices);
  return all;
}

}  // namespace touchtrial::choices
