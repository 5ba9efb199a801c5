#include "analysis/statistics/order_effects.hpp"

#include "analysis/statistics/common.hpp"
#include "core/random.hpp"

#include <algorithm>
#include <numeric>
#include <stdexcept>
#include <utility>

namespace touchtrial::analysis {
namespace {

constexpr int kNoClass = -1;

/// What a trial carries with it to another place.
struct Carried {
  int presented = kNoClass;
  int answered = kNoClass;

  [[nodiscard]] bool right() const { return answered != kNoClass && answered == presented; }
  [[nodiscard]] bool wrong() const { return answered != kNoClass && answered != presented; }
};

Carried carried(const FeltTrial& trial) {
  if (trial.presented.value_or(0) < 0 || trial.answered.value_or(0) < 0) {
    throw std::invalid_argument("order effects need classes from 0");
  }
  return {trial.presented.value_or(kNoClass), trial.answered.value_or(kNoClass)};
}

/// A place in a block. Places of trials that stay have a trial too.
struct Place {
  std::size_t trial = 0;  ///< index of the trial that was felt there
  double leverage = 0.0;  ///< of the place, in the mean slope over participants
  bool moves = false;
  bool follows = false;
};

struct Block {
  std::vector<std::size_t> moving;  ///< places whose trials move, ascending
};

/// What is tested.
struct Observed {
  double slope = 0.0;
  int class_wrong = 0;
  int class_same = 0;
  int answer_wrong = 0;
  int answer_same = 0;
};

/// All places of a study, and the trials that are at them in an order.
class Places {
 public:
  explicit Places(std::span<const std::vector<FeltBlock>> participants) {
    for (const std::vector<FeltBlock>& own : participants) add(own);
    const auto learners = static_cast<double>(slopes_.size());
    for (Place& place : places_) place.leverage /= std::max(1.0, learners);
    now_.resize(places_.size());
    std::iota(now_.begin(), now_.end(), std::size_t{0});
  }

  [[nodiscard]] const std::vector<double>& slopes() const { return slopes_; }
  [[nodiscard]] std::span<const Block> blocks() const { return blocks_; }
  [[nodiscard]] bool any_moves() const {
    return std::ranges::any_of(places_, [](const Place& place) { return place.moves; });
  }
  [[nodiscard]] int presented_at(std::size_t place) const { return trials_[place].presented; }

  /// Puts the trials that were felt at `from` at the places `to`.
  void put(std::span<const std::size_t> to, std::span<const std::size_t> from) {
    for (std::size_t i = 0; i < to.size(); ++i) now_[to[i]] = from[i];
  }

  [[nodiscard]] Observed observed() const {
    Observed seen;
    for (std::size_t i = 0; i < places_.size(); ++i) {
      const Place& place = places_[i];
      if (!place.moves) continue;
      const Carried& here = trials_[now_[i]];
      if (here.right()) seen.slope += place.leverage;
      if (!place.follows || !here.wrong()) continue;
      const Carried& before = trials_[now_[i - 1]];
      if (before.presented != kNoClass) {
        ++seen.class_wrong;
        seen.class_same += here.answered == before.presented ? 1 : 0;
      }
      if (before.answered != kNoClass) {
        ++seen.answer_wrong;
        seen.answer_same += here.answered == before.answered ? 1 : 0;
      }
    }
    return seen;
  }

 private:
  void add(const std::vector<FeltBlock>& own) {
    const std::size_t first = places_.size();
    double squares = 0.0;
    for (const FeltBlock& block : own) squares += add(block);
    if (squares == 0.0) return;
    double slope = 0.0;
    for (std::size_t i = first; i < places_.size(); ++i) {
      places_[i].leverage /= squares;
      if (places_[i].moves && trials_[i].right()) slope += places_[i].leverage;
    }
    slopes_.push_back(without_noise(slope));
  }

  /// \return the sum of the squared distances of moving places from their mean
  double add(const FeltBlock& block) {
    Block& added = blocks_.emplace_back();
    double sum = 0.0;
    for (const FeltTrial& trial : block) {
      if (trial.moves) {
        added.moving.push_back(places_.size());
        sum += trial.place;
      }
      const bool first = &trial == &block.front();
      places_.push_back({places_.size(), trial.place, trial.moves, trial.follows && !first});
      trials_.push_back(carried(trial));
    }
    double squares = 0.0;
    for (const std::size_t i : added.moving) {
      places_[i].leverage -= sum / static_cast<double>(added.moving.size());
      squares += places_[i].leverage * places_[i].leverage;
    }
    return squares;
  }

  std::vector<Place> places_;
  std::vector<Carried> trials_;
  std::vector<Block> blocks_;
  std::vector<std::size_t> now_;  ///< for each place, the trial that is there
  std::vector<double> slopes_;    ///< of the participants who have one
};

/// Deals the trials of each class over the places that an order gives the class. Keeps its memory
/// from block to block.
class DealByClass {
 public:
  /// \param trials  on return, the trial of each place
  /// \return false if the order does not have as many places of each class
  [[nodiscard]] bool deal(const Places& places, std::span<const int> order,
                          std::vector<std::size_t>& trials, RandomStream& random) {
    shuffle(std::span(trials), random);
    for (auto& [dealt, of_class] : classes_) {
      dealt = 0;
      of_class.clear();
    }
    for (const std::size_t trial : trials) {
      if (places.presented_at(trial) < 0) return false;
      const auto presented = static_cast<std::size_t>(places.presented_at(trial));
      if (presented >= classes_.size()) classes_.resize(presented + 1);
      classes_[presented].trials.push_back(trial);
    }
    dealt_.clear();
    for (const int wanted : order) {
      if (wanted < 0 || static_cast<std::size_t>(wanted) >= classes_.size()) return false;
      OfClass& own = classes_[static_cast<std::size_t>(wanted)];
      if (own.dealt == own.trials.size()) return false;
      dealt_.push_back(own.trials[own.dealt++]);
    }
    trials.swap(dealt_);
    return true;
  }

 private:
  struct OfClass {
    std::size_t dealt = 0;
    std::vector<std::size_t> trials;  ///< as they were shuffled
  };
  std::vector<OfClass> classes_;
  std::vector<std::size_t> dealt_;
};

void draw_orders(Places& places, const RedrawnClasses& redraw, int number, RandomStream& random,
                 DealByClass& by_class) {
  std::vector<std::size_t> trials;
  for (std::size_t b = 0; b < places.blocks().size(); ++b) {
    const std::vector<std::size_t>& moving = places.blocks()[b].moving;
    if (moving.empty()) continue;
    trials = moving;
    if (redraw) {
      const std::vector<int> order = redraw(b, number);
      if (order.size() != moving.size()) {
        throw std::invalid_argument("a redrawn block must keep its length");
      }
      if (!by_class.deal(places, order, trials, random)) trials = moving;
    } else {
      shuffle(std::span(trials), random);
    }
    places.put(moving, trials);
  }
}

/// Twice the smaller tail of a number among those of drawn orders.
double p_among(double observed, std::span<const double> drawn) {
  constexpr double kNoise = 1e-12;
  const auto draws = static_cast<double>(drawn.size());
  const auto above =
      std::ranges::count_if(drawn, [&](double one) { return one >= observed - kNoise; });
  const auto below =
      std::ranges::count_if(drawn, [&](double one) { return one <= observed + kNoise; });
  return std::min(1.0, 2.0 * p_of_draws(static_cast<double>(std::min(above, below)), draws));
}

SerialDependence dependence(int wrong, int same, std::span<const double> drawn) {
  SerialDependence result{wrong, same, mean_of(drawn)};
  if (wrong > 0) result.p = p_among(same, drawn);
  return result;
}

}  // namespace

std::optional<OrderEffects> order_effects(std::span<const std::vector<FeltBlock>> participants,
                                          const RedrawnClasses& redraw, int draws,
                                          std::uint64_t index) {
  if (draws < 1) throw std::invalid_argument("order effects need at least one draw");
  Places places(participants);
  if (!places.any_moves()) return std::nullopt;
  const Observed seen = places.observed();
  std::vector<double> slopes;
  std::vector<double> classes;
  std::vector<double> answers;
  RandomStream random(0, "order effects", index);
  DealByClass by_class;
  for (int number = 0; number < draws; ++number) {
    draw_orders(places, redraw, number, random, by_class);
    const Observed drawn = places.observed();
    slopes.push_back(drawn.slope);
    classes.push_back(drawn.class_same);
    answers.push_back(drawn.answer_same);
  }
  OrderEffects effects;
  effects.slope = participant_mean(places.slopes(), {-1.0, 1.0});
  if (effects.slope.mean) effects.slope_p = p_among(seen.slope, slopes);
  effects.class_before = dependence(seen.class_wrong, seen.class_same, classes);
  effects.answer_before = dependence(seen.answer_wrong, seen.answer_same, answers);
  effects.draws = draws;
  return effects;
}

}  // namespace touchtrial::analysis
