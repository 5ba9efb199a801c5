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
struct Carried {
  int presented = kNoClass;
  int answered = kNoClass;
  int wrong = kNotWrong;  ///< the answer, if it is wrong
  int right = 0;          ///< 1 if the answer is right
};

Carried carried(const FeltTrial& trial) {
  if (trial.presented.value_or(0) < 0 || trial.answered.value_or(0) < 0) {
    throw std::invalid_argument("order effects need classes >= 0");
  }
  Carried carried{.presented = trial.presented.value_or(kNoClass),
                  .answered = trial.answered.value_or(kNoClass)};
  if (carried.answered == kNoClass) return carried;
  carried.right = carried.answered == carried.presented ? 1 : 0;
  if (carried.right == 0) carried.wrong = carried.answered;
  return carried;
}

/// A place in a block. Places of trials that stay have a trial too.
struct Place {
  double leverage = 0.0;  ///< of the place, in the mean slope over participants
  bool follows = false;   ///< and moves
};

struct Block {
  std::vector<std::size_t> moving;  ///< places whose trials move, ascending
  std::vector<Carried> trials;      ///< that were felt there

  /// Whether the moving trials are contiguous.
  [[nodiscard]] bool is_run() const { return moving.back() - moving.front() + 1 == moving.size(); }
};

/// The test statistics.
struct Observed {
  double slope = 0.0;
  int class_same = 0;
  int answer_same = 0;
};

/// All places of a study, and the trials that are at them in an order.
class Places {
 public:
  explicit Places(std::span<const std::vector<FeltBlock>> participants) {
    for (const std::vector<FeltBlock>& own : participants) add(own);
    const auto learners = static_cast<double>(slopes_.size());
    for (Place& place : places_) place.leverage /= std::max(1.0, learners);
  }

  [[nodiscard]] const std::vector<double>& slopes() const { return slopes_; }
  [[nodiscard]] std::span<const Block> blocks() const { return blocks_; }
  [[nodiscard]] bool any_moves() const {
    return std::ranges::any_of(blocks_, [](const Block& block) { return !block.moving.empty(); });
  }

  /// The trials of a block that is a run, to be moved where they are.
  [[nodiscard]] std::span<Carried> run(const Block& block) {
    return std::span(now_).subspan(block.moving.front(), block.moving.size());
  }

  /// Puts trials at the places `to`.
  void put(std::span<const std::size_t> to, std::span<const Carried> trials) {
    for (std::size_t i = 0; i < to.size(); ++i) now_[to[i]] = trials[i];
  }

  /// The statistics of the current order. Branch-free, because answers are unpredictable for the
  /// processor.
  [[nodiscard]] Observed observed() const {
    double slope = 0.0;
    int class_same = 0;
    int answer_same = 0;
    Carried before;
    for (std::size_t i = 0; i < places_.size(); ++i) {
      const Place& place = places_[i];
      const Carried here = now_[i];
      const int follows = place.follows ? 1 : 0;
      slope += place.leverage * here.right;
      class_same += follows & (here.wrong == before.presented ? 1 : 0);
      answer_same += follows & (here.wrong == before.answered ? 1 : 0);
      before = here;
    }
    return {slope, class_same, answer_same};
  }

  /// Wrong answers immediately after a trial that has this.
  /// \param what  presented or answered
  [[nodiscard]] int wrong_after(int Carried::*what) const {
    int wrong = 0;
    for (std::size_t i = 1; i < places_.size(); ++i) {
      if (!places_[i].follows || now_[i].wrong == kNotWrong) continue;
      wrong += now_[i - 1].*what == kNoClass ? 0 : 1;
    }
    return wrong;
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
      slope += places_[i].leverage * now_[i].right;
    }
    slopes_.push_back(without_noise(slope));
  }

  /// \return the sum of the squared distances of moving places from their mean
  double add(const FeltBlock& block) {
    Block& added = blocks_.emplace_back();
    double sum = 0.0;
    for (const FeltTrial& trial : block) {
      const bool first = &trial == &block.front();
      now_.push_back(carried(trial));
      if (trial.moves) {
        added.moving.push_back(places_.size());
        added.trials.push_back(now_.back());
        sum += trial.place;
      }
      places_.push_back({.leverage = trial.moves ? trial.place : 0.0,
                         .follows = trial.moves && trial.follows && !first});
    }
    double squares = 0.0;
    for (const std::size_t i : added.moving) {
      places_[i].leverage -= sum / static_cast<double>(added.moving.size());
      squares += places_[i].leverage * places_[i].leverage;
    }
    return squares;
  }

  std::vector<Place> places_;
  std::vector<Block> blocks_;
  std::vector<Carried> now_;    ///< for each place, the trial that is there
  std::vector<double> slopes_;  ///< of the participants with a defined slope
};

/// Distributes the trials of each class over the places of that class in an order. Reuses its
/// memory from block to block.
class DealByClass {
 public:
  /// \param trials  on return, the trial of each place
  /// \return false if the order does not have as many places of each class
  [[nodiscard]] bool deal(std::span<const int> order, std::vector<Carried>& trials,
                          RandomStream& random) {
    shuffle(std::span(trials), random);
    for (auto& [dealt, of_class] : classes_) {
      dealt = 0;
      of_class.clear();
    }
    for (const Carried& trial : trials) {
      if (trial.presented < 0) return false;
      const auto presented = static_cast<std::size_t>(trial.presented);
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
    std::vector<Carried> trials;  ///< as they were shuffled
  };
  std::vector<OfClass> classes_;
  std::vector<Carried> dealt_;
};

void draw_orders(Places& places, const RedrawnClasses& redraw, int number, RandomStream& random,
                 DealByClass& by_class) {
  std::vector<Carried> trials;
  for (std::size_t b = 0; b < places.blocks().size(); ++b) {
    const Block& block = places.blocks()[b];
    if (block.moving.empty()) continue;
    if (!redraw && block.is_run()) {
      const std::span<Carried> run = places.run(block);
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
      if (!by_class.deal(order, trials, random)) trials = block.trials;
    } else {
      shuffle(std::span(trials), random);
    }
    places.put(block.moving, trials);
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
  const int class_wrong = places.wrong_after(&Carried::presented);
  const int answer_wrong = places.wrong_after(&Carried::answered);
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
  effects.class_before = dependence(class_wrong, seen.class_same, classes);
  effects.answer_before = dependence(answer_wrong, seen.answer_same, answers);
  effects.draws = draws;
  return effects;
}

}  // namespace touchtrial::analysis
