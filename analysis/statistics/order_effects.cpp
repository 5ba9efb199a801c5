#include "analysis/statistics/order_effects.hpp"

#include "analysis/statistics/common.hpp"
#include "core/random.hpp"

#include <algorithm>
#include <stdexcept>
#include <utility>

namespace touchtrial::analysis {
namespace {

constexpr int kNoClass = -1;
constexpr int kNotWrong = -2;  ///< neither a class nor a missing answer

/// The data that move with a trial to another place.
struct MovableTrial {
  int presented = kNoClass;
  int answered = kNoClass;
  int wrong = kNotWrong;  ///< the answer, if it is wrong
  int right = 0;          ///< 1 if the answer is right
};

MovableTrial movable_trial(const FeltTrial& trial) {
  if (trial.presented.value_or(0) < 0 || trial.answered.value_or(0) < 0) {
    throw std::invalid_argument("order effects need classes >= 0");
  }
  MovableTrial result{.presented = trial.presented.value_or(kNoClass),
                      .answered = trial.answered.value_or(kNoClass)};
  if (result.answered == kNoClass) return result;
  result.right = result.answered == result.presented ? 1 : 0;
  if (result.right == 0) result.wrong = result.answered;
  return result;
}

/// A place in a block, of a trial that may move or must stay.
struct Place {
  double leverage = 0.0;  ///< its weight in the mean slope over participants
  bool follows = false;   ///< FeltTrial::follows, if the trial moves
};

struct Block {
  std::vector<std::size_t> moving;   ///< places whose trials move, ascending
  std::vector<MovableTrial> trials;  ///< the trials that were felt there

  /// Whether the moving trials are contiguous.
  [[nodiscard]] bool is_run() const { return moving.back() - moving.front() + 1 == moving.size(); }
};

struct OrderStatistics {
  double slope = 0.0;
  int class_same = 0;
  int answer_same = 0;
};

/// All places of a study, and the trials that occupy them in the current order.
class Places {
 public:
  explicit Places(std::span<const std::vector<FeltBlock>> participants) {
    for (const std::vector<FeltBlock>& blocks : participants) add(blocks);
    const auto slopes = static_cast<double>(slopes_.size());
    for (Place& place : places_) place.leverage /= std::max(1.0, slopes);
  }

  [[nodiscard]] const std::vector<double>& slopes() const { return slopes_; }
  [[nodiscard]] std::span<const Block> blocks() const { return blocks_; }
  [[nodiscard]] bool can_reorder() const {
    return std::ranges::any_of(blocks_, [](const Block& block) { return !block.moving.empty(); });
  }

  /// The current trials of a block that is a run, for shuffling in place.
  [[nodiscard]] std::span<MovableTrial> run(const Block& block) {
    return std::span(current_).subspan(block.moving.front(), block.moving.size());
  }

  /// Puts trials at the target places.
  void put(std::span<const std::size_t> targets, std::span<const MovableTrial> trials) {
    for (std::size_t i = 0; i < targets.size(); ++i) current_[targets[i]] = trials[i];
  }

  /// The statistics of the current order. Branch-free, because the processor cannot predict
  /// answers.
  [[nodiscard]] OrderStatistics observed() const {
    double slope = 0.0;
    int class_same = 0;
    int answer_same = 0;
    MovableTrial previous;
    for (std::size_t i = 0; i < places_.size(); ++i) {
      const Place& place = places_[i];
      const MovableTrial current = current_[i];
      const int follows = place.follows ? 1 : 0;
      slope += place.leverage * current.right;
      class_same += follows & (current.wrong == previous.presented ? 1 : 0);
      answer_same += follows & (current.wrong == previous.answered ? 1 : 0);
      previous = current;
    }
    return {slope, class_same, answer_same};
  }

  /// The number of wrong answers immediately after a trial with a class or an answer.
  /// \param member  presented or answered
  [[nodiscard]] int wrong_after(int MovableTrial::*member) const {
    int wrong = 0;
    for (std::size_t i = 1; i < places_.size(); ++i) {
      if (!places_[i].follows || current_[i].wrong == kNotWrong) continue;
      wrong += current_[i - 1].*member == kNoClass ? 0 : 1;
    }
    return wrong;
  }

 private:
  void add(const std::vector<FeltBlock>& blocks) {
    const std::size_t first = places_.size();
    double squares = 0.0;
    for (const FeltBlock& block : blocks) squares += add(block);
    if (squares == 0.0) return;
    double slope = 0.0;
    for (std::size_t i = first; i < places_.size(); ++i) {
      places_[i].leverage /= squares;
      slope += places_[i].leverage * current_[i].right;
    }
    slopes_.push_back(without_noise(slope));
  }

  /// \return the sum of the squared distances of moving places from their mean
  double add(const FeltBlock& block) {
    Block& new_block = blocks_.emplace_back();
    double sum = 0.0;
    for (const FeltTrial& trial : block) {
      const bool first = &trial == &block.front();
      current_.push_back(movable_trial(trial));
      if (trial.moves) {
        new_block.moving.push_back(places_.size());
        new_block.trials.push_back(current_.back());
        sum += trial.place;
      }
      places_.push_back({.leverage = trial.moves ? trial.place : 0.0,
                         .follows = trial.moves && trial.follows && !first});
    }
    double squares = 0.0;
    for (const std::size_t i : new_block.moving) {
      places_[i].leverage -= sum / static_cast<double>(new_block.moving.size());
      squares += places_[i].leverage * places_[i].leverage;
    }
    return squares;
  }

  std::vector<Place> places_;
  std::vector<Block> blocks_;
  std::vector<MovableTrial> current_;  ///< the current trial of each place
  std::vector<double> slopes_;         ///< of the participants with a defined slope
};

/// Distributes the trials of each class over that class's places in an order. Reuses its memory
/// from block to block.
class ClassDealer {
 public:
  /// \param trials  on return, the trial of each place
  /// \return false if a class has different numbers of places and trials
  [[nodiscard]] bool deal(std::span<const int> order, std::vector<MovableTrial>& trials,
                          RandomStream& random) {
    shuffle(std::span(trials), random);
    for (auto& [dealt, of_class] : classes_) {
      dealt = 0;
      of_class.clear();
    }
    for (const MovableTrial& trial : trials) {
      if (trial.presented < 0) return false;
      const auto presented = static_cast<std::size_t>(trial.presented);
      if (presented >= classes_.size()) classes_.resize(presented + 1);
      classes_[presented].trials.push_back(trial);
    }
    dealt_.clear();
    for (const int index : order) {
      if (index < 0 || static_cast<std::size_t>(index) >= classes_.size()) return false;
      ClassTrials& class_trials = classes_[static_cast<std::size_t>(index)];
      if (class_trials.dealt == class_trials.trials.size()) return false;
      dealt_.push_back(class_trials.trials[class_trials.dealt++]);
    }
    trials.swap(dealt_);
    return true;
  }

 private:
  struct ClassTrials {
    std::size_t dealt = 0;
    std::vector<MovableTrial> trials;  ///< in shuffled order
  };
  std::vector<ClassTrials> classes_;
  std::vector<MovableTrial> dealt_;
};

void draw_orders(Places& places, const ClassRedraw& redraw, int number, RandomStream& random,
                 ClassDealer& dealer) {
  std::vector<MovableTrial> trials;
  for (std::size_t b = 0; b < places.blocks().size(); ++b) {
    const Block& block = places.blocks()[b];
    if (block.moving.empty()) continue;
    if (!redraw && block.is_run()) {
      const std::span<MovableTrial> run = places.run(block);
      std::ranges::copy(block.trials, run.begin());
      shuffle(run, random);
      continue;
    }
    trials = block.trials;
    if (redraw) {
      const std::vector<int> order = redraw(b, number);
      if (order.size() != trials.size()) {
        throw std::invalid_argument("a redrawn block must keep its length");
      }
      if (!dealer.deal(order, trials, random)) trials = block.trials;
    } else {
      shuffle(std::span(trials), random);
    }
    places.put(block.moving, trials);
  }
}

/// Twice the smaller tail of the observed number among the numbers of drawn orders.
double two_sided_draws_p(double observed, std::span<const double> drawn) {
  constexpr double kNoise = 1e-12;
  const auto draws = static_cast<double>(drawn.size());
  const auto above =
      std::ranges::count_if(drawn, [&](double one) { return one >= observed - kNoise; });
  const auto below =
      std::ranges::count_if(drawn, [&](double one) { return one <= observed + kNoise; });
  return std::min(1.0, 2.0 * p_of_draws(static_cast<double>(std::min(above, below)), draws));
}

SerialDependence dependence_of(int wrong, int same, std::span<const double> drawn) {
  SerialDependence result{wrong, same, mean_of(drawn)};
  if (wrong > 0) result.p = two_sided_draws_p(same, drawn);
  return result;
}

}  // namespace

std::optional<OrderEffects> order_effects(std::span<const std::vector<FeltBlock>> participants,
                                          const ClassRedraw& redraw, int draws,
                                          std::uint64_t index) {
  if (draws < 1) throw std::invalid_argument("order effects need at least one draw");
  Places places(participants);
  if (!places.can_reorder()) return std::nullopt;
  const OrderStatistics observed = places.observed();
  const int class_wrong = places.wrong_after(&MovableTrial::presented);
  const int answer_wrong = places.wrong_after(&MovableTrial::answered);
  std::vector<double> slopes;
  std::vector<double> classes;
  std::vector<double> answers;
  RandomStream random(0, "order effects", index);
  ClassDealer dealer;
  for (int number = 0; number < draws; ++number) {
    draw_orders(places, redraw, number, random, dealer);
    const OrderStatistics drawn = places.observed();
    slopes.push_back(drawn.slope);
    classes.push_back(drawn.class_same);
    answers.push_back(drawn.answer_same);
  }
  OrderEffects effects;
  effects.slope = participant_mean(places.slopes(), {-1.0, 1.0});
  if (effects.slope.mean) effects.slope_p = two_sided_draws_p(observed.slope, slopes);
  effects.class_before = dependence_of(class_wrong, observed.class_same, classes);
  effects.answer_before = dependence_of(answer_wrong, observed.answer_same, answers);
  effects.draws = draws;
  return effects;
}

}  // namespace touchtrial::analysis
